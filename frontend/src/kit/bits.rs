//! EN, EW, ST, ER, DN: lit bits have their shape and colour, the others are there but quiet.

use cipdeck_shared::engine::StatusBits;
use yew::prelude::*;

use super::state::Shape;
use crate::i18n::tr;

/// The bits of `Status.StatusBits` in the manual's order.
pub fn status_bits(bits: StatusBits) -> Html {
    let bit = |(bit, name): &(u16, &'static str)| {
        let on = bits.has(*bit);
        let shape = shape(*bit);
        html! {
            <li
                key={*name}
                class={classes!("bit", on.then_some("on"), name.to_ascii_lowercase())}
                title={meaning(*bit)}
                data-bit={*name}
                data-on={if on { "true" } else { "false" }}
            >
                { if on { shape.draw() } else { Shape::Ring.draw() } }
                <span>{ *name }</span>
                <span class="unseen">{ if on { tr!("bit.on") } else { tr!("bit.off") } }</span>
            </li>
        }
    };
    // The two closing bits are rare: shown when set.
    let shown = StatusBits::NAMES.iter().filter(|(bit, _)| *bit <= StatusBits::DN || bits.has(*bit));
    html! { <ul class="bits" aria-label={tr!("bit.label")} data-test="status-bits">{ for shown.map(bit) }</ul> }
}

/// The shape of a lit bit.
const fn shape(bit: u16) -> Shape {
    match bit {
        StatusBits::EW => Shape::Half,
        StatusBits::ST => Shape::Arrow,
        StatusBits::ER => Shape::Cross,
        StatusBits::DN => Shape::Tick,
        _ => Shape::Dot,
    }
}

fn meaning(bit: u16) -> AttrValue {
    match bit {
        StatusBits::EN => tr!("bit.en"),
        StatusBits::EW => tr!("bit.ew"),
        StatusBits::ST => tr!("bit.st"),
        StatusBits::ER => tr!("bit.er"),
        StatusBits::DN => tr!("bit.dn"),
        StatusBits::CIPCONN => tr!("bit.cipconn"),
        _ => tr!("bit.eipsess"),
    }
}
