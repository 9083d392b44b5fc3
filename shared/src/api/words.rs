//! `Management_Param` and `Received_Data` in JSON.

use alloc::string::String;

use serde::{Deserialize, Serialize};

use crate::config::{SendReq, words_of, write_words};
use crate::engine::{BlockView, Management};

/// What a SEND_REQ or DATA_EXCH shows beside the rest of its status.
#[derive(Clone, Debug, PartialEq, Eq, Serialize, Deserialize)]
#[cfg_attr(feature = "openapi", derive(utoipa::ToSchema))]
pub struct WordsStatus {
    /// Four words. `[0]`: exchange number in the high byte, activity bit in bit 0. `[1]`: operation report in the high
    /// byte, communication report in the low one. `[2]`: timeout x 100 ms, 0 = for ever. `[3]`: bytes that are sent, and
    /// after the end bytes that were received.
    #[serde(rename = "Management_Param")]
    pub management_param: [u16; 4],
    /// The words that were received, as hexadecimal text: `008E 0000`. Empty while there are none.
    #[serde(rename = "Received_Data")]
    pub received_data: String,
    /// FALSE while EN is FALSE, and after a start that was refused.
    #[serde(rename = "ENO")]
    pub eno: bool,
}

impl WordsStatus {
    /// From what the engine shows of a block with this configuration.
    pub fn new(config: &SendReq, view: &BlockView) -> Self {
        let given = |index| config.management_param.get(index).and_then(|word| u16::try_from(*word).ok());
        let given = [2, 3].map(|index| given(index).unwrap_or_default());
        if let Some(management) = Management::of(view).or_else(|| Management::invalid(view)) {
            return Self::shown(&management, given);
        }
        let [timeout, length] = given;
        Self { management_param: [0, 0, timeout, length], received_data: String::new(), eno: view.input }
    }

    /// From what the engine shows of a message that has been started; `None` for one without words.
    pub fn of_started(view: &BlockView) -> Option<Self> {
        Management::of(view).map(|management| Self::shown(&management, [0; 2]))
    }

    fn shown(management: &Management, given: [u16; 2]) -> Self {
        let [timeout, length] = management.timeout_and_length.unwrap_or(given);
        Self {
            management_param: [management.activity, management.reports, timeout, length],
            received_data: write_words(&words_of(&management.received)),
            eno: management.eno,
        }
    }

    /// Whether the exchange is going on: `Management_Param[0].0`.
    pub const fn is_active(&self) -> bool {
        let [activity, ..] = self.management_param;
        activity & 1 != 0
    }

    /// The high byte of `Management_Param[0]`: counts starts.
    pub const fn exchange(&self) -> u8 {
        let [activity, ..] = self.management_param;
        activity.to_be_bytes()[0]
    }

    /// The low byte of `Management_Param[1]`: how the exchange went.
    pub const fn communication_report(&self) -> u8 {
        let [_, reports, ..] = self.management_param;
        reports.to_le_bytes()[0]
    }

    /// The high byte of `Management_Param[1]`: more about it.
    pub const fn operation_report(&self) -> u8 {
        let [_, reports, ..] = self.management_param;
        reports.to_be_bytes()[0]
    }
}
