//! The function block as an FBD editor draws it, with live values on its pins.

use cipdeck_shared::{api::BlockStatus, config::read_hex, engine::StatusBits};
use yew::prelude::*;

use super::subject::Subject;
use crate::i18n::tr;

/// One pin: its name, the value on its wire, and whether the wire is live (a BOOL that is TRUE).
struct Pin {
    name: &'static str,
    value: String,
    live: bool,
}

impl Pin {
    fn new(name: &'static str, value: impl Into<String>) -> Self {
        Self { name, value: value.into(), live: false }
    }

    fn bool(name: &'static str, value: bool) -> Self {
        Self { name, value: if value { "TRUE" } else { "FALSE" }.to_owned(), live: value }
    }
}

/// The drawing; its text alternative is the list of pins.
pub(super) fn drawing(subject: &Subject, status: &BlockStatus) -> Html {
    let (left, right) = (inputs(subject, status), outputs(status));
    let rows = left.len().max(right.len());
    let bottom = TOP + ROW * index(rows);
    html! {
        <svg class="fbd" viewBox={format!("0 0 460 {}", bottom + 14)} role="img" aria-label={tr!("drawing.label")}>
            <rect class="fbd-box" x={LEFT.to_string()} y="8" width={(RIGHT - LEFT).to_string()} height={(bottom - 4).to_string()} rx="3" />
            <text class="fbd-title" x={i32::midpoint(LEFT, RIGHT).to_string()} y="28">{ "MSG_CIPGENERIC" }</text>
            <line class="fbd-rule" x1={LEFT.to_string()} x2={RIGHT.to_string()} y1="38" y2="38" />
            { for left.iter().enumerate().map(|(row, pin)| input(pin, index(row))) }
            { for right.iter().enumerate().map(|(row, pin)| output(pin, index(row))) }
        </svg>
    }
}

const LEFT: i32 = 144;
const RIGHT: i32 = 314;
const TOP: i32 = 44;
const ROW: i32 = 24;

fn index(row: usize) -> i32 {
    i32::try_from(row).unwrap_or(0)
}

fn input(pin: &Pin, row: i32) -> Html {
    let y = TOP + ROW * row + ROW / 2;
    let wire = classes!("fbd-wire", pin.live.then_some("live"));
    html! {
        <g data-pin={pin.name}>
            <line class={wire} x1={(LEFT - 16).to_string()} x2={LEFT.to_string()} y1={y.to_string()} y2={y.to_string()} />
            <text class={value_class(pin)} x={(LEFT - 22).to_string()} y={(y + 4).to_string()} text-anchor="end">{ &pin.value }</text>
            <text class="fbd-pin" x={(LEFT + 8).to_string()} y={(y + 4).to_string()}>{ pin.name }</text>
        </g>
    }
}

fn output(pin: &Pin, row: i32) -> Html {
    let y = TOP + ROW * row + ROW / 2;
    let wire = classes!("fbd-wire", pin.live.then_some("live"));
    html! {
        <g data-pin={pin.name}>
            <line class={wire} x1={RIGHT.to_string()} x2={(RIGHT + 16).to_string()} y1={y.to_string()} y2={y.to_string()} />
            <text class={value_class(pin)} x={(RIGHT + 22).to_string()} y={(y + 4).to_string()}>{ &pin.value }</text>
            <text class="fbd-pin" x={(RIGHT - 8).to_string()} y={(y + 4).to_string()} text-anchor="end">{ pin.name }</text>
        </g>
    }
}

fn value_class(pin: &Pin) -> Classes {
    classes!("fbd-value", pin.live.then_some("live"))
}

fn inputs(subject: &Subject, status: &BlockStatus) -> Vec<Pin> {
    let config = &subject.draft.config;
    let app = &config.app_cfg;
    let data = read_hex(&config.req_data).map_or_else(|_| "?".to_owned(), |data| bytes(&data));
    let sent =
        subject.plan.as_ref().map_or_else(|| "?".to_owned(), |plan| plan.request().data().len().to_string());
    vec![
        Pin::bool("IN", status.input),
        Pin::new("CtrlCfg", format!("TriggerType {}", config.ctrl_cfg.trigger_type)),
        Pin::new("AppCfg", format!("{} · {}/{}/{}", app.service, app.class, app.instance, app.attribute)),
        Pin::new("TargetCfg", short(&config.target_cfg.path, 16)),
        Pin::new("ReqData", data),
        Pin::new("ReqLength", sent),
    ]
}

fn outputs(status: &BlockStatus) -> Vec<Pin> {
    let codes = &status.status;
    let data = read_hex(&status.res_data).unwrap_or_default();
    vec![
        Pin::bool("Q", status.q),
        Pin::new("StatusBits", short(&bits(codes.status_bits), 16)),
        Pin::new("ErrorID", codes.error_id.to_string()),
        Pin::new("SubErrorID", codes.sub_error_id.to_string()),
        Pin::new("ResLength", status.res_length.to_string()),
        Pin::new("ResData", bytes(&data)),
    ]
}

fn bits(bits: StatusBits) -> String {
    let names: Vec<_> =
        StatusBits::NAMES.iter().filter(|(bit, _)| bits.has(*bit)).map(|(_, name)| *name).collect();
    format!("{} {}", bits.0, names.join(" ")).trim_end().to_owned()
}

/// The first bytes: all of them are in the byte view.
fn bytes(data: &[u8]) -> String {
    let shown: Vec<_> = data.iter().take(4).map(|byte| format!("{byte:02X}")).collect();
    let more = if data.len() > 4 { " …" } else { "" };
    if data.is_empty() { "–".to_owned() } else { format!("{}{more}", shown.join(" ")) }
}

fn short(text: &str, most: usize) -> String {
    if text.chars().count() <= most {
        return text.to_owned();
    }
    text.chars().take(most - 1).chain(['…']).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn values_on_pins_are_short() {
        assert_eq!(bytes(&[]), "–");
        assert_eq!(bytes(&[4, 0x43, 0x50, 0x48]), "04 43 50 48");
        assert_eq!(bytes(&[4, 0x43, 0x50, 0x48, 0x31]), "04 43 50 48 …");
        assert_eq!(short("4,192.168.1.100", 20), "4,192.168.1.100");
        assert_eq!(short("4,drive-3.line-7.plant", 20), "4,drive-3.line-7.pl…");
        assert_eq!(bits(StatusBits(13)), "13 EN ST ER");
        assert_eq!(bits(StatusBits(0)), "0");
    }
}
