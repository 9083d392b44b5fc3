//! The history of runs in JSON.

use alloc::string::String;
use alloc::vec::Vec;

use serde::{Deserialize, Serialize};

use crate::config::BlockId;

/// `GET /api/v1/history`: runs that have ended, the newest first.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
#[cfg_attr(feature = "openapi", derive(utoipa::ToSchema))]
pub struct HistoryPage {
    /// The runs.
    pub runs: Vec<HistoryRun>,
    /// What to send as `before` to get the runs before these; null at the end.
    pub next: Option<String>,
    /// What is missing in the time that was asked for, the newest first.
    pub dropped: Vec<HistoryDropped>,
}

/// One run: a message that has ended with DN or ER.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[cfg_attr(feature = "openapi", derive(utoipa::ToSchema))]
pub struct HistoryRun {
    /// Names the run for good; what it is made of means nothing.
    pub id: String,
    /// Whose run. The block may have been changed or deleted since.
    pub block: BlockId,
    /// When it ended (RFC 3339).
    pub at: String,
    /// Whether it ended with success.
    #[serde(rename = "Q")]
    pub q: bool,
    /// 0 without an error.
    #[serde(rename = "ErrorID")]
    pub error_id: u16,
    /// For `ErrorID` 224 the CIP general status.
    #[serde(rename = "SubErrorID")]
    pub sub_error_id: u16,
    /// For `ErrorID` 224 the first word of the additional status.
    #[serde(rename = "ExtErrorID")]
    pub ext_error_id: u16,
    /// What happened, on an error: the word of a status' `cause`.
    pub cause: Option<String>,
    /// It ended without an answer after the request had been written.
    #[serde(default, skip_serializing_if = "core::ops::Not::not")]
    pub may_have_acted: bool,
    /// The device has acted, although the block failed.
    #[serde(default, skip_serializing_if = "core::ops::Not::not")]
    pub has_acted: bool,
    /// µs from the last written byte to the decoded reply.
    pub reply_us: Option<u64>,
    /// µs from trigger to DN or ER.
    pub elapsed_us: Option<u64>,
    /// Message router request as hexadecimal text.
    pub request: String,
    /// Message router reply as hexadecimal text, if one came.
    pub response: Option<String>,
    /// What the data of a success says, as far as it is known or can be guessed.
    pub values: Vec<HistoryValue>,
}

/// A decoded value.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[cfg_attr(feature = "openapi", derive(utoipa::ToSchema))]
pub struct HistoryValue {
    /// `product name`; `data as INT` for a guess. What `history/trend` takes as `value`.
    pub name: String,
    /// CIP type.
    #[serde(rename = "type")]
    pub type_name: String,
    /// The value for people.
    pub text: String,
    /// The value as a number, if it is one.
    pub number: Option<f64>,
    /// Whether the type is only guessed.
    #[serde(default, skip_serializing_if = "core::ops::Not::not")]
    pub guess: bool,
}

/// Runs that are not in the history any more, or never were.
#[derive(Clone, Debug, PartialEq, Eq, Serialize, Deserialize)]
#[cfg_attr(feature = "openapi", derive(utoipa::ToSchema))]
pub struct HistoryDropped {
    /// When that was noticed last (RFC 3339).
    pub at: String,
    /// Why.
    pub why: HistoryLoss,
    /// How many runs; null when nobody knows.
    pub runs: Option<u64>,
    /// The earliest end of such a run.
    pub from: String,
    /// The latest end of such a run.
    pub to: String,
    /// More, in English.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub detail: Option<String>,
}

/// Why runs are missing.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash, Serialize, Deserialize)]
#[cfg_attr(feature = "openapi", derive(utoipa::ToSchema))]
#[serde(rename_all = "lowercase")]
pub enum HistoryLoss {
    /// More ended than could be written in time.
    Queue,
    /// The disk was full or failed.
    Disk,
    /// Older than what `max_mb` leaves room for.
    Size,
    /// Older than `max_days`.
    Age,
    /// The file could not be read and was set aside.
    Corrupt,
}

impl HistoryLoss {
    /// All of them.
    pub const ALL: [Self; 5] = [Self::Queue, Self::Disk, Self::Size, Self::Age, Self::Corrupt];

    /// The word in JSON.
    pub const fn word(self) -> &'static str {
        match self {
            Self::Queue => "queue",
            Self::Disk => "disk",
            Self::Size => "size",
            Self::Age => "age",
            Self::Corrupt => "corrupt",
        }
    }
}

/// `GET /api/v1/history/trend`: the runs of one block, summed up in buckets of equal length.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[cfg_attr(feature = "openapi", derive(utoipa::ToSchema))]
pub struct HistoryTrend {
    /// Whose runs.
    pub block: BlockId,
    /// Where the first bucket begins (RFC 3339).
    pub from: String,
    /// Where the last bucket ends.
    pub to: String,
    /// How long a bucket is, µs.
    pub bucket_us: u64,
    /// The name of the value that the buckets sum up, if there is one.
    pub value: Option<String>,
    /// The names of all values with numbers that were found.
    pub values: Vec<String>,
    /// Only buckets with runs, the earliest first.
    pub buckets: Vec<HistoryBucket>,
    /// FALSE: there are more runs than are summed up for one answer; the earliest were left out. Ask for less time.
    pub complete: bool,
    /// What is missing in this time, the newest first.
    pub dropped: Vec<HistoryDropped>,
}

/// The runs of a short time.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[cfg_attr(feature = "openapi", derive(utoipa::ToSchema))]
pub struct HistoryBucket {
    /// Which bucket: it begins `index` times `bucket_us` after `from`.
    pub index: u32,
    /// How many runs ended in it.
    pub runs: u64,
    /// How many of them failed.
    pub failed: u64,
    /// µs to the reply, of those that got one.
    pub reply_us: Option<HistoryRange>,
    /// The value, of those that have it.
    pub value: Option<HistoryRange>,
}

/// Smallest, mean and biggest number.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
#[cfg_attr(feature = "openapi", derive(utoipa::ToSchema))]
pub struct HistoryRange {
    /// The smallest.
    pub min: f64,
    /// The mean.
    pub mean: f64,
    /// The biggest.
    pub max: f64,
}

/// `GET /api/v1/history/state`.
#[derive(Clone, Debug, Default, PartialEq, Eq, Serialize, Deserialize)]
#[cfg_attr(feature = "openapi", derive(utoipa::ToSchema))]
pub struct HistoryState {
    /// Whether runs are kept: FALSE without a data folder, and when the configuration says so.
    pub enabled: bool,
    /// Why runs are not kept at this moment although they should be: the disk, in English.
    pub problem: Option<String>,
    /// How many runs are kept.
    pub runs: u64,
    /// Bytes that they take.
    pub bytes: u64,
    /// When the oldest that is kept ended (RFC 3339).
    pub oldest: Option<String>,
    /// When the newest that is kept ended.
    pub newest: Option<String>,
    /// MB that history may take.
    pub max_mb: u32,
    /// Days that it is kept.
    pub max_days: u32,
    /// What is missing, the newest first.
    pub dropped: Vec<HistoryDropped>,
}

/// What `GET /api/v1/health` says about the history.
#[derive(Clone, Debug, Default, PartialEq, Eq, Serialize, Deserialize)]
#[cfg_attr(feature = "openapi", derive(utoipa::ToSchema))]
pub struct HistoryHealth {
    /// Whether runs are being kept: FALSE while the disk is full, and when history is off.
    pub recording: bool,
    /// Runs that were lost since the relay started. Those that have become too old or too many are not counted.
    pub lost: u64,
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_loss_is_written_by_its_word() {
        for loss in HistoryLoss::ALL {
            assert_eq!(serde_json::to_value(loss).unwrap(), loss.word());
        }
    }
}
