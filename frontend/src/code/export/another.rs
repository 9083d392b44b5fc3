//! A block as one of another kind: what changes, both beside each other, and what has to be confirmed before it is saved.

use std::{collections::BTreeSet, rc::Rc};

use cipdeck_shared::{
    api::Role,
    code::{Change, Converted, Grade, Kind, convert},
    config::{Block, BlockConfig, BlockId},
    plan::{MessagePlan, limits::MAX_NAME},
};
use web_sys::HtmlInputElement;
use yew::prelude::*;

use super::{
    super::{api, changes::changes, facts::place, i18n::tr},
    pair::{Differences, pair},
};
use crate::{
    editor::Remark,
    hooks::use_session,
    net::session,
    office::{
        fetch::use_action,
        kit::{Entry, problem_note},
    },
};

#[derive(Clone, PartialEq, Properties)]
pub(super) struct AnotherProps {
    pub(super) block: Rc<Block>,
}

/// The kinds that it can become, and the one that was chosen.
#[component]
pub(super) fn Another(props: &AnotherProps) -> Html {
    let chosen = use_state(|| None::<Kind>);
    let own = Kind::of(&props.block.config);
    let button = |kind: Kind| {
        let set = chosen.setter();
        let pressed = if *chosen == Some(kind) { "true" } else { "false" };
        let words =
            if kind == own { format!("{kind}, {}", tr!("another.this_kind")) } else { kind.to_string() };
        html! {
            <button
                type="button" class="segment" aria-pressed={pressed} disabled={kind == own} data-test="kind"
                data-kind={kind.to_string()} onclick={move |_: MouseEvent| set.set(Some(kind))}
            >{ words }</button>
        }
    };
    html! {
        <section class="panel code-another" data-test="another">
            <h2>{ tr!("another.title") }</h2>
            <p class="lead">{ tr!("another.lead") }</p>
            <div class="segments" role="group" aria-label={tr!("another.kind")}>{ for Kind::ALL.into_iter().map(button) }</div>
            if let Some(kind) = *chosen {
                <Becoming key={kind.to_string()} block={props.block.clone()} {kind} />
            }
        </section>
    }
}

#[derive(Clone, PartialEq, Properties)]
struct BecomingProps {
    block: Rc<Block>,
    kind: Kind,
}

/// Everything about one conversion.
#[component]
fn Becoming(props: &BecomingProps) -> Html {
    use_session();
    let action = use_action();
    let name = use_state(|| suggested(props.block.config.name(), props.kind));
    let seen = use_state(BTreeSet::<usize>::new);
    let made = use_state(|| None::<BlockId>);
    let converted = use_memo(props.clone(), |props| convert(&props.block.config, props.kind));
    let (before, _) = MessagePlan::check(&props.block.config);
    let config = named(&converted, &name);
    let (after, findings) = MessagePlan::check(&config);
    let errors: Vec<_> = findings.iter().map(Remark::from_rule).filter(Remark::is_error).collect();
    let ticks =
        ticks(&converted, Differences::of(before.as_ref(), after.as_ref()), (&props.block.config, &config));
    let all_seen = (0..ticks.len()).all(|tick| seen.contains(&tick));
    let can = all_seen && errors.is_empty() && !name.trim().is_empty() && session::may(Role::may_edit);
    let onsubmit = {
        let (action, made, config) = (action.clone(), made.setter(), config.clone());
        move |event: SubmitEvent| {
            event.prevent_default();
            if can {
                let (made, config) = (made.clone(), config.clone());
                action.go(async move { api::save(&config).await }, move |block| made.set(Some(block.id)));
            }
        }
    };
    let name_problem = name.trim().is_empty().then_some(tr!("another.name_needed"));
    html! {
        <form {onsubmit} class="code-becoming" data-test="becoming">
            { changes(&converted.changes) }
            { pair((&props.block.config, before.as_ref()), (&config, after.as_ref())) }
            { for errors.iter().map(|remark| html! {
                <p class="finding error" role="alert" data-test="error"><span class="finding-word">{ &remark.field }</span>{ &remark.text }</p>
            }) }
            { for ticks.iter().enumerate().map(|(number, words)| tick(number, words, &seen)) }
            { Entry::text("another-name", tr!("another.name"), &name).problem(name_problem).draw() }
            { problem_note(action.problem().as_ref()) }
            <div class="code-save">
                <button type="submit" class="button primary" disabled={!can || action.is_busy()} data-test="save-another">{ tr!("another.do") }</button>
                if !session::may(Role::may_edit) {
                    <span class="hint">{ tr!("save.not_you") }</span>
                } else if !all_seen {
                    <span class="finding error">{ tr!("another.ticks_first") }</span>
                }
                if let Some(id) = *made {
                    <span role="status" data-test="made">
                        { tr!("another.saved", id = id) }{ " " }
                        <a href={place(props.kind, id)}>{ tr!("another.open") }</a>
                    </span>
                }
            </div>
        </form>
    }
}

/// What has to be confirmed: each change of the request by its own words, and what the bytes themselves show although no
/// change says it.
fn ticks(
    converted: &Converted,
    differences: Differences,
    (before, after): (&BlockConfig, &BlockConfig),
) -> Vec<AttrValue> {
    let told: Vec<_> = converted.changes.iter().filter(|change| change.grade == Grade::Request).collect();
    let mut ticks: Vec<_> = told.iter().map(|change| words(change)).collect();
    if told.is_empty() && differences.bytes {
        ticks.push(tr!("another.tick_bytes"));
    }
    if told.is_empty() && differences.target {
        ticks.push(tr!("another.tick_target", to = after.target_text(), from = before.target_text()));
    }
    ticks
}

/// A change as somebody confirms it.
fn words(change: &Change) -> AttrValue {
    let to = if change.to.is_empty() { tr!("changes.nothing") } else { change.to.clone().into() };
    tr!("another.tick", member = change.member, from = change.from, to = to, why = change.why)
}

fn tick(number: usize, words: &AttrValue, seen: &UseStateHandle<BTreeSet<usize>>) -> Html {
    let onchange = {
        let seen = seen.clone();
        move |event: Event| {
            let mut now = (*seen).clone();
            if event.target_unchecked_into::<HtmlInputElement>().checked() {
                now.insert(number);
            } else {
                now.remove(&number);
            }
            seen.set(now);
        }
    };
    html! {
        <label key={number} class="code-tick">
            <input type="checkbox" class="check" checked={seen.contains(&number)} {onchange} data-test="tick" />
            <span>{ words }</span>
        </label>
    }
}

fn named(converted: &Converted, name: &str) -> BlockConfig {
    let mut config = converted.config.clone();
    config.set_name(name.trim().to_owned());
    config
}

/// A name for the new block that is no longer than a name may be.
fn suggested(name: &str, kind: Kind) -> String {
    let named = |name: &str| tr!("another.name_as", name = name, kind = short(kind)).to_string();
    let room = MAX_NAME.saturating_sub(named("").chars().count());
    let name: String = name.chars().take(room).collect();
    named(name.trim_end())
}

/// In a name.
const fn short(kind: Kind) -> &'static str {
    match kind {
        Kind::MsgCipGeneric => "MSG",
        Kind::SendReqEtc100 => "ETC100",
        Kind::SendReqEtc101 => "ETC101",
        Kind::DataExch => "DATA_EXCH",
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_suggested_name_is_not_too_long() {
        assert_eq!(suggested("drive", Kind::DataExch), "drive as DATA_EXCH");
        for kind in Kind::ALL {
            let name = suggested(&"é".repeat(MAX_NAME), kind);
            assert_eq!(name.chars().count(), MAX_NAME, "{name}");
            assert!(name.ends_with(short(kind)));
        }
    }
}
