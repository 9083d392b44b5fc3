//! Bounded reading: every failure names its byte.

/// Reads forward through bytes; the position is counted from the start of the outermost byte string.
#[derive(Clone, Debug)]
pub struct Reader<'a> {
    rest: &'a [u8],
    at: usize,
}

impl<'a> Reader<'a> {
    /// Starts at byte 0.
    pub const fn new(bytes: &'a [u8]) -> Self {
        Self { rest: bytes, at: 0 }
    }

    /// Starts at byte `at` of something larger, so that errors name the place in the whole.
    pub const fn starting_at(bytes: &'a [u8], at: usize) -> Self {
        Self { rest: bytes, at }
    }

    /// The position of the next byte.
    pub const fn at(&self) -> usize {
        self.at
    }

    /// How many bytes are left.
    pub const fn remaining(&self) -> usize {
        self.rest.len()
    }

    /// Whether no byte is left.
    pub const fn is_empty(&self) -> bool {
        self.rest.is_empty()
    }

    /// The next `n` bytes.
    pub fn take(&mut self, n: usize) -> Result<&'a [u8], DecodeError> {
        let Some((head, rest)) = self.rest.split_at_checked(n) else {
            return Err(
                self.fail(DecodeErrorKind::Truncated { needed: n - self.rest.len() }, self.rest.len())
            );
        };
        self.rest = rest;
        self.at += n;
        Ok(head)
    }

    /// The next `N` bytes as an array.
    pub fn array<const N: usize>(&mut self) -> Result<[u8; N], DecodeError> {
        let Some((head, rest)) = self.rest.split_first_chunk::<N>() else {
            return Err(
                self.fail(DecodeErrorKind::Truncated { needed: N - self.rest.len() }, self.rest.len())
            );
        };
        self.rest = rest;
        self.at += N;
        Ok(*head)
    }

    /// A USINT.
    pub fn u8(&mut self) -> Result<u8, DecodeError> {
        self.array::<1>().map(|[byte]| byte)
    }

    /// A UINT, little endian.
    pub fn u16(&mut self) -> Result<u16, DecodeError> {
        self.array().map(u16::from_le_bytes)
    }

    /// A UDINT, little endian.
    pub fn u32(&mut self) -> Result<u32, DecodeError> {
        self.array().map(u32::from_le_bytes)
    }

    /// A reader of the next `n` bytes only, which counts positions in the whole.
    pub fn sub(&mut self, n: usize) -> Result<Self, DecodeError> {
        let at = self.at;
        self.take(n).map(|bytes| Self { rest: bytes, at })
    }

    /// Everything that is left.
    pub fn rest(&mut self) -> &'a [u8] {
        let rest = core::mem::take(&mut self.rest);
        self.at += rest.len();
        rest
    }

    /// Fails when bytes are left over.
    pub fn finish(self) -> Result<(), DecodeError> {
        if self.rest.is_empty() {
            return Ok(());
        }
        Err(self.fail(DecodeErrorKind::Trailing { extra: self.rest.len() }, 0))
    }

    /// An error at the next byte.
    pub const fn error(&self, kind: DecodeErrorKind) -> DecodeError {
        DecodeError { at: self.at, kind }
    }

    const fn fail(&self, kind: DecodeErrorKind, ahead: usize) -> DecodeError {
        DecodeError { at: self.at + ahead, kind }
    }
}

/// Why bytes are not what they should be, and at which byte (counted from 0).
#[derive(Clone, Copy, Debug, PartialEq, Eq, thiserror::Error)]
#[error("{kind} at byte {at}")]
pub struct DecodeError {
    /// The byte at which decoding stopped.
    pub at: usize,
    /// What was wrong there.
    pub kind: DecodeErrorKind,
}

impl DecodeError {
    /// The same error inside something that starts `offset` bytes earlier.
    #[must_use]
    pub const fn shifted(self, offset: usize) -> Self {
        Self { at: self.at + offset, kind: self.kind }
    }
}

/// What was wrong with the bytes.
#[derive(Clone, Copy, Debug, PartialEq, Eq, thiserror::Error)]
#[non_exhaustive]
pub enum DecodeErrorKind {
    /// The bytes end too early.
    #[error("{needed} more bytes expected")]
    Truncated {
        /// How many bytes are missing at least.
        needed: usize,
    },
    /// The bytes go on after the end.
    #[error("{extra} bytes too many")]
    Trailing {
        /// How many bytes are left over.
        extra: usize,
    },
    /// A length field promises more than is allowed.
    #[error("length {length} is over the maximum {max}")]
    TooLong {
        /// What the field says.
        length: usize,
        /// What is allowed.
        max: usize,
    },
    /// A field has a value that cannot be there.
    #[error("{field} cannot be {found:#x}")]
    Unexpected {
        /// The name of the field.
        field: &'static str,
        /// What was found.
        found: u32,
    },
}

/// A value would not fit into its length field on the wire.
#[derive(Clone, Copy, Debug, PartialEq, Eq, thiserror::Error)]
#[error("{what} of {length} bytes is over the maximum {max}")]
pub struct TooLong {
    /// What is too long.
    pub what: &'static str,
    /// How long it is, in bytes.
    pub length: usize,
    /// How long it may be, in bytes.
    pub max: usize,
}

#[cfg(test)]
mod tests {
    use super::*;
    use alloc::string::ToString;

    #[test]
    fn an_error_names_the_first_missing_byte() {
        let mut reader = Reader::new(&[1, 2, 3, 4, 5, 6]);
        reader.take(4).unwrap();
        let error = reader.clone().u32().unwrap_err();
        assert_eq!(error.to_string(), "2 more bytes expected at byte 6");
    }

    #[test]
    fn a_sub_reader_counts_in_the_whole() {
        let mut reader = Reader::new(&[1, 2, 3, 4]);
        reader.u8().unwrap();
        let mut sub = reader.sub(2).unwrap();
        assert_eq!(sub.u16().unwrap(), 0x0302);
        assert_eq!(sub.u8().unwrap_err().at, 3);
        assert_eq!(
            reader.finish().unwrap_err(),
            DecodeError { at: 3, kind: DecodeErrorKind::Trailing { extra: 1 } }
        );
    }
}
