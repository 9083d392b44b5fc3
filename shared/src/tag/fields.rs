//! The fields of the data of any message: `speed: REAL; run: BOOL; spare: BYTE[2]`, or a single type.
//!
//! The fields lie one behind the other without gaps, as the attributes and assemblies of CIP objects do. A STRING is a
//! byte of length and then characters, and can only be the last, unless it has a fixed size: `STRING[8]` is 8 bytes.

use alloc::borrow::ToOwned;
use alloc::string::{String, ToString};
use alloc::vec::Vec;

use super::dialect::Dialect;
use super::elementary::{Elementary, Form};
use super::kind::{Dimensions, Type};
use super::read_type::{TypeError, Types};
use super::value::{Value, ValueError};

/// What the bytes of a message's data are.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct DataFields(Vec<DataField>);

/// One number, bit or text.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct DataField {
    /// `speed`, `hist[2]`, `in.run`; empty for a single type.
    pub name: String,
    /// What it is.
    pub kind: FieldKind,
    /// The first byte.
    pub from: usize,
}

/// What a field is.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum FieldKind {
    /// A number, a bit, a time.
    Number(Elementary),
    /// Characters, filled with zeros.
    Characters(usize),
    /// A byte of length, then that many characters.
    ShortString,
}

/// Fields of one message: more would not fit.
const MAX_FIELDS: usize = 490;

impl FieldKind {
    fn name(self) -> String {
        match self {
            Self::Number(kind) => kind.name().to_owned(),
            Self::Characters(length) => alloc::format!("STRING[{length}]"),
            Self::ShortString => "STRING".to_owned(),
        }
    }

    /// Bytes; `None` = to be read.
    const fn size(self) -> Option<usize> {
        match self {
            Self::Number(kind) => Some(kind.size(Dialect::Micro800)),
            Self::Characters(length) => Some(length),
            Self::ShortString => None,
        }
    }

    fn kind(self) -> Type {
        match self {
            Self::Number(kind) => Type::Elementary(kind),
            Self::Characters(length) => Type::String(u16::try_from(length).ok()),
            Self::ShortString => Type::String(Some(255)),
        }
    }
}

impl DataField {
    /// The type's name.
    pub fn type_name(&self) -> String {
        self.kind.name()
    }

    /// Its value in the data; `None` where the data ends before it.
    pub fn value(&self, data: &[u8]) -> Option<Value> {
        let rest = data.get(self.from..)?;
        match self.kind {
            FieldKind::Number(kind) => {
                let bytes = rest.get(..kind.size(Dialect::Micro800))?;
                Type::Elementary(kind).decode(Dialect::Micro800, bytes).ok()
            }
            FieldKind::Characters(length) => {
                let bytes = rest.get(..length)?;
                let end = bytes.iter().position(|byte| *byte == 0).unwrap_or(length);
                Some(Value::Text(bytes.get(..end)?.to_vec()))
            }
            FieldKind::ShortString => {
                let (length, text) = rest.split_first()?;
                Some(Value::Text(text.get(..usize::from(*length))?.to_vec()))
            }
        }
    }

    /// [`Self::value`] as people write it: bits as hexadecimal.
    pub fn text(&self, data: &[u8]) -> Option<String> {
        let value = self.value(data)?;
        Some(match (self.kind, &value) {
            (FieldKind::Number(kind), Value::Unsigned(bits)) if kind.form() == Form::Bits => {
                alloc::format!("0x{bits:0width$X}", width = 2 * kind.size(Dialect::Micro800))
            }
            _ => value.to_string(),
        })
    }

    /// The byte after its last one in the data.
    pub fn to(&self, data: &[u8]) -> usize {
        let length = || 1 + data.get(self.from).map_or(0, |length| usize::from(*length));
        self.from + self.kind.size().unwrap_or_else(length)
    }

    /// Writes what a person has typed into the data. The data grows where it ends before the field; nothing else in it
    /// is touched, but what follows a STRING is cut: it is the last.
    pub fn write(&self, data: &mut Vec<u8>, text: &str) -> Result<(), ValueError> {
        let value = self.kind.kind().parse_value(text)?;
        let mut bytes = Vec::new();
        match (&value, self.kind) {
            (Value::Text(text), FieldKind::Characters(max)) => {
                if text.len() > max {
                    return Err(ValueError::TextTooLong { length: text.len(), max });
                }
                bytes.extend_from_slice(text);
                bytes.resize(max, 0);
            }
            _ => bytes = self.kind.kind().encode(Dialect::Micro800, &value)?,
        }
        if data.len() < self.from + bytes.len() {
            data.resize(self.from + bytes.len(), 0);
        }
        if self.kind == FieldKind::ShortString {
            data.truncate(self.from + bytes.len());
        }
        if let Some(room) = data.get_mut(self.from..self.from + bytes.len()) {
            room.copy_from_slice(&bytes);
        }
        Ok(())
    }
}

impl DataFields {
    /// Reads `REAL`, `INT[4]` or `speed: REAL; run: BOOL`.
    pub fn read(text: &str) -> Result<Self, TypeError> {
        let types = Types::default();
        // Members without their braces.
        let (kind, before) =
            if text.contains(':') && !text.trim_start().to_ascii_uppercase().starts_with("STRUCT") {
                (types.read(&alloc::format!("STRUCT{{{text}}}")), "STRUCT{".len())
            } else {
                (types.read(text), 0)
            };
        let kind = kind.map_err(|error| TypeError { at: error.at.saturating_sub(before).max(1), ..error })?;
        let mut fields = Self(Vec::new());
        match fields.add("", &kind, 0) {
            Ok(_) => Ok(fields),
            Err(why) => Err(TypeError { at: 1, why: why.to_owned() }),
        }
    }

    /// One after the other.
    pub fn each(&self) -> &[DataField] {
        &self.0
    }

    /// Bytes of all of them; `None` if the last one is a STRING.
    pub fn size(&self) -> Option<usize> {
        self.0.last().map_or(Some(0), |last| Some(last.from + last.kind.size()?))
    }

    fn add(&mut self, name: &str, kind: &Type, from: usize) -> Result<usize, &'static str> {
        if self.0.len() >= MAX_FIELDS {
            return Err("a message has room for 490 fields at most");
        }
        let leaf = match kind {
            Type::Elementary(kind) => FieldKind::Number(*kind),
            Type::String(Some(length)) => FieldKind::Characters((*length).into()),
            Type::String(None) => FieldKind::ShortString,
            Type::Array(element, dimensions) => {
                let mut at = from;
                for place in 0..dimensions.count() {
                    at = self.add(&alloc::format!("{name}{}", index(dimensions, place)), element, at)?;
                }
                return Ok(at);
            }
            Type::Structure(structure) => {
                let mut at = from;
                for member in &structure.members {
                    let dot = if name.is_empty() { "" } else { "." };
                    at = self.add(&alloc::format!("{name}{dot}{}", member.name), &member.kind, at)?;
                }
                return Ok(at);
            }
        };
        if self.0.last().is_some_and(|last| last.kind == FieldKind::ShortString) {
            return Err("a STRING without a size can only be the last field");
        }
        self.0.push(DataField { name: name.to_owned(), kind: leaf, from });
        Ok(from + leaf.size().unwrap_or(0))
    }
}

/// `[1,2]`: what the place is called.
fn index(dimensions: &Dimensions, place: usize) -> String {
    let mut rest = place;
    let mut indices: Vec<String> = Vec::new();
    for dimension in dimensions.each().iter().rev() {
        let length = usize::try_from(dimension.length).unwrap_or(usize::MAX);
        let first = usize::try_from(dimension.first).unwrap_or(0);
        indices.push((first + rest % length).to_string());
        rest /= length;
    }
    indices.reverse();
    alloc::format!("[{}]", indices.join(","))
}

#[cfg(test)]
mod tests {
    use super::*;
    use hex_literal::hex;

    #[test]
    fn nobody_packs_a_real_by_hand() {
        let fields = DataFields::read("speed: REAL; run: BOOL; hist: INT[2]; name: STRING[4]").unwrap();
        let mut data = Vec::new();
        for (field, text) in fields.each().iter().zip(["50.5", "TRUE", "-2", "0x10", "AB"]) {
            field.write(&mut data, text).unwrap();
        }
        assert_eq!(data, hex!("00 00 4A 42 01 FE FF 10 00 41 42 00 00"));
        let shown: Vec<_> = fields
            .each()
            .iter()
            .map(|field| {
                alloc::format!("{} {} {}", field.name, field.type_name(), field.value(&data).unwrap())
            })
            .collect();
        let words =
            ["speed REAL 50.5", "run BOOL TRUE", "hist[0] INT -2", "hist[1] INT 16", "name STRING[4] \"AB\""];
        assert_eq!(shown, words);
        assert_eq!(fields.size(), Some(13));
        let bits = DataFields::read("WORD").unwrap();
        assert_eq!(bits.each()[0].text(&[0x80, 1]).as_deref(), Some("0x0180"));
        fields.each()[1].write(&mut data, "0").unwrap();
        assert_eq!(data, hex!("00 00 4A 42 00 FE FF 10 00 41 42 00 00"));
    }

    #[test]
    fn a_text_with_its_length_is_the_last() {
        let fields = DataFields::read("n: UINT; name: STRING").unwrap();
        let mut data = hex!("07 00 03 41 42 43").to_vec();
        let name = &fields.each()[1];
        assert_eq!((name.value(&data).unwrap().to_string(), name.to(&data)), ("\"ABC\"".into(), 6));
        name.write(&mut data, "X").unwrap();
        assert_eq!(data, hex!("07 00 01 58"));
        assert_eq!(name.value(&data[..3]), None);
        assert_eq!(fields.size(), None);
        assert!(DataFields::read("name: STRING; n: UINT").unwrap_err().why.contains("last"));
    }

    #[test]
    fn what_cannot_be_read_is_told_where() {
        assert_eq!(DataFields::read("REAL").unwrap().each().len(), 1);
        assert_eq!(DataFields::read("speed: REEL").unwrap_err().at, 8);
        assert_eq!(DataFields::read("").unwrap_err().at, 1);
        assert!(DataFields::read("a: BYTE[491]").is_err());
        let mut data = Vec::new();
        let refused = DataFields::read("INT").unwrap().each()[0].write(&mut data, "40000").unwrap_err();
        assert_eq!((refused.to_string(), data.len()), ("40000 is outside of INT: -32768 to 32767".into(), 0));
    }
}
