//! What became of the newest exchange: whether the transport went well, and whether the device agreed. These are two things.

use cipdeck_shared::{
    api::{BlockStatus, WordsStatus},
    config::{SendReqForm, bytes_of, read_words},
    table::{self, Entry, MESSAGE_REFUSED, ReportList},
    wire::{GeneralStatus, MessageRouterReply},
};

use super::i18n::tr;
use crate::kit::Shape;

/// What became of it.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Verdict {
    /// It was never started.
    Never,
    /// It is going on.
    Busy,
    /// The device has answered, and agreed.
    Good,
    /// The exchange was correct, but the device refused the request: with this status, and its first additional one.
    Refused(GeneralStatus, Option<u16>),
    /// There was no correct exchange.
    Failed,
}

impl Verdict {
    pub(super) fn of(status: &BlockStatus) -> Self {
        let Some(words) = &status.words else { return Self::Never };
        if status.phase.is_busy() {
            return Self::Busy;
        }
        if status.runs == 0 && words.received_data.is_empty() && words.communication_report() == 0 {
            return Self::Never;
        }
        let reply = received(words);
        match MessageRouterReply::decode(&reply) {
            _ if words.communication_report() != 0 => Self::Failed,
            Ok(reply) if reply.status != GeneralStatus::Success => {
                Self::Refused(reply.status, reply.additional.words().next())
            }
            Ok(_) => Self::Good,
            Err(_) => Self::Failed,
        }
    }

    /// Its shape, and the class of its colour.
    pub(super) const fn shape(self) -> Shape {
        match self {
            Self::Never => Shape::Ring,
            Self::Busy => Shape::Arrow,
            Self::Good => Shape::Tick,
            Self::Refused(..) | Self::Failed => Shape::Cross,
        }
    }

    /// Its stable name.
    pub(super) const fn word(self) -> &'static str {
        match self {
            Self::Never => "never",
            Self::Busy => "busy",
            Self::Good => "good",
            Self::Refused(..) => "refused",
            Self::Failed => "failed",
        }
    }
}

/// The bytes that were received: `Management_Param[3]` counts them.
pub(super) fn received(words: &WordsStatus) -> Vec<u8> {
    let mut bytes = bytes_of(&read_words(&words.received_data).unwrap_or_default());
    let [.., length] = words.management_param;
    bytes.truncate(length.into());
    bytes
}

/// Which operation reports the module of this form has.
pub(super) const fn list(form: SendReqForm) -> ReportList {
    match form {
        SendReqForm::Etc100 => ReportList::Etc100,
        SendReqForm::Etc101 | SendReqForm::DataExch => ReportList::DataExch,
    }
}

/// What the two reports mean: the communication report, then the operation report where it says more.
pub(super) fn reports(form: SendReqForm, words: &WordsStatus) -> (Option<Entry>, Option<Entry>) {
    let (communication, operation) = (words.communication_report(), words.operation_report());
    (
        table::communication_report(communication),
        table::operation_report(list(form), communication, operation)
            .filter(|_| communication == 0 || communication == MESSAGE_REFUSED),
    )
}

/// One line for people.
pub(super) fn line(form: SendReqForm, status: &BlockStatus) -> String {
    let Some(words) = &status.words else { return tr!("verdict.never").to_string() };
    let verdict = Verdict::of(status);
    match verdict {
        Verdict::Never => tr!("verdict.never"),
        Verdict::Busy => tr!("verdict.busy"),
        Verdict::Good => tr!("verdict.good", bytes = received(words).len()),
        Verdict::Refused(general, _) => {
            let name = table::general_status(general).map_or("", |entry| entry.name);
            tr!("verdict.refused", code = format!("{:02X}", general.0), name = name)
        }
        Verdict::Failed => {
            let (communication, operation) = reports(form, words);
            let code = match words.communication_report() {
                MESSAGE_REFUSED => format!("{MESSAGE_REFUSED:02X}/{:02X}", words.operation_report()),
                code => format!("{code:02X}"),
            };
            let entry =
                operation.filter(|_| words.communication_report() == MESSAGE_REFUSED).or(communication);
            tr!("verdict.failed", code = code, name = entry.map_or("", |entry| entry.name))
        }
    }
    .to_string()
}

#[cfg(test)]
mod tests {
    use super::*;
    use cipdeck_shared::{
        config::BlockId,
        engine::{BlockView, Phase},
    };

    fn status(phase: Phase, management_param: [u16; 4], received: &str) -> BlockStatus {
        let view = BlockView { phase, runs: 1, ..BlockView::default() };
        let words = WordsStatus { management_param, received_data: received.to_owned(), eno: true };
        BlockStatus { words: Some(words), ..BlockStatus::new(BlockId(1), &view, None, None) }
    }

    #[test]
    fn a_refusal_of_the_device_is_no_success_although_the_exchange_was_correct() {
        let refused = status(Phase::Failed, [0x0100, 0, 30, 4], "008E 0005");
        assert_eq!(Verdict::of(&refused), Verdict::Refused(GeneralStatus(5), None));
        let says = line(SendReqForm::Etc100, &refused);
        assert!(says.contains("correct, but the device refused") && says.contains("16#05"), "{says}");
        let good = status(Phase::Done, [0x0100, 0, 30, 5], "008E 0000 0007");
        assert_eq!((Verdict::of(&good), received(good.words.as_ref().unwrap()).len()), (Verdict::Good, 5));
    }

    #[test]
    fn a_report_is_named_by_the_byte_that_says_most() {
        let timeout = status(Phase::Failed, [0x0200, 0x0001, 30, 0], "");
        assert!(line(SendReqForm::Etc100, &timeout).contains("16#01 Exchange stopped by timeout"));
        let refused = status(Phase::Failed, [0x0200, 0x07FF, 30, 0], "");
        let says = line(SendReqForm::Etc100, &refused);
        assert!(says.contains("16#FF/07") && says.contains("Addressing error"), "{says}");
    }
}
