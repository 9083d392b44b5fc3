//! Which languages there are, and which kind of block each tells.

use core::fmt;
use core::str::FromStr;

use crate::config::{BlockConfig, SendReqForm};

/// A language that blocks are written in.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Hash)]
pub enum Dialect {
    /// A block as it is stored.
    Json,
    /// Connected Components Workbench: Structured Text of Micro800.
    CcwSt,
    /// Studio 5000: a `MESSAGE` tag and its rung.
    L5x,
    /// Control Expert: `SEND_REQ` for TSX ETC 100.
    SendReqEtc100,
    /// Control Expert: `SEND_REQ` for TSX ETC 101.
    SendReqEtc101,
    /// Control Expert: `DATA_EXCH` for BMX NOC 0401 and M580.
    DataExch,
    /// Sysmac Studio: `CIPUCMMSend`, or `CIPOpen`, `CIPSend` and `CIPClose`.
    SysmacSt,
    /// Python with pycomm3.
    Pycomm3,
    /// Rust with rseip.
    Rust,
    /// `cipdeck send`.
    Cli,
    /// The bytes of the request for the message router.
    Hex,
}

/// What a block can be.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Hash)]
pub enum Kind {
    /// Rockwell Micro800.
    MsgCipGeneric,
    /// `SEND_REQ` whose address is in `Address`.
    SendReqEtc100,
    /// `SEND_REQ` whose address is among its words.
    SendReqEtc101,
    /// `DATA_EXCH`.
    DataExch,
}

/// The language of a Control Expert section.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Language {
    /// Structured Text.
    #[default]
    St,
    /// Instruction List.
    Il,
}

impl Dialect {
    /// All of them.
    pub const ALL: [Self; 11] = [
        Self::Json,
        Self::CcwSt,
        Self::L5x,
        Self::SendReqEtc100,
        Self::SendReqEtc101,
        Self::DataExch,
        Self::SysmacSt,
        Self::Pycomm3,
        Self::Rust,
        Self::Cli,
        Self::Hex,
    ];

    /// As on the command line.
    pub const fn name(self) -> &'static str {
        match self {
            Self::Json => "json",
            Self::CcwSt => "ccw-st",
            Self::L5x => "l5x",
            Self::SendReqEtc100 => "send-req-etc100",
            Self::SendReqEtc101 => "send-req-etc101",
            Self::DataExch => "data-exch",
            Self::SysmacSt => "sysmac-st",
            Self::Pycomm3 => "pycomm3",
            Self::Rust => "rust",
            Self::Cli => "cli",
            Self::Hex => "hex",
        }
    }

    /// For a person: what it is, and where it goes.
    pub const fn title(self) -> &'static str {
        match self {
            Self::Json => "JSON of cipdeck",
            Self::CcwSt => "Connected Components Workbench, Structured Text",
            Self::L5x => "Studio 5000, L5X",
            Self::SendReqEtc100 => "Control Expert, SEND_REQ (TSX ETC 100)",
            Self::SendReqEtc101 => "Control Expert, SEND_REQ (TSX ETC 101)",
            Self::DataExch => "Control Expert, DATA_EXCH (BMX NOC 0401, M580)",
            Self::SysmacSt => "Sysmac Studio, Structured Text",
            Self::Pycomm3 => "Python, pycomm3",
            Self::Rust => "Rust, rseip",
            Self::Cli => "Command line, cipdeck send",
            Self::Hex => "Hexadecimal bytes",
        }
    }

    /// Whether blocks become variables of a program, which have names.
    pub const fn has_variables(self) -> bool {
        matches!(
            self,
            Self::CcwSt
                | Self::L5x
                | Self::SendReqEtc100
                | Self::SendReqEtc101
                | Self::DataExch
                | Self::SysmacSt
        )
    }

    /// Whether each block is a file of its own: two of them, one after the other, are none.
    pub const fn is_whole_file(self) -> bool {
        matches!(self, Self::L5x | Self::Pycomm3 | Self::Rust)
    }

    /// Whether it is a language of Control Expert, which has two.
    pub const fn has_il(self) -> bool {
        matches!(self, Self::SendReqEtc100 | Self::SendReqEtc101 | Self::DataExch)
    }

    /// Without the dot.
    pub const fn file_ending(self) -> &'static str {
        match self {
            Self::Json => "json",
            Self::CcwSt | Self::SendReqEtc100 | Self::SendReqEtc101 | Self::DataExch | Self::SysmacSt => "st",
            Self::L5x => "L5X",
            Self::Pycomm3 => "py",
            Self::Rust => "rs",
            Self::Cli => "sh",
            Self::Hex => "txt",
        }
    }

    /// The kind of block that it tells. JSON tells every kind: [`Dialect::kind_for`].
    pub const fn kind(self) -> Kind {
        match self {
            Self::SendReqEtc100 => Kind::SendReqEtc100,
            Self::SendReqEtc101 => Kind::SendReqEtc101,
            Self::DataExch => Kind::DataExch,
            _ => Kind::MsgCipGeneric,
        }
    }

    /// The kind that a block has to be to be told.
    pub fn kind_for(self, block: &BlockConfig) -> Kind {
        if self == Self::Json { Kind::of(block) } else { self.kind() }
    }
}

impl Kind {
    /// How its words are laid out, if it is made of words.
    pub const fn form(self) -> Option<SendReqForm> {
        match self {
            Self::MsgCipGeneric => None,
            Self::SendReqEtc100 => Some(SendReqForm::Etc100),
            Self::SendReqEtc101 => Some(SendReqForm::Etc101),
            Self::DataExch => Some(SendReqForm::DataExch),
        }
    }

    /// All of them.
    pub const ALL: [Self; 4] =
        [Self::MsgCipGeneric, Self::SendReqEtc100, Self::SendReqEtc101, Self::DataExch];

    /// What a block is.
    pub fn of(block: &BlockConfig) -> Self {
        match block {
            BlockConfig::MsgCipGeneric(_) => Self::MsgCipGeneric,
            BlockConfig::SendReq(config) => match config.form() {
                SendReqForm::Etc100 => Self::SendReqEtc100,
                SendReqForm::Etc101 => Self::SendReqEtc101,
                SendReqForm::DataExch => Self::DataExch,
            },
        }
    }
}

impl fmt::Display for Dialect {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(self.name())
    }
}

/// `MSG_CIPGENERIC`, `SEND_REQ (TSX ETC 100)` …
impl fmt::Display for Kind {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(match self {
            Self::MsgCipGeneric => "MSG_CIPGENERIC",
            Self::SendReqEtc100 => "SEND_REQ (TSX ETC 100)",
            Self::SendReqEtc101 => "SEND_REQ (TSX ETC 101)",
            Self::DataExch => "DATA_EXCH",
        })
    }
}

/// A text that names no dialect.
#[derive(Clone, Copy, Debug, PartialEq, Eq, thiserror::Error)]
#[error(
    "a dialect is json, ccw-st, l5x, send-req-etc100, send-req-etc101, data-exch, sysmac-st, pycomm3, rust, cli or hex"
)]
pub struct UnknownDialect;

impl FromStr for Dialect {
    type Err = UnknownDialect;

    fn from_str(text: &str) -> Result<Self, UnknownDialect> {
        Self::ALL.into_iter().find(|dialect| dialect.name() == text).ok_or(UnknownDialect)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn every_dialect_reads_back_from_its_name() {
        for dialect in Dialect::ALL {
            assert_eq!(dialect.name().parse(), Ok(dialect));
            assert!(alloc::format!("{UnknownDialect}").contains(dialect.name()));
        }
        assert_eq!("CCW".parse::<Dialect>(), Err(UnknownDialect));
    }
}
