//! The lines: one axis per unit, a cursor that the pointer and the arrow keys move.

use web_sys::Element;
use yew::prelude::*;

use super::{Drawn, series::lines};
use crate::{
    browser,
    devices::i18n::tr,
    kit::{Scale, short},
};

/// What is drawn.
pub(super) struct Picture<'a> {
    pub(super) drawn: &'a [Drawn],
    pub(super) from_ms: f64,
    pub(super) to_ms: f64,
    /// As a share of the time, from its begin.
    pub(super) cursor: Option<f64>,
    /// px.
    pub(super) width: f64,
}

const HEIGHT: f64 = 220.0;
const TOP: f64 = 18.0;
const BOTTOM: f64 = 22.0;
/// Room for the numbers of an axis.
const AXIS: f64 = 58.0;

/// Variables with the same unit, whose numbers are on the same axis.
struct Axis<'a> {
    unit: &'a str,
    scale: Option<Scale>,
    /// Places in the list of what is drawn.
    members: Vec<usize>,
}

impl Picture<'_> {
    fn axes(&self) -> Vec<Axis<'_>> {
        let mut all: Vec<Axis<'_>> = Vec::new();
        for (place, drawn) in self.drawn.iter().enumerate() {
            match all.iter_mut().find(|axis| axis.unit == drawn.unit) {
                Some(axis) => axis.members.push(place),
                None => all.push(Axis { unit: &drawn.unit, scale: None, members: vec![place] }),
            }
        }
        for axis in &mut all {
            let points =
                axis.members.iter().filter_map(|place| self.drawn.get(*place)).flat_map(|it| &it.points);
            axis.scale = Scale::covering(points.filter_map(|(_, number)| *number), HEIGHT - TOP - BOTTOM);
        }
        all
    }
}

/// The picture; `on_cursor` hears where the cursor shall be.
pub(super) fn drawing(picture: &Picture<'_>, on_cursor: Callback<Option<f64>>) -> Html {
    let axes = picture.axes();
    // The first axis is at the left, the second at the right, and so on.
    let left = AXIS * f64::from(u32::try_from(axes.len().div_ceil(2)).unwrap_or(1));
    let right = picture.width - (AXIS * f64::from(u32::try_from(axes.len() / 2).unwrap_or(0))).max(8.0);
    let area = Area { left, right, from_ms: picture.from_ms, to_ms: picture.to_ms };
    let pointed = {
        let on_cursor = on_cursor.clone();
        move |event: MouseEvent| {
            let element = event.current_target().map(wasm_bindgen::JsCast::unchecked_into::<Element>);
            let at = element
                .map(|element| f64::from(event.client_x()) - element.get_bounding_client_rect().left());
            on_cursor.emit(at.map(|at| ((at - left) / (right - left)).clamp(0.0, 1.0)));
        }
    };
    let gone = on_cursor.reform(|_: MouseEvent| None);
    let cursor = picture.cursor;
    let onkeydown = move |event: KeyboardEvent| {
        let now = cursor.unwrap_or(1.0);
        let to = match event.key().as_str() {
            "ArrowLeft" => Some((now - 0.01).max(0.0)),
            "ArrowRight" => Some((now + 0.01).min(1.0)),
            "Home" => Some(0.0),
            "End" => Some(1.0),
            "Escape" => None,
            _ => return,
        };
        event.prevent_default();
        on_cursor.emit(to);
    };
    let names: Vec<_> = picture.drawn.iter().map(|drawn| drawn.name.as_str()).collect();
    html! {
        <svg
            class="trend-drawing" viewBox={format!("0 0 {} {HEIGHT}", picture.width)} height={HEIGHT.to_string()} width="100%" role="img" tabindex="0"
            aria-label={tr!("trend.spoken", names = names.join(", "))} onmousemove={pointed} onmouseleave={gone} {onkeydown}
        >
            { for axes.iter().enumerate().map(|(place, axis)| axis_of(&area, place, axis, picture.width)) }
            { for axes.iter().flat_map(|axis| axis.members.iter().map(|place| line(&area, picture, *place, axis.scale))) }
            { times(&area) }
            if let Some(share) = cursor {
                <line class="cursor" x1={fixed(area.across(share))} x2={fixed(area.across(share))} y1={fixed(TOP)} y2={fixed(HEIGHT - BOTTOM)} />
            }
        </svg>
    }
}

struct Area {
    left: f64,
    right: f64,
    from_ms: f64,
    to_ms: f64,
}

impl Area {
    fn across(&self, share: f64) -> f64 {
        self.left + share * (self.right - self.left)
    }

    fn x(&self, at_ms: f64) -> f64 {
        self.across(((at_ms - self.from_ms) / (self.to_ms - self.from_ms)).max(0.0))
    }
}

fn axis_of(area: &Area, place: usize, axis: &Axis<'_>, width: f64) -> Html {
    let Some(scale) = axis.scale else { return html! {} };
    let number = f64::from(u32::try_from(place / 2).unwrap_or(0));
    let is_left = place.is_multiple_of(2);
    let x = if is_left { area.left - AXIS * number } else { area.right + AXIS * number };
    let (at, class) = if is_left { (x - 6.0, "num end") } else { ((x + 6.0).min(width), "num") };
    // An axis of one line has its colour.
    let colour = match axis.members.as_slice() {
        [only] => format!("series-{only}"),
        _ => String::new(),
    };
    let tick = |value: f64| {
        let y = TOP + scale.down(value);
        html! { <>
            if place == 0 {
                <line class="grid" x1={fixed(area.left)} x2={fixed(area.right)} y1={fixed(y)} y2={fixed(y)} />
            }
            <text {class} x={fixed(at)} y={fixed(y + 4.0)}>{ short(value) }</text>
        </> }
    };
    html! {
        <g class={classes!("axis", colour)}>
            <line class="axis-line" x1={fixed(x)} x2={fixed(x)} y1={fixed(TOP)} y2={fixed(HEIGHT - BOTTOM)} />
            { for scale.ticks(4).into_iter().map(tick) }
            <text {class} x={fixed(at)} y="10">{ axis.unit.to_owned() }</text>
        </g>
    }
}

fn line(area: &Area, picture: &Picture<'_>, place: usize, scale: Option<Scale>) -> Html {
    let (Some(drawn), Some(scale)) = (picture.drawn.get(place), scale) else { return html! {} };
    let column_ms = (area.to_ms - area.from_ms) / (area.right - area.left).max(1.0);
    // The newest number holds until now.
    let last = drawn.points.last().map(|(_, number)| (area.to_ms, *number));
    let points = drawn.points.iter().copied().chain(last);
    let path: String = lines(points, column_ms).iter().map(|line| steps(area, line, scale)).collect();
    html! { <path class={classes!("series", format!("series-{place}"))} d={path} data-test="series" /> }
}

fn steps(area: &Area, line: &[(f64, f64)], scale: Scale) -> String {
    let step = |(place, (at, number)): (usize, &(f64, f64))| {
        let letter = if place == 0 { 'M' } else { 'L' };
        format!("{letter}{} {}", fixed(area.x(*at)), fixed(TOP + scale.down(*number)))
    };
    line.iter().enumerate().map(step).collect()
}

/// Begin, middle and end in the time of day.
fn times(area: &Area) -> Html {
    let time = |share: f64, class: &'static str| {
        let at = area.from_ms + share * (area.to_ms - area.from_ms);
        html! { <text {class} x={fixed(area.across(share))} y={fixed(HEIGHT - 6.0)}>{ browser::clock(at) }</text> }
    };
    html! { <>{ time(0.0, "time") }{ time(0.5, "time middle") }{ time(1.0, "time end") }</> }
}

/// A tenth of a pixel is enough.
fn fixed(number: f64) -> String {
    format!("{number:.1}")
}
