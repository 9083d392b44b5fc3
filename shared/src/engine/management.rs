//! What a SEND_REQ or DATA_EXCH shows: `Management_Param` and `Received_Data`.
//!
//! The block behaves as every other; this is another view of it. Source: Control Expert help D-SE-0006482 (the words),
//! D-NA-0014195 and D-SE-0006438 (the reports).

mod reports;

use alloc::sync::Arc;
use alloc::vec::Vec;

use crate::plan::words::WordsPlan;

pub use self::reports::{REPORTS, ReportRow};
use super::block::BlockView;
use super::status::{CauseKind, Phase};

/// The report of a start that is refused for a reason which the help has no code for: "specific parameters wrong". Inferred.
const SPECIFIC_PARAMETERS: u8 = 0x06;

/// What is known of the words of the newest start.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Words {
    /// What was started, or the communication report that refused it.
    pub start: Result<Arc<WordsPlan>, u8>,
    /// Counts starts: 1 to 255, then 1 again. A refused one is not counted.
    pub exchange: u8,
    /// Message router reply of the device itself: service, status and all that follows.
    pub reply: Vec<u8>,
}

impl Words {
    /// The next start after one with this exchange number.
    pub(super) const fn started(plan: Arc<WordsPlan>, before: u8) -> Self {
        // 0 is the number of a block that was never started.
        let exchange = if before == u8::MAX { 1 } else { before + 1 };
        Self { start: Ok(plan), exchange, reply: Vec::new() }
    }

    pub(super) fn answered(&self, reply: Vec<u8>) -> Self {
        Self { start: self.start.clone(), exchange: self.exchange, reply }
    }

    /// A start that is refused: the activity bit never rises.
    pub(super) const fn refused(report: u8, before: u8) -> Self {
        Self { start: Err(report), exchange: before, reply: Vec::new() }
    }
}

/// The words as the program sees them.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Management {
    /// `Management_Param[0]`: exchange number, activity bit.
    pub activity: u16,
    /// `Management_Param[1]`: operation report, communication report.
    pub reports: u16,
    /// `Management_Param[2]` and `[3]`: timeout and length; as the program has left them where the start was refused.
    pub timeout_and_length: Option<[u16; 2]>,
    /// Bytes of `Received_Data`, as far as it was received: low byte of a word first.
    pub received: Vec<u8>,
    /// EN was taken: FALSE while EN is FALSE, and after a start that was refused.
    pub eno: bool,
}

impl Management {
    /// Of a block with words that has been started at least once.
    pub fn of(view: &BlockView) -> Option<Self> {
        let words = view.words.as_deref()?;
        let exchange = u16::from(words.exchange) << 8;
        let plan = match &words.start {
            Ok(plan) => plan,
            Err(report) => return Some(Self::refused(exchange, *report)),
        };
        let busy = view.phase.is_busy();
        let (mut report, mut received) = ((0, 0), &[][..]);
        if !busy {
            let room = 2 * usize::from(plan.received_words);
            report = reports::of(plan.form, view.cause.as_ref());
            if words.reply.len() > room {
                // An error's additional status does not fit.
                report = reports::TOO_SMALL;
            } else if report.0 == 0 {
                received = &words.reply;
            }
        }
        let (communication, operation) = report;
        // Nobody says what the length is where nothing was received.
        let length = if busy { plan.length } else { u16::try_from(received.len()).unwrap_or(u16::MAX) };
        let tenths = plan.timeout_ms.map_or(0, |ms| u16::try_from(ms / 100).unwrap_or(u16::MAX));
        Some(Self {
            activity: exchange | u16::from(busy),
            reports: u16::from(operation) << 8 | u16::from(communication),
            timeout_and_length: Some([tenths, length]),
            received: received.to_vec(),
            eno: view.input,
        })
    }

    /// Of a block whose configuration has errors.
    pub fn invalid(view: &BlockView) -> Option<Self> {
        let is_invalid = view.cause.as_ref().is_some_and(|cause| cause.what == CauseKind::Invalid);
        (is_invalid && view.phase == Phase::Failed).then(|| Self::refused(0, SPECIFIC_PARAMETERS))
    }

    fn refused(activity: u16, report: u8) -> Self {
        let (reports, received) = (report.into(), Vec::new());
        Self { activity, reports, timeout_and_length: None, received, eno: false }
    }
}

#[cfg(test)]
mod tests;
