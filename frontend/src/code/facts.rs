//! What a block sends, shortly.

use cipdeck_shared::{
    code::Kind,
    config::{BlockId, space_hex, write_hex},
    plan::{Effect, MessagePlan},
    table,
};
use yew::prelude::*;

use super::i18n::tr;

/// `Get_Attribute_Single, class 1 Identity, instance 1, attribute 7`: what the request does, in the words of the tables.
pub(super) fn in_words(plan: &MessagePlan) -> String {
    let Some(effect) = plan.effects().first() else { return String::new() };
    let mut parts = vec![service(effect)];
    match effect.class {
        Some(class) => {
            let name = table::class(class).map_or("", |entry| entry.name);
            parts.push(format!("{} {name}", tr!("found.class", number = class)).trim_end().to_owned());
        }
        None => parts.push(tr!("found.no_class").to_string()),
    }
    parts.extend(effect.instance.map(|number| tr!("found.instance", number = number).to_string()));
    parts.extend(effect.attribute.map(|number| tr!("found.attribute", number = number).to_string()));
    let data = plan.request().data().len();
    if data > 0 {
        parts.push(tr!("found.bytes", count = data).to_string());
    }
    parts.join(", ")
}

fn service(effect: &Effect) -> String {
    let code = effect.service;
    let entry =
        effect.class.and_then(|class| table::service(class, code)).or_else(|| table::service(0, code));
    entry.map_or_else(|| format!("0x{:02X}", code.0), |entry| entry.name.to_owned())
}

/// The bytes of a request: `0E 03 20 01 24 01 30 07`.
pub(super) fn hex(bytes: &[u8]) -> String {
    space_hex(&write_hex(bytes)).to_uppercase()
}

/// The bytes, and which of them are others than these.
pub(super) fn marked(bytes: &[u8], others: &[u8]) -> Html {
    let byte = |(at, byte): (usize, &u8)| {
        let differs = others.get(at) != Some(byte);
        html! { <span key={at} class={classes!("byte", differs.then_some("differs"))}>{ format!("{byte:02X}") }</span> }
    };
    html! { <span class="code-bytes mono">{ for bytes.iter().enumerate().map(byte) }</span> }
}

/// Where a block is configured.
pub(super) fn place(kind: Kind, id: BlockId) -> String {
    match kind {
        Kind::MsgCipGeneric => format!("/deck/{id}"),
        _ => format!("/words/{id}"),
    }
}
