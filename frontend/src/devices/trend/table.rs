//! The same in numbers: for those who listen, and for those who want to know exactly.

use yew::prelude::*;

use super::Drawn;
use crate::{browser, devices::i18n::tr, kit::short};

/// Line, name, number at the cursor or now, smallest and biggest of what is drawn.
pub(super) fn legend(drawn: &[Drawn], cursor_ms: Option<f64>) -> Html {
    let at = cursor_ms.map_or(tr!("trend.now"), |at| tr!("trend.at", time = browser::clock(at)));
    let row = |(place, it): (usize, &Drawn)| {
        let all = || it.points.iter().filter_map(|(_, number)| *number);
        let low = all().reduce(f64::min);
        let high = all().reduce(f64::max);
        html! {
            <tr key={it.id.to_string()} data-test="legend">
                <th scope="row">
                    <svg class="sample" viewBox="0 0 24 8" width="24" height="8" aria-hidden="true"><path class={classes!("series", format!("series-{place}"))} d="M0 4L24 4" /></svg>
                    { &it.name }
                </th>
                <td class="num">{ number(it.at) }</td>
                <td>{ &it.unit }</td>
                <td class="num">{ number(low) }</td>
                <td class="num">{ number(high) }</td>
                <td class="quiet">{ if it.points.iter().all(|(_, number)| number.is_none()) { tr!("trend.nothing") } else { AttrValue::default() } }</td>
            </tr>
        }
    };
    html! {
        <table class="listing legend" aria-label={tr!("trend.legend")}>
            <thead><tr>
                <th scope="col">{ tr!("variable.name") }</th><th scope="col" class="num">{ at }</th><th scope="col">{ tr!("variable.unit") }</th>
                <th scope="col" class="num">{ tr!("row.low") }</th><th scope="col" class="num">{ tr!("row.high") }</th><th></th>
            </tr></thead>
            <tbody>{ for drawn.iter().enumerate().map(row) }</tbody>
        </table>
    }
}

/// Lines of the table.
const LINES: u32 = 12;

/// Evenly spread times and the numbers that held then.
pub(super) fn numbers(drawn: &[Drawn], from_ms: f64, to_ms: f64) -> Html {
    let time = |place: u32| from_ms + (to_ms - from_ms) * f64::from(place) / f64::from(LINES - 1);
    let held = |it: &Drawn, at: f64| {
        let next = it.points.partition_point(|(of, _)| *of <= at);
        next.checked_sub(1).and_then(|place| it.points.get(place)).and_then(|(_, number)| *number)
    };
    let row = |place: u32| {
        html! {
            <tr key={place}>
                <th scope="row" class="mono">{ browser::clock(time(place)) }</th>
                { for drawn.iter().map(|it| html! { <td class="num">{ number(held(it, time(place))) }</td> }) }
            </tr>
        }
    };
    html! {
        <details class="numbers" data-test="trend-numbers">
            <summary>{ tr!("trend.numbers") }</summary>
            <div class="scroll"><table class="listing" aria-label={tr!("trend.numbers")}>
                <thead><tr><th scope="col">{ tr!("trend.time") }</th>{ for drawn.iter().map(|it| html! { <th scope="col" class="num">{ &it.name }</th> }) }</tr></thead>
                <tbody>{ for (0..LINES).map(row) }</tbody>
            </table></div>
        </details>
    }
}

fn number(number: Option<f64>) -> String {
    number.map_or_else(|| "–".to_owned(), short)
}
