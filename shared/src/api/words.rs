//! `Management_Param` and `Received_Data` in JSON.

use alloc::string::String;

use serde::{Deserialize, Serialize};
use serde_json::Value;

use crate::config::{SendReq, words_of, write_words};
use crate::engine::{BlockView, Management};

/// What a SEND_REQ or DATA_EXCH shows beside the rest of its status.
#[derive(Clone, Debug, PartialEq, Eq, Serialize, Deserialize)]
#[cfg_attr(feature = "openapi", derive(utoipa::ToSchema))]
#[serde(try_from = "Value")]
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

/// Read by way of a value, as others are anyhow: that saves 1 kB of pages that have no such blocks.
impl TryFrom<Value> for WordsStatus {
    type Error = &'static str;

    fn try_from(value: Value) -> Result<Self, Self::Error> {
        let word = |word: &Value| u16::try_from(word.as_u64()?).ok();
        let read = || {
            let words = value.get("Management_Param")?.as_array()?;
            let [first, second, third, fourth] = words.as_slice() else { return None };
            Some(Self {
                management_param: [word(first)?, word(second)?, word(third)?, word(fourth)?],
                received_data: value.get("Received_Data")?.as_str()?.into(),
                eno: value.get("ENO")?.as_bool()?,
            })
        };
        read().ok_or("words: Management_Param with four words, Received_Data and ENO")
    }
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

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn words_are_written_and_read_back() {
        let words = WordsStatus {
            management_param: [0x0100, 0x13FF, 30, 9],
            received_data: "008E 0000".into(),
            eno: true,
        };
        let text = r#"{"Management_Param":[256,5119,30,9],"Received_Data":"008E 0000","ENO":true}"#;
        assert_eq!(serde_json::to_string(&words).unwrap(), text);
        assert_eq!(serde_json::from_str::<WordsStatus>(text).unwrap(), words);
        assert_eq!((words.communication_report(), words.operation_report()), (0xFF, 0x13));
        assert_eq!((words.exchange(), words.is_active()), (1, false));
        for (from, to) in [("30,9]", "30]"), ("256", "65536"), ("true", "1"), ("\"008E 0000\"", "0")] {
            assert!(serde_json::from_str::<WordsStatus>(&text.replace(from, to)).is_err(), "{to}");
        }
    }
}
