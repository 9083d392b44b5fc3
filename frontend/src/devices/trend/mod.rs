//! Numbers over time: chosen variables, as they were seen here since they were chosen.

mod drawing;
mod series;
mod table;

use std::rc::Rc;

use cipdeck_shared::config::{Variable, VariableId};
use web_sys::Element;
use yew::prelude::*;

pub use self::series::{Point, Series};
use self::{
    drawing::{Picture, drawing},
    table::{legend, numbers},
};
use super::{
    i18n::tr,
    live::{use_frames, use_plant},
};
use crate::browser;

#[derive(Clone, PartialEq, Properties)]
pub(super) struct TrendProps {
    pub(super) variables: Rc<[Variable]>,
    /// Nothing is drawn any more.
    pub(super) on_close: Callback<()>,
}

/// What is drawn of a variable, between two times.
pub(super) struct Drawn {
    pub(super) id: VariableId,
    pub(super) name: String,
    pub(super) unit: String,
    pub(super) points: Vec<Point>,
    /// At the cursor, or at the end.
    pub(super) at: Option<f64>,
}

/// ms that can be seen at once.
const SPANS: [u32; 4] = [30_000, 120_000, 600_000, 3_600_000];

/// ms between two pictures.
const FRAME_MS: u32 = 200;

/// The drawing, what it says in numbers, pause, span and cursor.
#[component]
pub(super) fn TrendPanel(props: &TrendProps) -> Html {
    let plant = use_plant();
    let span = use_state(|| SPANS[0]);
    let paused = use_state(|| None::<f64>);
    let cursor = use_state(|| None::<f64>);
    let node = use_node_ref();
    let ids: Rc<[VariableId]> = props.variables.iter().map(|variable| variable.id).collect();
    use_effect_with((plant.clone(), ids), |(plant, ids)| plant.values().trace(ids));
    use_effect_with(plant.clone(), |plant| {
        let plant = plant.clone();
        move || plant.values().trace(&[])
    });
    use_frames(FRAME_MS, paused.is_some());
    let to_ms = paused.unwrap_or_else(browser::now_ms);
    let from_ms = to_ms - f64::from(*span);
    let cursor_ms = cursor.map(|share| from_ms + share * f64::from(*span));
    let drawn: Vec<_> =
        props.variables.iter().map(|variable| draw(&plant, variable, from_ms, to_ms, cursor_ms)).collect();
    let width = node.cast::<Element>().map_or(0, |element| element.client_width());
    let picture =
        Picture { drawn: &drawn, from_ms, to_ms, cursor: *cursor, width: f64::from(width.max(320)) };
    let on_pause = {
        let paused = paused.clone();
        move |_: MouseEvent| paused.set(if paused.is_some() { None } else { Some(browser::now_ms()) })
    };
    let on_cursor = {
        let cursor = cursor.clone();
        Callback::from(move |share| cursor.set(share))
    };
    html! {
        <section class="trend" aria-label={tr!("trend.title")} data-test="trend">
            <div class="trend-head">
                <h2>{ tr!("trend.title") }</h2>
                { spans(&span) }
                <button type="button" class="button" aria-pressed={if paused.is_some() { "true" } else { "false" }} onclick={on_pause} data-test="trend-pause">
                    { if paused.is_some() { tr!("trend.go_on") } else { tr!("trend.pause") } }
                </button>
                <button type="button" class="quiet-button" onclick={props.on_close.reform(|_: MouseEvent| ())} data-test="trend-close">{ tr!("trend.close") }</button>
            </div>
            <div ref={node}>{ drawing(&picture, on_cursor) }</div>
            { legend(&drawn, cursor_ms) }
            { numbers(&drawn, from_ms, to_ms) }
        </section>
    }
}

fn draw(
    plant: &super::live::Plant,
    variable: &Variable,
    from_ms: f64,
    to_ms: f64,
    cursor_ms: Option<f64>,
) -> Drawn {
    let seen = plant.values().series(variable.id, |series| {
        let points: Vec<_> = series.within(from_ms, to_ms).collect();
        (points, series.at(cursor_ms.unwrap_or(to_ms)))
    });
    let (points, at) = seen.unwrap_or_default();
    let (name, unit) = (variable.config.name.clone(), variable.config.unit.clone());
    Drawn { id: variable.id, name, unit, points, at }
}

fn spans(span: &UseStateHandle<u32>) -> Html {
    let button = |ms: u32| {
        let set = span.setter();
        let is_chosen = **span == ms;
        let words = match ms / 1_000 {
            seconds @ 0..=59 => tr!("trend.seconds", count = seconds),
            seconds @ 60..=3_599 => tr!("trend.minutes", count = seconds / 60),
            seconds => tr!("trend.hours", count = seconds / 3_600),
        };
        html! {
            <button type="button" class={classes!("tool", is_chosen.then_some("chosen"))} aria-pressed={if is_chosen { "true" } else { "false" }} onclick={move |_: MouseEvent| set.set(ms)}>{ words }</button>
        }
    };
    html! { <span class="spans" role="group" aria-label={tr!("trend.span")}>{ for SPANS.into_iter().map(button) }</span> }
}
