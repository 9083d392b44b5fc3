//! What is known of a variable: its last value, how good it is, and why it is not better.

use alloc::string::{String, ToString};
use alloc::vec::Vec;

use crate::engine::time::Instant;
use crate::tag::{self, Type, Value};
use crate::wire::GeneralStatus;

/// How far a value can be trusted.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Hash)]
pub enum Quality {
    /// Not read yet.
    #[default]
    Waiting,
    /// Read in the present or the last period.
    Good,
    /// It was read, but not lately: [`Reading::reason`] says why.
    Stale,
    /// It cannot be read: [`Reading::reason`] says why. The last value may still be there.
    Bad,
}

/// Why a variable is not good.
#[derive(Clone, Debug, PartialEq, Eq)]
pub enum Reason {
    /// The device refused it.
    Refused {
        /// General status.
        status: GeneralStatus,
        /// Additional status words.
        words: Vec<u16>,
    },
    /// No answer came: what the transport says.
    Lost(String),
    /// Two periods went by without a new value.
    Late,
    /// Its group is off.
    Off,
    /// The device holds another type than the variable was given: what it said.
    OtherType(String),
    /// The bytes do not make a value of the type.
    Unreadable(String),
    /// The name makes a request that is longer than the device takes.
    NameTooLong,
    /// The value is longer than a reply, and its type is not known well enough to read it in parts.
    ValueTooLong,
}

impl Reason {
    /// In words.
    pub fn text(&self) -> String {
        match self {
            Self::Refused { status, words } => tag::refusal(*status, words.first().copied()),
            Self::Lost(reason) => reason.clone(),
            Self::Late => "two periods went by without a new value".to_string(),
            Self::Off => "its group is off".to_string(),
            Self::OtherType(found) => alloc::format!("the device says {found}"),
            Self::Unreadable(error) => error.clone(),
            Self::NameTooLong => "the name is too long for a request to this device".to_string(),
            Self::ValueTooLong => {
                "the value is too long for one reply; give its type, so that it can be read in parts"
                    .to_string()
            }
        }
    }
}

/// What is known of a variable.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Reading {
    /// How far the value can be trusted.
    pub quality: Quality,
    /// The last good value.
    pub value: Option<Value>,
    /// Its type: as given, or as the device says.
    pub kind: Option<Type>,
    /// Why the quality is not good.
    pub reason: Option<Reason>,
    /// When the value was read.
    pub at: Option<Instant>,
    /// When it last became another one.
    pub changed: Option<Instant>,
}

impl Reading {
    /// `handle`: what came before the value, if it is a structure; writing it needs it.
    pub(super) fn good(&mut self, value: Value, kind: Option<&Type>, handle: Option<u16>, now: Instant) {
        self.quality = Quality::Good;
        self.reason = None;
        self.at = Some(now);
        if self.value.as_ref() != Some(&value) {
            self.value = Some(value);
            self.changed = Some(now);
        }
        let told = kind.zip(handle).map(|(kind, handle)| kind.told(handle));
        let kind = told.as_ref().or(kind);
        if self.kind.as_ref() != kind {
            self.kind = kind.cloned();
        }
    }

    /// A value that is there is only stale. Whether anything changed.
    pub(super) fn lost(&mut self, reason: &Reason) -> bool {
        let was = self.quality;
        let quality = match self.quality {
            Quality::Good | Quality::Stale => Quality::Stale,
            // What the device said of it still holds.
            Quality::Bad if !matches!(self.reason, Some(Reason::Lost(_))) => return false,
            Quality::Waiting | Quality::Bad => Quality::Bad,
        };
        self.quality = quality;
        self.because(reason) || was != quality
    }

    /// Whether anything changed.
    pub(super) fn bad(&mut self, reason: &Reason) -> bool {
        let was = core::mem::replace(&mut self.quality, Quality::Bad);
        self.because(reason) || was != Quality::Bad
    }

    fn because(&mut self, reason: &Reason) -> bool {
        let new = self.reason.as_ref() != Some(reason);
        if new {
            self.reason = Some(reason.clone());
        }
        new
    }
}
