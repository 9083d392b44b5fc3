//! The function block as Control Expert's FBD editor draws it, with live values on its pins.

use cipdeck_shared::{
    api::WordsStatus,
    config::{SendReqForm, write_words},
};
use yew::prelude::*;

use super::subject::Subject;
use crate::words::i18n::tr;

/// One pin: its name, the value on its wire, and whether the wire is live (a BOOL that is TRUE).
struct Pin {
    name: &'static str,
    row: i32,
    value: String,
    live: bool,
}

impl Pin {
    fn new(name: &'static str, row: i32, value: impl Into<String>) -> Self {
        Self { name, row, value: value.into(), live: false }
    }

    fn bool(name: &'static str, value: bool) -> Self {
        Self { name, row: 0, value: if value { "TRUE" } else { "FALSE" }.to_owned(), live: value }
    }
}

/// The drawing; its text alternative is the list of pins.
pub(super) fn drawing(subject: &Subject, en: bool, words: Option<&WordsStatus>) -> Html {
    let name = if subject.draft.config.form() == SendReqForm::DataExch { "DATA_EXCH" } else { "SEND_REQ" };
    let bottom = TOP + ROW * ROWS;
    let through = y_of(ROWS - 1);
    html! {
        <svg class="fbd" viewBox={format!("0 0 520 {}", bottom + 14)} role="img" aria-label={tr!("drawing.label")}>
            <rect class="fbd-box" x={LEFT.to_string()} y="8" width={(RIGHT - LEFT).to_string()} height={(bottom - 4).to_string()} rx="3" />
            <text class="fbd-title" x={i32::midpoint(LEFT, RIGHT).to_string()} y="28">{ name }</text>
            <line class="fbd-rule" x1={LEFT.to_string()} x2={RIGHT.to_string()} y1="38" y2="38" />
            // In and out: one variable, seen on both sides.
            <line class="fbd-through" x1={(LEFT + 132).to_string()} x2={RIGHT.to_string()} y1={through.to_string()} y2={through.to_string()} />
            { for inputs(subject, en).iter().map(|pin| draw(pin, LEFT, -1, true)) }
            { for outputs(words).iter().map(|pin| draw(pin, RIGHT, 1, pin.row != ROWS - 1)) }
        </svg>
    }
}

const LEFT: i32 = 162;
const RIGHT: i32 = 364;
const TOP: i32 = 44;
const ROW: i32 = 24;
const ROWS: i32 = 5;
/// Characters of a value beside the block.
const FITS: usize = 18;

fn y_of(row: i32) -> i32 {
    TOP + ROW * row + ROW / 2
}

/// `side`: -1 on the left, 1 on the right.
fn draw(pin: &Pin, edge: i32, side: i32, named: bool) -> Html {
    let (y, text_y) = (y_of(pin.row), (y_of(pin.row) + 4).to_string());
    let (outside, inside) = if side < 0 { ("end", "start") } else { ("start", "end") };
    let live = pin.live.then_some("live");
    html! {
        <g data-pin={pin.name}>
            <line class={classes!("fbd-wire", live)} x1={edge.to_string()} x2={(edge + 14 * side).to_string()} y1={y.to_string()} y2={y.to_string()} />
            <text class={classes!("fbd-value", live)} x={(edge + 20 * side).to_string()} y={text_y.clone()} text-anchor={outside}>{ &pin.value }</text>
            if named {
                <text class="fbd-pin" x={(edge - 8 * side).to_string()} y={text_y} text-anchor={inside}>{ pin.name }</text>
            }
        </g>
    }
}

fn inputs(subject: &Subject, en: bool) -> Vec<Pin> {
    let draft = &subject.draft;
    let config = &draft.config;
    let request = if config.form() == SendReqForm::DataExch {
        Pin::new("Type", 2, config.exchange_type.to_string())
    } else {
        Pin::new("Request_Code", 2, format!("16#{:04X}", config.request_code))
    };
    let words = draft.words().map_or_else(|| "?".to_owned(), |words| write_words(&words));
    let set = |index: usize| config.management_param.get(index).copied().unwrap_or_default();
    vec![
        Pin::bool("EN", en),
        Pin::new("Address", 1, short(bare(&config.address))),
        request,
        Pin::new("Data_to_Send", 3, short(&words)),
        Pin::new("Management_Param", 4, format!("[2] {} · [3] {}", set(2), set(3))),
    ]
}

fn outputs(words: Option<&WordsStatus>) -> Vec<Pin> {
    let none = || "–".to_owned();
    let text = |words: &WordsStatus| write_words(&words.management_param);
    let received = words.filter(|words| !words.received_data.is_empty());
    vec![
        Pin::bool("ENO", words.is_some_and(|words| words.eno)),
        Pin::new("Received_Data", 3, received.map_or_else(none, |words| short(&words.received_data))),
        Pin::new("Management_Param", 4, words.map_or_else(none, text)),
    ]
}

/// `0.2.0.192.168.1.102` of `ADDR('0.2.0.192.168.1.102')`
fn bare(address: &str) -> &str {
    address.split(['\'', '"']).nth(1).unwrap_or(address)
}

fn short(text: &str) -> String {
    if text.chars().count() <= FITS {
        return text.to_owned();
    }
    let mut short: String = text.chars().take(FITS - 1).collect();
    short.truncate(short.trim_end().len());
    format!("{short}…")
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_value_fits_beside_the_block() {
        assert_eq!(short("0000 030E 0120"), "0000 030E 0120");
        assert_eq!(short("0000 030E 0120 0124 0730"), "0000 030E 0120 01…");
        assert_eq!(bare("ADDR('0.2.0.192.168.1.102')"), "0.2.0.192.168.1.102");
        assert_eq!(bare("0.4.0"), "0.4.0");
    }
}
