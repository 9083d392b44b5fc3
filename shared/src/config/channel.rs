//! Whose limits apply to a block's messages.

use alloc::string::String;

use serde::{Deserialize, Serialize};

/// A communication channel: its messages share its buffers.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, PartialOrd, Ord, Hash, Serialize, Deserialize)]
#[serde(try_from = "String", into = "String")]
pub enum Channel {
    /// `controller`: 4 buffers, and the controller's 16 sessions and connections.
    #[default]
    Controller,
    /// `controller2` to `controller8`: each has 4 buffers of its own; sessions and connections are the controller's.
    Further(FurtherChannel),
    /// `monitor`: no limit of buffers, sessions or connections.
    Monitor,
}

/// A second, third … channel of the controller: 2080-RM001D p. 215 gives each its own queue.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Hash)]
pub struct FurtherChannel(u8);

impl FurtherChannel {
    /// 2..=8.
    pub const fn new(number: u8) -> Option<Self> {
        match number {
            2..=8 => Some(Self(number)),
            _ => None,
        }
    }
}

/// The text names no channel.
#[derive(Clone, Copy, Debug, PartialEq, Eq, thiserror::Error)]
#[error("a channel is controller, controller2 to controller8, or monitor")]
pub struct UnknownChannel;

impl Channel {
    /// Channels of the controller.
    pub const CONTROLLERS: usize = 8;

    /// Which channel of the controller it is, from 0; `None` for the monitor.
    pub const fn of_controller(self) -> Option<usize> {
        match self {
            Self::Controller => Some(0),
            Self::Further(FurtherChannel(number)) => Some(number as usize - 1),
            Self::Monitor => None,
        }
    }
}

impl TryFrom<String> for Channel {
    type Error = UnknownChannel;

    fn try_from(word: String) -> Result<Self, UnknownChannel> {
        match word.as_str() {
            "controller" => Ok(Self::Controller),
            "monitor" => Ok(Self::Monitor),
            _ => {
                let number = word.strip_prefix("controller").filter(|number| number.len() == 1);
                let number = number.and_then(|number| number.parse().ok());
                number.and_then(FurtherChannel::new).map(Self::Further).ok_or(UnknownChannel)
            }
        }
    }
}

impl From<Channel> for String {
    fn from(channel: Channel) -> Self {
        match channel {
            Channel::Controller => "controller".into(),
            Channel::Further(FurtherChannel(number)) => alloc::format!("controller{number}"),
            Channel::Monitor => "monitor".into(),
        }
    }
}

#[cfg(feature = "openapi")]
impl utoipa::PartialSchema for Channel {
    fn schema() -> utoipa::openapi::RefOr<utoipa::openapi::Schema> {
        utoipa::openapi::ObjectBuilder::new()
            .schema_type(utoipa::openapi::Type::String)
            .pattern(Some("^(controller[2-8]?|monitor)$"))
            .description(Some("A communication channel: its messages share its buffers."))
            .into()
    }
}

#[cfg(feature = "openapi")]
impl utoipa::ToSchema for Channel {}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn every_channel_reads_back_from_its_word_and_nothing_else_does() {
        for word in ["controller", "controller2", "controller8", "monitor"] {
            assert_eq!(Channel::try_from(String::from(word)).map(String::from), Ok(word.into()));
        }
        for word in ["", "Controller", "controller1", "controller9", "controller02", "controller22", "plc"] {
            assert_eq!(Channel::try_from(String::from(word)), Err(UnknownChannel), "{word}");
        }
    }
}
