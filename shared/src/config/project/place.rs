//! Places in a text, as editors count them.

use alloc::vec::Vec;

/// A place in a text, as editors count: both from 1, columns in characters.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub struct Position {
    /// From 1.
    pub line: usize,
    /// In characters, from 1.
    pub column: usize,
}

/// A text that knows where its lines begin: it may have many lines, and be asked often.
#[derive(Debug)]
pub(super) struct Lines<'a> {
    text: &'a str,
    /// The first byte of each line but the first.
    begins: Vec<usize>,
}

impl<'a> Lines<'a> {
    pub(super) fn of(text: &'a str) -> Self {
        let begins = text.bytes().enumerate().filter(|(_, byte)| *byte == b'\n').map(|(at, _)| at + 1);
        Self { text, begins: begins.collect() }
    }

    /// The place of a byte.
    pub(super) fn position(&self, at: usize) -> Position {
        let above = self.begins.partition_point(|begin| *begin <= at);
        let begin = above.checked_sub(1).and_then(|above| self.begins.get(above)).copied().unwrap_or(0);
        let before = self.text.get(begin..self.text.floor_char_boundary(at)).unwrap_or_default();
        Position { line: above + 1, column: before.chars().count() + 1 }
    }

    /// The place that serde names: it counts the bytes of a line from 1, and 0 before its first.
    pub(super) fn position_of_serde(&self, line: usize, column: usize) -> Position {
        let begin = line.checked_sub(2).and_then(|above| self.begins.get(above)).copied().unwrap_or(0);
        let end = self.begins.get(line.saturating_sub(1)).map_or(self.text.len(), |next| next - 1);
        self.position((begin + column.saturating_sub(1)).min(end))
    }
}
