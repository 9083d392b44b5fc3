//! The targets: session, connections, and what is peculiar about each.

use std::rc::Rc;

use cipdeck_shared::{
    api::{ConnectionStatus, TargetStatus},
    engine::TargetState,
};
use yew::prelude::*;

use super::down::{advice, by_target, count, names};
use crate::{browser, i18n::tr, kit::Shape, pages::block::age_words, store::Row, workbench::Workbench};

/// All that answer; those that do not are told above.
pub(super) fn targets(bench: &Workbench) -> Html {
    let all = bench.relay().targets().all();
    let blocks = by_target(bench.rows());
    let of = |target: &String| blocks.get(target).map_or(&[][..], Vec::as_slice);
    let shown: Vec<_> = all.iter().filter(|target| target.state != TargetState::Down).collect();
    html! {
        <section class="channel">
            <h2>{ tr!("targets.title") }<span class="count">{ shown.len() }</span></h2>
            if shown.is_empty() {
                <p class="quiet">{ tr!("targets.none") }</p>
            }
            <ul class="targets">{ for shown.iter().map(|status| target(status, of(&status.target))) }</ul>
        </section>
    }
}

fn target(status: &TargetStatus, blocks: &[Rc<Row>]) -> Html {
    let (class, shape, word) = state(status.state);
    html! {
        <li key={status.target.clone()} class="target" data-test="target">
            <div class="target-head">
                <b class="mono">{ &status.target }</b>
                <span class={classes!("state", class)}>{ shape.draw() }<span class="state-word">{ word }</span></span>
                <span class="quiet">{ used(blocks) }</span>
                if let Some(profile) = status.profile {
                    <span class="quiet">{ tr!("targets.profile", profile = profile.word()) }</span>
                }
                <details>
                    <summary>{ count(blocks) }</summary>
                    { names(blocks) }
                </details>
            </div>
            <ul class="target-facts">
                { for status.connections.iter().map(connection) }
                { for peculiar(status).into_iter().flatten().map(|fact| html! { <li class="peculiar">{ fact }</li> }) }
                if let Some(error) = &status.error {
                    <li class="peculiar">{ tr!("targets.error", age = since(status), what = advice(error)) }</li>
                }
            </ul>
        </li>
    }
}

/// When a message of a block last went to or came from it. The relay's own `idle_ms` is of the moment in which the
/// target looked different last.
fn used(blocks: &[Rc<Row>]) -> AttrValue {
    if blocks.iter().any(|row| row.status.phase.is_busy()) {
        return tr!("targets.in_use");
    }
    let ages = blocks.iter().filter_map(|row| browser::age_s(row.status.at.as_deref()?));
    let age = ages.fold(f64::INFINITY, f64::min);
    if age.is_finite() { tr!("targets.used", age = age_words(age)) } else { AttrValue::default() }
}

fn state(state: TargetState) -> (&'static str, Shape, AttrValue) {
    match state {
        TargetState::Closed => ("ring", Shape::Ring, tr!("targets.closed")),
        TargetState::Connecting => ("half", Shape::Half, tr!("targets.connecting")),
        TargetState::Open => ("tick", Shape::Tick, tr!("targets.open")),
        TargetState::Closing => ("half", Shape::Half, tr!("targets.closing")),
        TargetState::Down => ("cross", Shape::Cross, tr!("targets.down")),
    }
}

fn connection(connection: &ConnectionStatus) -> Html {
    let ConnectionStatus { route, size, requests } = connection;
    let route = if route.is_empty() { tr!("targets.itself") } else { tr!("targets.route", route = route) };
    html! { <li>{ tr!("targets.connection", route = route, size = size, requests = requests) }</li> }
}

fn peculiar(status: &TargetStatus) -> [Option<AttrValue>; 3] {
    [
        status.no_context.then_some(tr!("targets.no_context")),
        status.own_connection_id.then_some(tr!("targets.own_connection_id")),
        (status.dropped > 0).then(|| tr!("targets.dropped", count = status.dropped)),
    ]
}

fn since(status: &TargetStatus) -> AttrValue {
    status.since.as_deref().and_then(browser::age_s).map(age_words).unwrap_or_default()
}
