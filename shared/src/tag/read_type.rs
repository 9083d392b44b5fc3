//! Types as text: `REAL`, `DINT[10]`, `INT[1..10,0..4]`, `STRING[20]`, `STRING[20][5]`, `STRUCT{speed: REAL; run: BOOL}`, and
//! names of layouts. `ARRAY[0..9] OF INT` is read as well.

use alloc::borrow::ToOwned;
use alloc::boxed::Box;
use alloc::collections::BTreeMap;
use alloc::string::{String, ToString};
use alloc::sync::Arc;
use alloc::vec::Vec;
use core::fmt;
use core::str::FromStr;

use super::elementary::Elementary;
use super::kind::{Dimension, Dimensions, Member, Structure, Type};

/// Layouts by name: what somebody has entered or imported, or a device has told.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub struct Types(BTreeMap<String, Type>);

/// Why a text is no type.
#[derive(Clone, Debug, PartialEq, Eq, thiserror::Error)]
#[error("{why} at character {at}")]
pub struct TypeError {
    /// Counted from 1.
    pub at: usize,
    /// What is wrong there.
    pub why: String,
}

/// Structures inside of structures.
const MAX_DEPTH: usize = 16;

impl Types {
    /// Adds a layout; it may use those that are there.
    pub fn add(&mut self, name: &str, text: &str) -> Result<(), TypeError> {
        let kind = match self.read(text)? {
            Type::Structure(structure) if structure.name.is_empty() => {
                Type::Structure(Arc::new(Structure { name: name.to_owned(), ..(*structure).clone() }))
            }
            kind => kind,
        };
        self.put(name, kind);
        Ok(())
    }

    /// Adds a layout that a device has told.
    pub fn put(&mut self, name: &str, kind: Type) {
        self.0.insert(name.to_ascii_lowercase(), kind);
    }

    /// A layout.
    pub fn get(&self, name: &str) -> Option<&Type> {
        self.0.get(&name.to_ascii_lowercase())
    }

    /// Reads a type that may use the layouts.
    pub fn read(&self, text: &str) -> Result<Type, TypeError> {
        let mut reader = TypeReader { text, at: 0, types: self };
        let kind = reader.kind(0)?;
        reader.space();
        match reader.peek() {
            None => Ok(kind),
            Some(other) => Err(reader.error(&alloc::format!("{other:?} is too much"))),
        }
    }
}

impl FromStr for Type {
    type Err = TypeError;

    /// Reads a type without layouts.
    fn from_str(text: &str) -> Result<Self, TypeError> {
        Types::default().read(text)
    }
}

struct TypeReader<'a> {
    text: &'a str,
    /// Bytes.
    at: usize,
    types: &'a Types,
}

impl TypeReader<'_> {
    fn rest(&self) -> &str {
        self.text.get(self.at..).unwrap_or_default()
    }

    fn peek(&self) -> Option<char> {
        self.rest().chars().next()
    }

    fn space(&mut self) {
        self.at += self.rest().len() - self.rest().trim_start().len();
    }

    fn take(&mut self, sign: char) -> bool {
        self.space();
        let is_there = self.peek() == Some(sign);
        self.at += if is_there { sign.len_utf8() } else { 0 };
        is_there
    }

    fn error(&self, why: &str) -> TypeError {
        let at = self.text.get(..self.at).unwrap_or_default().chars().count() + 1;
        TypeError { at, why: why.to_owned() }
    }

    fn expect(&mut self, sign: char) -> Result<(), TypeError> {
        if self.take(sign) { Ok(()) } else { Err(self.error(&alloc::format!("{sign:?} is missing"))) }
    }

    fn word(&mut self) -> String {
        self.space();
        let rest = self.rest();
        let end = rest.find(|c: char| c.is_whitespace() || "[]{}():;,.".contains(c)).unwrap_or(rest.len());
        let word = rest.get(..end).unwrap_or_default().to_owned();
        self.at += word.len();
        word
    }

    fn number(&mut self) -> Result<u32, TypeError> {
        self.space();
        let begin = self.error("a number is missing");
        let rest = self.rest();
        let end = rest.find(|c: char| !c.is_ascii_digit()).unwrap_or(rest.len());
        let digits = rest.get(..end).unwrap_or_default();
        if digits.is_empty() {
            return Err(begin);
        }
        let number =
            digits.parse().map_err(|_| TypeError { why: "the number is too big".to_owned(), ..begin });
        self.at += end;
        number
    }

    fn kind(&mut self, depth: usize) -> Result<Type, TypeError> {
        self.space();
        let begin = self.error("a type is missing");
        if depth > MAX_DEPTH {
            return Err(TypeError { why: "too many structures inside of each other".to_owned(), ..begin });
        }
        let word = self.word();
        let mut kind = match word.to_ascii_uppercase().as_str() {
            "" => return Err(begin),
            "ARRAY" => {
                let dimensions = self.dimensions()?;
                if !self.word().eq_ignore_ascii_case("OF") {
                    return Err(self.error("OF is missing"));
                }
                return Ok(Type::Array(Box::new(self.kind(depth + 1)?), dimensions));
            }
            "STRUCT" => self.structure(depth)?,
            "STRING" => Type::String(self.capacity()?),
            _ => {
                if let Some(elementary) = Elementary::of_name(&word) {
                    Type::Elementary(elementary)
                } else {
                    let why = alloc::format!("{word:?} is neither a type nor a layout that is known");
                    self.types.get(&word).cloned().ok_or(TypeError { why, ..begin })?
                }
            }
        };
        self.space();
        if self.peek() == Some('[') {
            kind = Type::Array(Box::new(kind), self.dimensions()?);
        }
        Ok(kind)
    }

    fn capacity(&mut self) -> Result<Option<u16>, TypeError> {
        let close = if self.take('[') {
            ']'
        } else if self.take('(') {
            ')'
        } else {
            return Ok(None);
        };
        let begin = self.error("a STRING holds 1 to 65535 bytes");
        let capacity = u16::try_from(self.number()?).ok().filter(|capacity| *capacity > 0).ok_or(begin)?;
        self.expect(close)?;
        Ok(Some(capacity))
    }

    /// From the bracket on.
    fn dimensions(&mut self) -> Result<Dimensions, TypeError> {
        let begin = self.error("an array has one to three dimensions and at most 1048576 elements");
        self.expect('[')?;
        let mut all = Vec::new();
        loop {
            let number = self.number()?;
            self.space();
            let dimension = if self.rest().starts_with("..") {
                self.at += 2;
                let last = self.number()?;
                let length = last.checked_sub(number).and_then(|length| length.checked_add(1));
                let why = "the last index is before the first".to_owned();
                Dimension { first: number, length: length.ok_or_else(|| TypeError { why, ..begin.clone() })? }
            } else {
                Dimension { first: 0, length: number }
            };
            all.push(dimension);
            if !self.take(',') {
                break;
            }
        }
        self.expect(']')?;
        Dimensions::new(all).ok_or(begin)
    }

    fn structure(&mut self, depth: usize) -> Result<Type, TypeError> {
        self.expect('{')?;
        let mut members: Vec<Member> = Vec::new();
        while !self.take('}') {
            self.space();
            let begin = self.error("a member's name is missing");
            let name = self.word();
            if name.is_empty() {
                return Err(begin);
            }
            if members.iter().any(|member| member.name.eq_ignore_ascii_case(&name)) {
                return Err(TypeError { why: alloc::format!("the member {name:?} is there twice"), ..begin });
            }
            self.expect(':')?;
            let kind = self.kind(depth + 1)?;
            members.push(Member { name, kind, place: None });
            if !self.take(';') {
                self.expect('}')?;
                break;
            }
        }
        if members.is_empty() {
            return Err(self.error("a structure has a member"));
        }
        Ok(Type::Structure(Arc::new(Structure { members, ..Structure::default() })))
    }
}

impl fmt::Display for Type {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Elementary(kind) => f.write_str(kind.name()),
            Self::String(None) => f.write_str("STRING"),
            Self::String(Some(capacity)) => write!(f, "STRING[{capacity}]"),
            Self::Array(element, dimensions) => {
                match **element {
                    // Without a capacity the bracket would be one.
                    Self::String(None) | Self::Array(..) => {
                        write!(f, "ARRAY{dimensions} OF {element}")
                    }
                    _ => write!(f, "{element}{dimensions}"),
                }
            }
            Self::Structure(structure) if !structure.name.is_empty() => f.write_str(&structure.name),
            Self::Structure(structure) => write!(f, "{structure}"),
        }
    }
}

impl fmt::Display for Dimensions {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let each = |dimension: &Dimension| match *dimension {
            Dimension { first: 0, length } => length.to_string(),
            Dimension { first, length } => alloc::format!("{first}..{}", first + (length - 1)),
        };
        let all: Vec<_> = self.each().iter().map(each).collect();
        write!(f, "[{}]", all.join(","))
    }
}

/// Its members, whatever it is called.
impl fmt::Display for Structure {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str("STRUCT{")?;
        for (place, Member { name, kind, .. }) in self.members.iter().enumerate() {
            write!(f, "{}{name}: {kind}", if place == 0 { "" } else { "; " })?;
        }
        f.write_str("}")
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn types_print_as_they_are_read() {
        for text in [
            "REAL",
            "DINT[10]",
            "INT[2,3,4]",
            "INT[1..10,0..4]",
            "STRING",
            "STRING[20]",
            "STRING[20][5]",
            "ARRAY[5] OF STRING",
            "STRUCT{speed: REAL; run: BOOL; hist: INT[4]; in: STRUCT{a: STRING[8]}}",
            "STRUCT{a: DINT}[3]",
        ] {
            let kind: Type = text.parse().unwrap();
            let again: Type = kind.to_string().parse().unwrap();
            assert_eq!(again, kind, "{text}");
            if !text.contains("0..") {
                assert_eq!(kind.to_string(), text);
            }
        }
        assert_eq!("array [0..9] of int".parse::<Type>().unwrap().to_string(), "INT[10]");
        assert_eq!(" string( 8 ) ".parse::<Type>().unwrap(), Type::String(Some(8)));
    }

    #[test]
    fn layouts_are_used_by_name() {
        let mut types = Types::default();
        types.add("Motor", "STRUCT{speed: REAL; run: BOOL}").unwrap();
        types.add("Line", "STRUCT{m: Motor[4]; name: STRING[8]}").unwrap();
        assert_eq!(types.read("line").unwrap().to_string(), "Line");
        let refused = types.read("Pump").unwrap_err();
        assert_eq!(
            refused.to_string(),
            r#""Pump" is neither a type nor a layout that is known at character 1"#
        );
    }

    #[test]
    fn what_is_no_type_is_said_with_its_place() {
        for (text, at) in [
            ("", 1),
            ("REALL", 1),
            ("REAL x", 6),
            ("DINT[", 6),
            ("DINT[0]", 5),
            ("DINT[1,2,3,4]", 5),
            ("DINT[5..2]", 5),
            ("DINT[99999999999]", 6),
            ("DINT[2000000]", 5),
            ("STRING[0]", 8),
            ("STRING[70000]", 8),
            ("STRUCT{}", 9),
            ("STRUCT{a DINT}", 10),
            ("STRUCT{a: DINT; A: INT}", 17),
            ("STRUCT{a: DINT", 15),
            ("ARRAY[3] DINT", 14),
        ] {
            assert_eq!(text.parse::<Type>().unwrap_err().at, at, "{text}: {:?}", text.parse::<Type>());
        }
        let deep = "STRUCT{a: ".repeat(40) + "DINT" + &"}".repeat(40);
        assert!(deep.parse::<Type>().unwrap_err().why.contains("too many"));
    }
}
