//! Names of tags: `Motor.Speed`, `Program:Main.Table[3,1].Value`, `Status.5`.
//!
//! One symbol segment for each part between dots, one member segment for each index. Sources: Omron W506 8-4-5, pycomm3
//! (Logix). A number behind the last dot is a bit: no segment says it, so it is taken from the value.

use alloc::borrow::ToOwned;
use alloc::string::{String, ToString};
use alloc::vec::Vec;
use core::fmt;
use core::str::FromStr;

use crate::wire::{Epath, LogicalKind, Segment, SymbolSegment};

/// The name of a tag, or of a part of one.
#[derive(Clone, Debug, PartialEq, Eq, PartialOrd, Ord, Hash)]
pub struct TagName {
    steps: Vec<Step>,
    bit: Option<u8>,
}

/// From a value to a part of it.
#[derive(Clone, Debug, PartialEq, Eq, PartialOrd, Ord, Hash)]
pub enum Step {
    /// A name: of the tag itself, or of a member.
    Member(String),
    /// One to three indices.
    Index(Vec<u32>),
}

/// Why a text is no name.
#[derive(Clone, Debug, PartialEq, Eq, thiserror::Error)]
pub enum NameError {
    /// Nothing was typed.
    #[error("a name is missing")]
    Empty,
    /// Two dots, or one at an end.
    #[error("a name is missing beside the dot at character {0}")]
    EmptyPart(usize),
    /// A space, a quotation mark …
    #[error("{1:?} at character {0} cannot be in a name")]
    BadCharacter(usize, char),
    /// A part is too long for its segment.
    #[error("the part {0:?} is {1} bytes long; at most 255 fit")]
    TooLong(String, usize),
    /// Not `[1]`, `[1,2]` or `[1,2,3]`.
    #[error("the index at character {0} cannot be read: write [1], [1,2] or [1,2,3]")]
    BadIndex(usize),
    /// A bit over 63.
    #[error("bit {0} does not exist: bits are 0 to 63")]
    BadBit(String),
    /// The path is counted in a byte.
    #[error("the name is {0} bytes long as a path; at most 510 fit")]
    PathTooLong(usize),
}

/// Bytes that the size of a path can count.
const MAX_PATH: usize = 2 * 255;

impl TagName {
    /// The path that a request carries: without the bit.
    pub fn path(&self) -> Epath {
        let mut path = Epath::default();
        for step in &self.steps {
            path = match step {
                // Reading has refused what is empty or too long.
                Step::Member(name) => match SymbolSegment::new(name.as_bytes()) {
                    Some(symbol) => path.with(Segment::Symbol(symbol)),
                    None => path,
                },
                Step::Index(indices) => {
                    indices.iter().fold(path, |path, index| path.then(LogicalKind::Member, *index))
                }
            };
        }
        path
    }

    /// From the tag to the part. The first is always a name.
    pub fn steps(&self) -> &[Step] {
        &self.steps
    }

    /// Which bit of the value, counted from the lowest.
    pub const fn bit(&self) -> Option<u8> {
        self.bit
    }

    /// The value that the bit is taken from.
    #[must_use]
    pub fn without_bit(&self) -> Self {
        Self { steps: self.steps.clone(), bit: None }
    }

    /// A part of this: `.Speed`, `Speed`, `[3]`, `[1,2].Speed`, `.5`.
    pub fn join(&self, part: &str) -> Result<Self, NameError> {
        let (whole, part) = (self.to_string(), part.trim());
        let dot = if part.starts_with(['[', '.']) { "" } else { "." };
        alloc::format!("{whole}{dot}{part}").parse()
    }

    /// What this is a part of; `None` for a tag itself.
    #[must_use]
    pub fn parent(&self) -> Option<Self> {
        let (_, steps) = self.steps.split_last()?;
        (!steps.is_empty()).then(|| Self { steps: steps.to_vec(), bit: None })
    }

    /// The same with one element's indices behind it.
    #[must_use]
    pub fn element(&self, indices: Vec<u32>) -> Self {
        let mut steps = self.steps.clone();
        steps.push(Step::Index(indices));
        Self { steps, bit: None }
    }

    /// How to get from a whole to this; `None` if this is no part of it.
    pub fn within(&self, whole: &Self) -> Option<&[Step]> {
        whole.bit.is_none().then(|| self.steps.strip_prefix(whole.steps.as_slice())).flatten()
    }
}

impl FromStr for TagName {
    type Err = NameError;

    fn from_str(text: &str) -> Result<Self, NameError> {
        let text = text.trim();
        if text.is_empty() {
            return Err(NameError::Empty);
        }
        let mut reader = NameReader { text, at: 0 };
        let mut name = Self { steps: alloc::vec![Step::Member(reader.part()?)], bit: None };
        while let Some(next) = reader.peek() {
            match next {
                '[' => name.steps.push(Step::Index(reader.index()?)),
                '.' => {
                    reader.at += 1;
                    let part = reader.part()?;
                    if !part.bytes().all(|byte| byte.is_ascii_digit()) {
                        name.steps.push(Step::Member(part));
                        continue;
                    }
                    let bit = part.parse().ok().filter(|bit| *bit < 64);
                    name.bit = Some(bit.ok_or(NameError::BadBit(part))?);
                    if let Some(next) = reader.peek() {
                        return Err(NameError::BadCharacter(reader.position(), next));
                    }
                }
                other => return Err(NameError::BadCharacter(reader.position(), other)),
            }
        }
        let length = name.path().bytes().len();
        if length > MAX_PATH {
            return Err(NameError::PathTooLong(length));
        }
        Ok(name)
    }
}

struct NameReader<'a> {
    text: &'a str,
    /// Bytes.
    at: usize,
}

impl NameReader<'_> {
    fn rest(&self) -> &str {
        self.text.get(self.at..).unwrap_or_default()
    }

    fn peek(&self) -> Option<char> {
        self.rest().chars().next()
    }

    /// Counted from 1, in characters.
    fn position(&self) -> usize {
        self.text.get(..self.at).unwrap_or_default().chars().count() + 1
    }

    fn part(&mut self) -> Result<String, NameError> {
        let rest = self.rest();
        let end = rest.find(['.', '[']).unwrap_or(rest.len());
        let part = rest.get(..end).unwrap_or_default().to_owned();
        let bad = |c: &char| c.is_whitespace() || c.is_control() || "]\"'`,;{}()".contains(*c);
        if part.is_empty() {
            return Err(NameError::EmptyPart(self.position()));
        }
        if let Some(index) = part.chars().position(|c| bad(&c)) {
            let found = part.chars().nth(index).unwrap_or_default();
            return Err(NameError::BadCharacter(self.position() + index, found));
        }
        if part.len() > 255 {
            let length = part.len();
            return Err(NameError::TooLong(part, length));
        }
        self.at += part.len();
        Ok(part)
    }

    /// From the bracket on: one to three numbers.
    fn index(&mut self) -> Result<Vec<u32>, NameError> {
        let bad = NameError::BadIndex(self.position());
        let inside = self.rest().strip_prefix('[').and_then(|rest| rest.split_once(']'));
        let Some((inside, _)) = inside else { return Err(bad) };
        let length = inside.len() + 2;
        let number = |text: &str| {
            let text = text.trim();
            text.bytes().all(|byte| byte.is_ascii_digit()).then(|| text.parse().ok()).flatten()
        };
        let indices: Option<Vec<u32>> = inside.split(',').map(number).collect();
        let indices = indices.filter(|indices| indices.len() <= 3).ok_or(bad)?;
        self.at += length;
        Ok(indices)
    }
}

impl fmt::Display for TagName {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        for (place, step) in self.steps.iter().enumerate() {
            match step {
                Step::Member(name) if place == 0 => f.write_str(name)?,
                Step::Member(name) => write!(f, ".{name}")?,
                Step::Index(indices) => {
                    for (place, index) in indices.iter().enumerate() {
                        write!(f, "{}{index}", if place == 0 { '[' } else { ',' })?;
                    }
                    f.write_str("]")?;
                }
            }
        }
        self.bit.map_or(Ok(()), |bit| write!(f, ".{bit}"))
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use hex_literal::hex;

    fn name(text: &str) -> TagName {
        text.parse().unwrap()
    }

    #[test]
    fn a_name_with_members_and_indices_is_the_manuals_path() {
        // Omron W506 8-4-5
        assert_eq!(
            name("VarAA.MemB[1,2]").path().bytes(),
            hex!("91 05 56 61 72 41 41 00 91 04 4D 65 6D 42 28 01 28 02")
        );
        assert_eq!(name("A[300]").path().bytes(), hex!("91 01 41 00 29 00 2C 01"));
        assert_eq!(name("温度").path().bytes(), hex!("91 06 E6 B8 A9 E5 BA A6"));
        assert_eq!(name("TAG1").path().bytes(), hex!("91 04 54 41 47 31"));
    }

    #[test]
    fn names_print_as_they_were_read() {
        for text in
            ["TAG1", "Program:Main.x", "A[1,2,3].b[4].c", "Status.5", "Local:1:I.Data.0", "a.b.63", "ö"]
        {
            assert_eq!(name(text).to_string(), text);
        }
        assert_eq!(name(" A[ 1, 2 ] ").to_string(), "A[1,2]");
        assert_eq!((name("Status.5").bit(), name("Status.5").path()), (Some(5), name("Status").path()));
    }

    #[test]
    fn what_is_no_name_is_said_with_its_place() {
        for (text, error) in [
            ("", NameError::Empty),
            (".a", NameError::EmptyPart(1)),
            ("a..b", NameError::EmptyPart(3)),
            ("a.", NameError::EmptyPart(3)),
            ("a b", NameError::BadCharacter(2, ' ')),
            ("ä\"b", NameError::BadCharacter(2, '"')),
            ("a[1]x", NameError::BadCharacter(5, 'x')),
            ("a[1", NameError::BadIndex(2)),
            ("a[]", NameError::BadIndex(2)),
            ("a[-1]", NameError::BadIndex(2)),
            ("a[1,2,3,4]", NameError::BadIndex(2)),
            ("a[4294967296]", NameError::BadIndex(2)),
            ("a.64", NameError::BadBit("64".into())),
            ("a.5.b", NameError::BadCharacter(4, '.')),
        ] {
            assert_eq!(text.parse::<TagName>(), Err(error), "{text}");
        }
        assert!(matches!("a".repeat(256).parse::<TagName>(), Err(NameError::TooLong(_, 256))));
        let long = [const { "0123456789abcdef" }; 16].join(".");
        assert!(matches!(alloc::format!("{long}.{long}").parse::<TagName>(), Err(NameError::PathTooLong(_))));
    }

    #[test]
    fn parts_are_joined_and_found_again() {
        let whole = name("st");
        for (part, text) in
            [("a", "st.a"), (".a", "st.a"), ("[3]", "st[3]"), ("[3].a", "st[3].a"), ("5", "st.5")]
        {
            assert_eq!(whole.join(part).unwrap().to_string(), text);
        }
        let part = name("st.a[2].b.3");
        let steps = [Step::Member("a".into()), Step::Index(alloc::vec![2]), Step::Member("b".into())];
        assert_eq!(part.within(&whole), Some(&steps[..]));
        assert_eq!(part.within(&name("sta")), None);
        assert_eq!(name("sta").within(&whole), None);
    }
}
