//! The words of a SEND_REQ or DATA_EXCH, for people.

use cipdeck_shared::api::WordsStatus;
use cipdeck_shared::config::{SendReqForm, write_words};
use cipdeck_shared::table::{self, ReportList};

use super::explain;

/// What a run has left in the words.
pub(super) fn lines(words: &WordsStatus, form: SendReqForm) -> Vec<String> {
    let [_, _, timeout, length] = words.management_param;
    let mut lines = vec![
        format!("Management_Param  {}", write_words(&words.management_param)),
        format!("  exchange {}, activity bit {}", words.exchange(), u8::from(words.is_active())),
    ];
    lines.extend(reports(words, form).into_iter().map(|report| format!("  {report}")));
    lines.push(match timeout {
        0 => "  timeout 0: waits for ever".to_owned(),
        tenths => format!("  timeout {tenths} x 100 ms"),
    });
    lines.push(format!("  length {length}: bytes received"));
    let received = if words.received_data.is_empty() { "nothing" } else { &words.received_data };
    lines.push(format!("Received_Data     {received}"));
    lines
}

/// Both reports in words.
pub(super) fn reports(words: &WordsStatus, form: SendReqForm) -> Vec<String> {
    let (communication, operation) = (words.communication_report(), words.operation_report());
    let said = table::communication_report(communication);
    let mut reports = vec![explain::entry(&format!("communication report 16#{communication:02X}"), said)];
    let list = match form {
        SendReqForm::Etc100 => ReportList::Etc100,
        SendReqForm::Etc101 | SendReqForm::DataExch => ReportList::DataExch,
    };
    if communication == table::MESSAGE_REFUSED || operation != 0 {
        let said = table::operation_report(list, communication, operation);
        reports.push(explain::entry(&format!("operation report 16#{operation:02X}"), said));
    }
    reports
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_refused_message_names_both_reports_in_the_words_of_its_module() {
        let words =
            WordsStatus { management_param: [0x0700, 0x13FF, 0, 0], received_data: String::new(), eno: true };
        let text = lines(&words, SendReqForm::DataExch).join("\n");
        for part in [
            "Management_Param  0700 13FF 0000 0000",
            "exchange 7, activity bit 0",
            "communication report 16#FF: Message refused",
            "operation report 16#13: Connection refused",
            "waits for ever",
            "Received_Data     nothing",
        ] {
            assert!(text.contains(part), "{text}");
        }
        let text = reports(&words, SendReqForm::Etc100).join("\n");
        assert!(text.contains("operation report 16#13: not in our tables"), "{text}");
    }
}
