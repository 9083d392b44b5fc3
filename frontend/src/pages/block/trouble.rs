//! An error in words: what happened, what the numbers mean and how well that is known, what to try.

use cipdeck_shared::{
    api::BlockStatus,
    engine::{Cause, RefusedBy},
    table::{Confidence, Entry},
};
use yew::prelude::*;

use super::{codes::entries, way::stuck_at};
use crate::i18n::{CAUSE, TRY, find, tr};

/// Everything known about a failed run of a block with this path.
pub(super) fn trouble(status: &BlockStatus, path: &str) -> Html {
    let codes = &status.status;
    let cause = status.cause.as_ref();
    let entries = entries(codes, cause.and_then(|cause| cause.status));
    let key = match cause.and_then(|cause| cause.by) {
        Some(RefusedBy::Router) => "refused_by_router",
        Some(RefusedBy::ForwardOpen) => "connection_refused",
        None => cause.map_or("", |cause| cause.what.word()),
    };
    let stuck = cause.and_then(|cause| stuck_at(path, cause));
    // A cause of a newer relay has no text here: its own word is better than nothing.
    let what = find(CAUSE, key).unwrap_or(key);
    let tries = find(TRY, key);
    let hints: Vec<_> = entries.iter().map(|entry| entry.hint).filter(|hint| !hint.is_empty()).collect();
    html! {
        <div class="trouble" data-test="error">
            <p class="trouble-title">
                <span class="trouble-codes mono" data-test="error-codes">{ numbers(status) }</span>
                <b data-test="error-name">{ entries.first().map_or("", |entry| entry.name) }</b>
            </p>
            <p data-test="cause">{ what }{ " " }{ stuck }{ " " }{ detail(cause) }</p>
            { acted(cause) }
            <ul class="entries-of-error">{ for entries.iter().map(explain) }</ul>
            if tries.is_some() || !hints.is_empty() {
                <h3>{ tr!("error.try") }</h3>
                <ul class="tries">
                    { for hints.iter().map(|hint| html! { <li>{ *hint }</li> }) }
                    { for tries.iter().map(|words| html! { <li>{ words }</li> }) }
                </ul>
            }
        </div>
    }
}

/// `ErrorID 224 · SubErrorID 5 (0x05) · ExtErrorID 0`
fn numbers(status: &BlockStatus) -> String {
    let codes = &status.status;
    let hex = |value: u16| format!("{value} (0x{value:02X})");
    let ext = if codes.ext_error_id == 0 {
        String::new()
    } else {
        format!(" · ExtErrorID {0} (0x{0:04X})", codes.ext_error_id)
    };
    format!("ErrorID {} · SubErrorID {}{ext}", codes.error_id, hex(codes.sub_error_id))
}

fn detail(cause: Option<&Cause>) -> String {
    let Some(cause) = cause else { return String::new() };
    let mut parts = Vec::new();
    parts.extend(
        cause.status.map(|status| tr!("error.encapsulation", status = format!("0x{status:02X}")).to_string()),
    );
    parts.extend(cause.byte.map(|byte| tr!("error.byte", byte = byte).to_string()));
    if cause.additional.len() > 1 {
        let words: Vec<_> = cause.additional.iter().map(|word| format!("0x{word:04X}")).collect();
        parts.push(tr!("error.additional", words = words.join(" ")).to_string());
    }
    parts.extend(cause.detail.clone());
    parts.join(" ")
}

/// The device may have, or has, carried out a request that failed.
pub(crate) fn acted(cause: Option<&Cause>) -> Html {
    match cause {
        Some(cause) if cause.has_acted => {
            html! { <p class="warning-text" data-test="has-acted">{ tr!("error.has_acted") }</p> }
        }
        Some(cause) if cause.may_have_acted => {
            html! { <p class="warning-text" data-test="may-have-acted">{ tr!("error.may_have_acted") }</p> }
        }
        _ => html! {},
    }
}

pub(crate) fn explain(entry: &Entry) -> Html {
    let confidence = match entry.confidence {
        Confidence::Confirmed => tr!("confidence.confirmed"),
        Confidence::Inferred => tr!("confidence.inferred"),
        Confidence::Recalled => tr!("confidence.recalled"),
        Confidence::FieldReport => tr!("confidence.field_report"),
        Confidence::Doubtful => tr!("confidence.doubtful"),
    };
    html! {
        <li>
            <b>{ entry.name }</b>
            if !entry.meaning.is_empty() {
                { ": " }{ entry.meaning }
            }
            <span class={classes!("confidence", (entry.confidence != Confidence::Confirmed).then_some("unsure"))} title={entry.source}>
                { confidence }
            </span>
        </li>
    }
}
