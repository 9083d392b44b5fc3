//! Reading rows of the tables in `data/`. They are part of the program: a broken row is found by a test.

use super::{Confidence, Entry};

/// One file. Lookups walk its lines, at most 115 of them, and read no more of a line than they need.
#[derive(Clone, Copy, Debug)]
pub(super) struct Table(&'static str);

/// One line.
#[derive(Clone, Copy, Debug)]
pub(super) struct Row {
    /// The first column: class, general status or ErrorID; `None` where the code stands alone.
    pub(super) group: Option<u32>,
    /// The second column; `None` in a row about its whole group.
    pub(super) code: Option<u32>,
    name: &'static str,
    meaning: &'static str,
    hint: &'static str,
    confidence: Confidence,
    source: &'static str,
    /// The last column of services.
    pub(super) access: &'static str,
}

impl Table {
    pub(super) const fn new(text: &'static str) -> Self {
        Self(text)
    }

    /// All rows below the heading.
    #[cfg(test)]
    pub(super) fn rows(self) -> impl Iterator<Item = Row> {
        self.0.lines().skip(1).filter_map(Row::parse)
    }

    /// The row of a code in a group.
    pub(super) fn find(self, group: Option<u32>, code: Option<u32>) -> Option<Row> {
        let is_it = |line: &&str| {
            let mut columns = line.split('\t');
            columns.next().map(number) == Some(group) && columns.next().map(number) == Some(code)
        };
        self.0.lines().skip(1).filter(is_it).find_map(Row::parse)
    }
}

impl Row {
    fn parse(line: &'static str) -> Option<Self> {
        let mut columns = line.split('\t');
        Some(Self {
            group: number(columns.next()?),
            code: number(columns.next()?),
            name: columns.next()?,
            meaning: columns.next()?,
            hint: columns.next()?,
            confidence: Confidence::parse(columns.next()?)?,
            source: columns.next()?,
            access: columns.next().unwrap_or_default(),
        })
    }

    /// What callers see. A row about a whole group has the group's number as its code.
    pub(super) fn entry(self) -> Entry {
        let Self { name, meaning, hint, confidence, source, .. } = self;
        Entry { code: self.code.or(self.group).unwrap_or_default(), name, meaning, hint, confidence, source }
    }
}

fn number(text: &str) -> Option<u32> {
    match text.strip_prefix("0x") {
        Some(digits) => u32::from_str_radix(digits, 16).ok(),
        None => text.parse().ok(),
    }
}
