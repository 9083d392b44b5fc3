//! EN, EW, ST, ER and DN over time, as the manual's timing diagrams draw them: one column per edge, not to scale.

use std::fmt::Write;

use cipdeck_shared::engine::StatusBits;
use yew::prelude::*;

use crate::{i18n::tr, store::Edge};

/// The diagram of a run; its text alternative names every edge.
pub(super) fn axis(edges: &[Edge]) -> Html {
    if edges.is_empty() {
        return html! { <p class="axis-empty quiet">{ tr!("axis.empty") }</p> };
    }
    let edges = edges.get(edges.len().saturating_sub(MOST)..).unwrap_or_default();
    // The two closing bits are rare: drawn when set.
    let ever = |bit: u16| edges.iter().any(|(_, bits)| bits.has(bit));
    let lanes: Vec<_> =
        StatusBits::NAMES.iter().filter(|(bit, _)| *bit <= StatusBits::DN || ever(*bit)).collect();
    let left = if lanes.len() > 5 { WIDE_LEFT } else { LEFT };
    let bottom = TOP + LANE * i32::try_from(lanes.len()).unwrap_or(5);
    html! {
        <figure class="axis">
            <figcaption>{ tr!("axis.caption") }</figcaption>
            <svg viewBox={format!("0 0 440 {}", bottom + 18)} role="img" aria-label={spoken(edges)}>
                { for edges.iter().enumerate().map(|(column, (time, _))| tick(x(left, column, edges.len()), *time, bottom)) }
                { for lanes.iter().enumerate().map(|(lane, (bit, name))| draw_lane(left, lane, *bit, name, edges)) }
            </svg>
        </figure>
    }
}

/// Edges that fit beside each other; the newest are shown.
const MOST: usize = 8;
const LEFT: i32 = 34;
/// With room for `CIPCONN`.
const WIDE_LEFT: i32 = 56;
const RIGHT: i32 = 434;
const TOP: i32 = 4;
const LANE: i32 = 16;

fn x(left: i32, column: usize, columns: usize) -> i32 {
    let (column, columns) = (i32::try_from(column).unwrap_or(0), i32::try_from(columns).unwrap_or(1));
    left + (RIGHT - left) * column / columns.max(1)
}

fn tick(x: i32, time: u64, bottom: i32) -> Html {
    let x = x.to_string();
    html! { <>
        <line class="axis-tick" x1={x.clone()} x2={x.clone()} y1={TOP.to_string()} y2={bottom.to_string()} />
        <text class="axis-time" {x} y={(bottom + 12).to_string()}>{ duration(time) }</text>
    </> }
}

fn draw_lane(left: i32, lane: usize, bit: u16, name: &'static str, edges: &[Edge]) -> Html {
    let low = TOP + LANE * i32::try_from(lane + 1).unwrap_or(1) - 4;
    let level = |bits: StatusBits| if bits.has(bit) { low - LANE + 6 } else { low };
    let mut path = String::new();
    for (column, (_, bits)) in edges.iter().enumerate() {
        let start = if column == 0 { 'M' } else { 'L' };
        let (from, to, y) = (x(left, column, edges.len()), x(left, column + 1, edges.len()), level(*bits));
        // Writing to a String cannot fail.
        let _ = write!(path, "{start}{from} {y}L{to} {y}");
    }
    let ever = edges.iter().any(|(_, bits)| bits.has(bit));
    html! { <>
        <text class={classes!("axis-name", ever.then_some("on"))} x="0" y={(low + 1).to_string()}>{ name }</text>
        <path class={classes!("axis-lane", name.to_ascii_lowercase(), ever.then_some("on"))} d={path} />
    </> }
}

fn spoken(edges: &[Edge]) -> String {
    let edge = |(time, bits): &Edge| {
        let names: Vec<_> =
            StatusBits::NAMES.iter().filter(|(bit, _)| bits.has(*bit)).map(|(_, name)| *name).collect();
        format!("{}: {}", duration(*time), if names.is_empty() { "–".to_owned() } else { names.join(" ") })
    };
    edges.iter().map(edge).collect::<Vec<_>>().join("; ")
}

/// `412 µs`, `5.1 ms`, `3.00 s`
pub(crate) fn duration(us: u64) -> String {
    // Whole numbers: Rust's floating point in decimal would be 2 kB of the page.
    match us {
        0 => "0".to_owned(),
        1..1_000 => format!("{us} µs"),
        1_000..1_000_000 => {
            let tenths = (us + 50) / 100;
            format!("{}.{} ms", tenths / 10, tenths % 10)
        }
        _ => {
            let hundredths = (us + 5_000) / 10_000;
            format!("{}.{:02} s", hundredths / 100, hundredths % 100)
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn times_have_the_unit_that_fits() {
        for (us, text) in [(0, "0"), (412, "412 µs"), (5_120, "5.1 ms"), (3_000_000, "3.00 s")] {
            assert_eq!(duration(us), text);
        }
    }

    #[test]
    fn the_text_alternative_names_every_edge() {
        let edges = [(0, StatusBits(1)), (4, StatusBits(3)), (412, StatusBits(17))];
        assert_eq!(spoken(&edges), "0: EN; 4 µs: EN EW; 412 µs: EN DN");
    }
}
