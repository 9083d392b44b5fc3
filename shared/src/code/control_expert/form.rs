//! Which of the three layouts a table of words has.

use alloc::format;
use alloc::string::{String, ToString};
use alloc::vec::Vec;

use crate::config::{SendReq, SendReqForm, bytes_of, write_words};
use crate::wire::{LogicalKind, MessageRouterRequest, Segment};

/// The layouts in which words are a whole request: message type 0 or 1 where there is one, then a service and a path
/// that can be read.
pub(super) fn possible(words: &[u16]) -> Vec<SendReqForm> {
    let bytes = bytes_of(words);
    let fits = |form: &SendReqForm| {
        let has_type = *form == SendReqForm::DataExch || matches!(words.first(), Some(0 | 1));
        has_type && bytes.get(2 * form.head()..).is_some_and(is_request)
    };
    SendReqForm::ALL.into_iter().filter(fits).collect()
}

/// A request to an object or a tag.
fn is_request(bytes: &[u8]) -> bool {
    let Ok(request) = MessageRouterRequest::decode(bytes) else { return false };
    let begins = match request.path().segments().first() {
        Some(Segment::Logical(first)) => first.kind == LogicalKind::Class,
        Some(Segment::Symbol(_)) => true,
        _ => false,
    };
    (1..=0x7F).contains(&request.service().0) && begins
}

/// What is said about how a layout was recognised.
pub(super) fn why(form: SendReqForm, words: &[u16]) -> String {
    let kind = words.first().copied().unwrap_or(0);
    match form {
        SendReqForm::Etc100 => format!("recognised as {form}: message type {kind}, then the CIP request"),
        SendReqForm::Etc101 => {
            format!(
                "recognised as {form}: message type {kind}, two words of IP address, then the CIP request"
            )
        }
        SendReqForm::DataExch => format!("recognised as {form}: the CIP request begins at once"),
    }
}

/// A block of words whose program says nothing else.
pub(super) fn block(form: SendReqForm, name: &str, words: &[u16]) -> SendReq {
    let mut config = SendReq::new(form, name);
    config.address = address(form).to_string();
    config.data_to_send = write_words(words);
    set_length(&mut config, 2 * words.len());
    config
}

/// `Management_Param[3]`.
pub(super) fn set_length(config: &mut SendReq, bytes: usize) {
    if let Some(length) = config.management_param.get_mut(3) {
        *length = i64::try_from(bytes).unwrap_or(i64::MAX);
    }
}

/// Of no device: 0.0.0.0 is the built-in simulated one.
pub(super) const fn address(form: SendReqForm) -> &'static str {
    match form {
        SendReqForm::Etc100 => "ADDR('0.0.0.0.0.0.0')",
        SendReqForm::Etc101 => "ADDR('0.0.0')",
        SendReqForm::DataExch => "ADDMX('0.0.0{0.0.0.0}UNC.CIP')",
    }
}

/// What is said about such an address.
pub(super) const fn no_address(form: SendReqForm) -> &'static str {
    match form {
        SendReqForm::Etc100 | SendReqForm::DataExch => {
            "the text names no device: 0.0.0.0 is the built-in simulated device; write the Address"
        }
        SendReqForm::Etc101 => {
            "the text does not say where the module is: rack 0, slot 0, channel 0 are taken; write the Address"
        }
    }
}
