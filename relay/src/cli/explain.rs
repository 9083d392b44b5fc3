//! An error in words: what the numbers mean, what happened, and how well that is known.

use cipdeck_shared::api::BlockStatus;
use cipdeck_shared::engine::{Cause, CauseKind, RefusedBy};
use cipdeck_shared::table::{self, Entry};
use cipdeck_shared::wire::{EncapsulationStatus, GeneralStatus};

/// Sentences about a failed block, the most important first. A block with words has reports instead of `ErrorID`s.
pub(super) fn sentences(block: &BlockStatus) -> Vec<String> {
    let status = &block.status;
    let numbers = format!("ErrorID {} SubErrorID {}", status.error_id, status.sub_error_id);
    let mut sentences = Vec::new();
    if status.error_id == 224 {
        let general = GeneralStatus(u8::try_from(status.sub_error_id).unwrap_or(u8::MAX));
        let who = who(block.cause.as_ref().and_then(|cause| cause.by));
        let what = match &block.words {
            None => format!(
                "{numbers} ExtErrorID {}: {who} refused with general status {general}",
                status.ext_error_id
            ),
            Some(_) => format!("NOT a success: {who} refused with general status {general}"),
        };
        sentences.push(entry(&what, table::general_status(general)));
        let extended = block.cause.as_ref().and_then(|cause| cause.additional.first());
        if let Some(word) = extended {
            sentences.push(entry(
                &format!("Extended status 0x{word:04x}"),
                table::extended_status(general, *word),
            ));
        }
    } else if block.words.is_none() {
        sentences.push(entry(&numbers, table::block_error(status.error_id, status.sub_error_id)));
    }
    if let Some(cause) = &block.cause {
        sentences.extend(happened(block, cause));
    }
    sentences
}

fn who(by: Option<RefusedBy>) -> &'static str {
    match by {
        None => "the device",
        Some(RefusedBy::Router) => "a router on the way, not the device,",
        Some(RefusedBy::ForwardOpen) => {
            "the Connection Manager, asked to open the connection (Forward_Open),"
        }
    }
}

/// What happened beside the numbers.
fn happened(block: &BlockStatus, cause: &Cause) -> Vec<String> {
    let mut sentences = Vec::new();
    let what = match &cause.what {
        CauseKind::Timeout => Some("The time ran out."),
        CauseKind::Refused => Some("Nobody listens at that TCP port."),
        CauseKind::Unreachable => Some("The address cannot be reached."),
        CauseKind::Unresolved => Some("The name is unknown."),
        CauseKind::SessionRefused => Some("The target refused the EtherNet/IP session."),
        CauseKind::EncapsulationStatus => {
            Some("The target answered below CIP, with an encapsulation status.")
        }
        CauseKind::Malformed => Some("The answer made no sense."),
        CauseKind::Closed => Some("The target closed the connection."),
        CauseKind::Limit => Some("All 16 sessions, or all 16 connections, of the controller are in use."),
        CauseKind::TooSmall if block.words.is_some() => Some("The reply is longer than Received_Data."),
        CauseKind::TooSmall => Some("The reply is longer than ResDataSize."),
        CauseKind::Invalid => Some("The configuration has errors."),
        CauseKind::Cancelled => Some("It was cancelled."),
        CauseKind::NotPermitted => Some("The relay did not permit it: nothing was sent."),
        // The device has said it itself; a kind from the future says it with its numbers.
        _ => None,
    };
    sentences.extend(what.map(str::to_owned));
    if let Some(code) = cause.status {
        let named = table::encapsulation_status(EncapsulationStatus(code));
        sentences.push(entry(&format!("encapsulation status 0x{code:02x}"), named));
    }
    if let Some(words) = cause.remaining_path.filter(|words| *words > 0) {
        sentences.push(format!("Where it was refused, {words} word(s) of the route were left."));
    }
    if let Some(detail) = &cause.detail {
        sentences.push(format!("{detail}."));
    }
    if cause.has_acted {
        sentences.push("The device has carried the request out.".to_owned());
    }
    if cause.may_have_acted {
        sentences.push("The request had been sent: the device may have carried it out.".to_owned());
    }
    sentences
}

/// `what: name. meaning. hint. (confidence)`
pub(super) fn entry(what: &str, entry: Option<Entry>) -> String {
    let Some(entry) = entry else { return format!("{what}: not in our tables.") };
    let parts = [entry.name, entry.meaning, entry.hint].into_iter().filter(|part| !part.is_empty());
    let ended = |part: &str| if part.ends_with(['.', '?']) { part.to_owned() } else { format!("{part}.") };
    let parts: Vec<_> = parts.map(ended).collect();
    format!("{what}: {} ({})", parts.join(" "), entry.confidence.word())
}

#[cfg(test)]
mod tests {
    use cipdeck_shared::config::BlockId;
    use cipdeck_shared::engine::{BlockView, CipStatus};

    use super::*;

    fn failed(error_id: u16, sub_error_id: u16, cause: Cause) -> String {
        let status = CipStatus { error: true, error_id, sub_error_id, ..CipStatus::default() };
        let view = BlockView { status, cause: Some(cause), ..BlockView::default() };
        sentences(&BlockStatus::new(BlockId(1), &view, None, None)).join(" ")
    }

    #[test]
    fn a_refusal_names_the_general_status_and_its_confidence() {
        let text = failed(224, 5, Cause::new(CauseKind::RefusedByDevice));
        for part in ["ErrorID 224 SubErrorID 5", "0x05", "Path destination unknown", "(confirmed)"] {
            assert!(text.contains(part), "{text}");
        }
    }

    #[test]
    fn a_refusal_on_the_way_is_not_said_to_be_the_device_s() {
        let by = |by| Cause {
            by: Some(by),
            remaining_path: Some(1),
            additional: vec![0x0312],
            ..Cause::new(CauseKind::RefusedByDevice)
        };
        let text = failed(224, 1, by(RefusedBy::Router));
        for part in
            ["a router on the way, not the device, refused", "0x0312: Link address not valid", "1 word(s)"]
        {
            assert!(text.contains(part), "{text}");
        }
        assert!(failed(224, 1, by(RefusedBy::ForwardOpen)).contains("Forward_Open"));
    }

    #[test]
    fn an_encapsulation_status_is_named_even_when_no_table_knows_it() {
        let cause =
            Cause { status: Some(8), may_have_acted: true, ..Cause::new(CauseKind::EncapsulationStatus) };
        let text = failed(69, 65, cause);
        for part in ["ErrorID 69 SubErrorID 65", "encapsulation status 0x08", "may have carried it out"] {
            assert!(text.contains(part), "{text}");
        }
    }
}
