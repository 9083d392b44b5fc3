//! Where things lie in a table of words.

use alloc::vec::Vec;
use core::fmt;

use crate::config::{SendReqForm, bytes_of};

/// A table of words taken apart, up to where the CIP request begins.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Split {
    /// Word 0, of the forms that have one: 0 unconnected, 1 over a class 3 connection.
    pub message_type: Option<u16>,
    /// Words 1 and 2 on a TSX ETC 101.
    pub ip: Option<[u8; 4]>,
    /// The CIP request.
    pub message: Vec<u8>,
    /// Bytes that are not sent.
    pub behind: Vec<u8>,
    /// At which byte of the words the CIP request begins.
    pub at: usize,
}

/// Why a table of words has no CIP request.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum SplitError {
    /// The length counts more bytes than there are.
    TooLong {
        /// What the length says.
        length: usize,
        /// Bytes that are there.
        bytes: usize,
    },
    /// The bytes end before the CIP request begins, or in its first word.
    TooShort {
        /// Bytes that are sent.
        length: usize,
        /// Where the CIP request begins.
        at: usize,
    },
}

impl Split {
    /// Takes apart the first `length` bytes of words.
    pub fn new(form: SendReqForm, words: &[u16], length: usize) -> Result<Self, SplitError> {
        let bytes = bytes_of(words);
        let at = 2 * form.head();
        let (sent, behind) =
            bytes.split_at_checked(length).ok_or(SplitError::TooLong { length, bytes: bytes.len() })?;
        let message = sent.get(at..).filter(|message| message.len() >= 2);
        let message = message.ok_or(SplitError::TooShort { length, at })?;
        let has_type = form != SendReqForm::DataExch;
        let ip = match words {
            [_, high, low, ..] if form == SendReqForm::Etc101 => {
                // Word 1 is 16#C0A8 for 192.168: the high byte comes first.
                let ([a, b], [c, d]) = (high.to_be_bytes(), low.to_be_bytes());
                Some([a, b, c, d])
            }
            _ => None,
        };
        Ok(Self {
            message_type: words.first().copied().filter(|_| has_type),
            ip,
            message: message.to_vec(),
            behind: behind.to_vec(),
            at,
        })
    }
}

impl fmt::Display for SplitError {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::TooLong { length, bytes } => {
                write!(f, "{length} bytes are to be sent, Data_to_Send has {bytes}")
            }
            Self::TooShort { length, at } => {
                write!(
                    f,
                    "only {length} bytes are sent; the CIP request begins at byte {at} (counted from 0)"
                )
            }
        }
    }
}

/// The words before the CIP request.
pub(super) fn head(form: SendReqForm, message_type: u16, ip: [u8; 4]) -> Vec<u16> {
    let [a, b, c, d] = ip;
    match form {
        SendReqForm::Etc100 => alloc::vec![message_type],
        SendReqForm::Etc101 => {
            alloc::vec![message_type, u16::from_be_bytes([a, b]), u16::from_be_bytes([c, d])]
        }
        SendReqForm::DataExch => Vec::new(),
    }
}
