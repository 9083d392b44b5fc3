//! Words in both radices, and what they are.

use alloc::format;
use alloc::string::String;
use alloc::vec::Vec;

use crate::config::SendReqForm;
use crate::plan::MessagePlan;
use crate::plan::words::WordsPlan;
use crate::table;
use crate::wire::LogicalKind;

/// `16#0000, 16#030E`
pub(super) fn list(words: &[u16]) -> String {
    let words: Vec<String> = words.iter().map(|word| format!("16#{word:04X}")).collect();
    words.join(", ")
}

/// What a word is, beginning with its decimal value as the data editor shows an INT.
pub(super) fn about(plan: &MessagePlan, words: &WordsPlan, index: usize) -> String {
    let word = words.words.get(index).copied().unwrap_or(0);
    let [low, high] = word.to_le_bytes();
    let head = words.form.head();
    let what = match (words.form, index) {
        (SendReqForm::Etc100 | SendReqForm::Etc101, 0) if words.connected => "message type: connected".into(),
        (SendReqForm::Etc100 | SendReqForm::Etc101, 0) => "message type: unconnected".into(),
        (SendReqForm::Etc101, 1 | 2) => format!("IP address {high}.{low}"),
        _ if index == head => {
            let request = plan.request();
            let class =
                request.path().logical(LogicalKind::Class).and_then(|class| u16::try_from(class).ok());
            let name = table::service(class.unwrap_or(0), request.service()).map_or("", |entry| entry.name);
            format!("service 16#{low:02X} = {low} {name}, path of {high} words").replace(" ,", ",")
        }
        _ if index * 2 >= usize::from(words.length) => "not sent".into(),
        _ if index * 2 + 1 == usize::from(words.length) => {
            format!("byte 16#{low:02X} = {low}; the high byte is not sent")
        }
        _ => format!("bytes 16#{low:02X} 16#{high:02X} = {low} {high}"),
    };
    format!("{}: {what}", word.cast_signed())
}
