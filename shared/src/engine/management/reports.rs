//! How a message that has ended is told in `Management_Param[1]`. docs/SEND_REQ.md shows this table.
//!
//! The codes are the help's; which of them a module gives for what, the help leaves open for most. No failure but the
//! device's own refusal has communication report 0.

use crate::config::SendReqForm;
use crate::engine::status::{Cause, CauseKind, RefusedBy};

/// Communication report, operation report.
type Reports = (u8, u8);

/// The reply is longer than `Received_Data`.
pub(super) const TOO_SMALL: Reports = (0x09, 0);

/// What one way of ending is told as.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct ReportRow {
    /// What happened.
    pub cause: CauseKind,
    /// Who refused, if it was not the object.
    pub by: Option<RefusedBy>,
    /// On a TSX ETC 100.
    pub etc100: Reports,
    /// On a TSX ETC 101, and by DATA_EXCH.
    pub exchange: Reports,
    /// Whether the help says so, or it follows from the words for the codes.
    pub is_confirmed: bool,
}

const fn row(cause: CauseKind, etc100: Reports, exchange: Reports, is_confirmed: bool) -> ReportRow {
    ReportRow { cause, by: None, etc100, exchange, is_confirmed }
}

/// All ways of ending without success. One that is not here is an application error.
pub const REPORTS: [ReportRow; 14] = [
    // The exchange was correct; what the device said is in Received_Data.
    row(CauseKind::RefusedByDevice, (0x00, 0x00), (0x00, 0x00), true),
    // "No destination resources"; "application error".
    ReportRow {
        cause: CauseKind::RefusedByDevice,
        by: Some(RefusedBy::ForwardOpen),
        etc100: (0xFF, 0x12),
        exchange: (0xFF, 0x08),
        is_confirmed: false,
    },
    // "Exchange stopped by timeout". A module may have a shorter time of its own for FF/0D.
    row(CauseKind::Timeout, (0x01, 0x00), (0x01, 0x00), true),
    // "Exchange stopped by user".
    row(CauseKind::Cancelled, (0x02, 0x00), (0x02, 0x00), true),
    // Ours alone: for the block it is a cancelled message.
    row(CauseKind::NotPermitted, (0x02, 0x00), (0x02, 0x00), false),
    // "Receive buffer too small".
    row(CauseKind::TooSmall, TOO_SMALL, TOO_SMALL, true),
    // "No system resources".
    row(CauseKind::Limit, (0x0B, 0x00), (0x0B, 0x00), false),
    // "No device, or device without resources"; "connection refused".
    row(CauseKind::Refused, (0xFF, 0x03), (0xFF, 0x13), false),
    // "Destination missing"; "no route to remote host".
    row(CauseKind::Unreachable, (0xFF, 0x0D), (0xFF, 0x0F), false),
    // "Destination address wrong".
    row(CauseKind::Unresolved, (0x04, 0x00), (0x04, 0x00), false),
    // "No destination resources"; "no resources".
    row(CauseKind::SessionRefused, (0xFF, 0x12), (0xFF, 0x15), false),
    // "Line error"; "connection reset by peer".
    row(CauseKind::Closed, (0xFF, 0x04), (0xFF, 0x0A), false),
    // "Application error", both.
    row(CauseKind::EncapsulationStatus, (0xFF, 0x08), (0xFF, 0x08), false),
    row(CauseKind::Malformed, (0xFF, 0x08), (0xFF, 0x08), false),
];

/// What a message that has ended is told as: 0, 0 for success.
pub(super) fn of(form: SendReqForm, cause: Option<&Cause>) -> Reports {
    let Some(cause) = cause else { return (0, 0) };
    let by = cause.by.filter(|by| *by == RefusedBy::ForwardOpen);
    let found = REPORTS.into_iter().find(|row| row.cause == cause.what && row.by == by);
    let found = found.unwrap_or_else(|| row(CauseKind::Malformed, (0xFF, 0x08), (0xFF, 0x08), false));
    match form {
        SendReqForm::Etc100 => found.etc100,
        SendReqForm::Etc101 | SendReqForm::DataExch => found.exchange,
    }
}
