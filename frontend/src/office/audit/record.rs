//! One record: when, what, who, and what belongs to it.

use cipdeck_shared::{api::AuditRecord, config::space_hex};
use serde_json::Value;
use yew::prelude::*;

use super::event_words;
use crate::{
    i18n::{MEMBER, find},
    office::{i18n::tr, when},
};

/// A line; the chain's own members are shown when somebody asks for them.
pub(super) fn record(record: &AuditRecord) -> Html {
    let bad = BAD.contains(&record.event.as_str()).then_some("bad");
    html! {
        <tr key={record.seq} data-test="record" data-event={record.event.clone()}>
            <td class="number-time" title={record.at.clone()}>{ when(&record.at) }</td>
            <td class={bad}><b>{ event_words(&record.event) }</b></td>
            <td>
                { &record.actor }
                if !record.from.is_empty() {
                    <span class="quiet mono">{ " " }{ &record.from }</span>
                }
            </td>
            <td>
                <dl class="members">{ for record.members.iter().map(member) }</dl>
                <details class="chain">
                    <summary>{ tr!("audit.number", seq = record.seq) }</summary>
                    <code class="mono">{ &record.hash }</code>
                </details>
            </td>
        </tr>
    }
}

fn member((name, value): (&String, &Value)) -> Html {
    let words = find(MEMBER, name).map_or_else(|| name.clone().into(), AttrValue::Static);
    let text = match value {
        Value::String(text) if BYTES.contains(&name.as_str()) => space_hex(text).to_ascii_uppercase(),
        Value::String(text) => text.clone(),
        other => other.to_string(),
    };
    if text.is_empty() {
        return html! {};
    }
    html! { <><dt>{ words }</dt><dd class={BYTES.contains(&name.as_str()).then_some("mono")}>{ text }</dd></> }
}

/// What somebody should look at.
const BAD: [&str; 5] = ["write_denied", "sign_in_failed", "chain_broken", "audit_resumed", "read_only_on"];

/// Members that are hexadecimal text.
const BYTES: [&str; 5] = ["request", "reply", "old", "new", "read_back"];
