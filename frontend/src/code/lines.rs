//! A text as lines with coloured parts: pure, so that a big one can be drawn a window at a time.

use std::{ops::Range, rc::Rc};

use cipdeck_shared::code::{Dialect, Ink, highlight};

/// Bytes of a text that is coloured. A bigger one is only shown.
pub const MAX_COLOURED: usize = 256 * 1024;

/// Bytes of a line that is drawn. A text with a longer one is shown without line numbers.
const MAX_LINE: usize = 4_000;

/// A text, its lines, and what is coloured in it.
#[derive(Clone, Debug, PartialEq)]
pub struct Lines {
    text: Rc<str>,
    /// Where each line begins.
    starts: Vec<usize>,
    inks: Vec<(Range<usize>, Ink)>,
    longest: usize,
}

impl Lines {
    /// Splits a text, and colours it as parts: each of them lines from 1 in a dialect, in their order.
    pub fn of(text: &Rc<str>, parts: &[(Range<usize>, Dialect)]) -> Self {
        let starts: Vec<_> =
            core::iter::once(0).chain(text.match_indices('\n').map(|(at, _)| at + 1)).collect();
        let ends = starts.iter().skip(1).copied().chain([text.len() + 1]);
        let longest = starts.iter().zip(ends).map(|(start, end)| end - start).max().unwrap_or(0);
        let mut lines = Self { text: text.clone(), starts, inks: Vec::new(), longest };
        if text.len() <= MAX_COLOURED {
            for (part, dialect) in parts {
                lines.colour(part, *dialect);
            }
        }
        lines
    }

    /// The whole text in one dialect.
    pub fn in_one(text: &Rc<str>, dialect: Dialect) -> Self {
        Self::of(text, &[(1..usize::MAX, dialect)])
    }

    /// How many there are; a text has at least one.
    pub fn count(&self) -> usize {
        self.starts.len()
    }

    /// Whether they can be drawn one by one.
    pub fn are_short(&self) -> bool {
        self.longest <= MAX_LINE
    }

    /// The bytes of a line from 1, without its end. After the last one: nothing.
    pub fn range(&self, line: usize) -> Range<usize> {
        let begin = line.checked_sub(1).and_then(|index| self.starts.get(index));
        let end = self.starts.get(line).map_or(self.text.len(), |next| next - 1);
        let begin = *begin.unwrap_or(&self.text.len());
        begin..end.max(begin)
    }

    /// A line from 1 in parts.
    pub fn parts(&self, line: usize) -> Vec<(Option<Ink>, &str)> {
        let Range { start, end } = self.range(line);
        let mut parts = Vec::new();
        let mut at = start;
        let first = self.inks.partition_point(|(range, _)| range.end <= start);
        for (range, ink) in self.inks.iter().skip(first).take_while(|(range, _)| range.start < end) {
            let (from, to) = (range.start.max(at), range.end.min(end));
            // What is not at a character's edge is drawn plainly with what follows.
            let (Some(plain), Some(coloured)) = (self.text.get(at..from), self.text.get(from..to)) else {
                continue;
            };
            if !plain.is_empty() {
                parts.push((None, plain));
            }
            if !coloured.is_empty() {
                parts.push((Some(*ink), coloured));
            }
            at = to;
        }
        let rest = self.text.get(at..end).unwrap_or_default();
        if !rest.is_empty() {
            parts.push((None, rest));
        }
        parts
    }

    fn colour(&mut self, part: &Range<usize>, dialect: Dialect) {
        let from = self.range(part.start.max(1)).start;
        let to = self.range(part.end.saturating_sub(1).max(part.start)).end;
        // Parts that lie over each other are coloured once.
        let from = from.max(self.inks.last().map_or(0, |(range, _)| range.end));
        let Some(text) = self.text.get(from..to) else { return };
        let inks = highlight(dialect, text);
        let moved = inks.into_iter().map(|(range, ink)| (range.start + from..range.end + from, ink));
        self.inks.extend(moved);
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    const TEXT: &str = "x := 1; (* one\ntwo *)\n\nend";

    #[test]
    fn a_text_has_its_lines() {
        let lines = Lines::of(&TEXT.into(), &[]);
        assert_eq!(lines.count(), 4);
        let texts: Vec<_> = (1..=5).map(|line| &TEXT[lines.range(line)]).collect();
        assert_eq!(texts, ["x := 1; (* one", "two *)", "", "end", ""]);
        assert_eq!(Lines::of(&"".into(), &[]).count(), 1);
        assert!(lines.are_short() && !Lines::of(&"a".repeat(9_000).into(), &[]).are_short());
    }

    #[test]
    fn the_parts_of_a_line_are_the_line() {
        for dialect in Dialect::ALL {
            let lines = Lines::in_one(&TEXT.into(), dialect);
            for line in 1..=lines.count() {
                let joined: String = lines.parts(line).iter().map(|(_, text)| *text).collect();
                assert_eq!(joined, TEXT[lines.range(line)], "{dialect:?} {line}");
            }
        }
    }

    #[test]
    fn a_comment_over_two_lines_is_one_on_both() {
        let lines = Lines::in_one(&TEXT.into(), Dialect::CcwSt);
        assert_eq!(lines.parts(1).last(), Some(&(Some(Ink::Comment), "(* one")));
        assert_eq!(lines.parts(2), [(Some(Ink::Comment), "two *)")]);
    }

    #[test]
    fn only_the_lines_of_a_part_are_coloured() {
        let text: Rc<str> = "(* a *)\n(* b *)\n(* c *)".into();
        let lines = Lines::of(&text, &[(2..3, Dialect::CcwSt)]);
        let coloured = |line| lines.parts(line).iter().any(|(ink, _)| ink.is_some());
        assert_eq!([coloured(1), coloured(2), coloured(3)], [false, true, false]);
    }
}
