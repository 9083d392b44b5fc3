//! Decisions out of bytes.

/// Bytes that have not been used.
#[derive(Debug)]
pub struct Input<'a>(pub &'a [u8]);

impl<'a> Input<'a> {
    /// The next, if there is one.
    pub fn byte(&mut self) -> Option<u8> {
        let (first, rest) = self.0.split_first()?;
        self.0 = rest;
        Some(*first)
    }

    /// The next, or 0.
    pub fn number(&mut self) -> u8 {
        self.byte().unwrap_or(0)
    }

    /// As many as there are, at most this many.
    pub fn take(&mut self, length: u8) -> &'a [u8] {
        let (taken, rest) = self.0.split_at(usize::from(length).min(self.0.len()));
        self.0 = rest;
        taken
    }
}
