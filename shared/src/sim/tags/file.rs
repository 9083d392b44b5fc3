//! Tables of tags as JSON: those of the usual controllers, and of a file that somebody writes.
//!
//! A list of tags, or an object with `types` and `tags`; see `docs/SIMULATOR.md`.

use alloc::borrow::ToOwned;
use alloc::format;
use alloc::string::{String, ToString};
use alloc::vec::Vec;
use core::fmt;

use serde::Deserialize;
use serde_json::Value as Json;

use crate::tag::{Dialect, Types};

use super::memory::{TagAccess, TagDefinition, TagMemory};

/// Why a table of tags cannot be used.
#[derive(Clone, Debug, PartialEq, Eq, thiserror::Error)]
pub struct TagFileError {
    /// Counted from 1.
    pub line: usize,
    /// The tag or the type, where it is about one.
    pub name: Option<String>,
    /// What is wrong.
    pub why: String,
}

impl fmt::Display for TagFileError {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "line {}", self.line)?;
        if let Some(name) = &self.name {
            write!(f, ", {name}")?;
        }
        write!(f, ": {}", self.why)
    }
}

#[derive(Debug, Default, Deserialize)]
#[serde(deny_unknown_fields)]
struct Table {
    #[serde(default)]
    types: Vec<NamedType>,
    tags: Vec<Row>,
}

#[derive(Debug, Deserialize)]
#[serde(deny_unknown_fields)]
struct NamedType {
    name: String,
    #[serde(rename = "type")]
    kind: String,
}

#[derive(Debug, Deserialize)]
#[serde(deny_unknown_fields)]
struct Row {
    name: String,
    #[serde(rename = "type")]
    kind: String,
    value: Option<Json>,
    moves: Option<Json>,
    access: Option<String>,
    range: Option<(i64, i64)>,
    /// So many tags; the signs `#` of the name become their number.
    times: Option<u32>,
}

/// Tags of one row. Our own limit.
const MAX_TIMES: u32 = 100_000;

impl TagMemory {
    /// The tags of a file.
    pub fn from_json(dialect: Dialect, text: &str) -> Result<Self, TagFileError> {
        let is_list = text.trim_start().starts_with('[');
        let table = if is_list {
            serde_json::from_str(text).map(|tags| Table { tags, ..Table::default() })
        } else {
            serde_json::from_str(text)
        };
        let table: Table = table.map_err(|error| TagFileError {
            line: error.line().max(1),
            name: None,
            why: without_place(&error.to_string()),
        })?;
        let fail = |name: &str, why: String| TagFileError {
            line: line_of(text, name),
            name: Some(name.to_owned()),
            why,
        };
        let mut types = Types::default();
        for NamedType { name, kind } in &table.types {
            types.add(name, kind).map_err(|error| fail(name, error.to_string()))?;
        }
        let mut definitions = Vec::new();
        for row in &table.tags {
            let definition = row.definition(&types).map_err(|why| fail(&row.name, why))?;
            // By itself, so that what is wrong with it is said with its line.
            Self::new(dialect, alloc::vec![definition.clone()])
                .map_err(|error| fail(&row.name, error.to_string()))?;
            match row.times {
                None => definitions.push(definition),
                Some(times @ 1..=MAX_TIMES) => {
                    definitions.extend((0..times).map(|number| TagDefinition {
                        name: numbered(&row.name, number),
                        ..definition.clone()
                    }));
                }
                Some(_) => return Err(fail(&row.name, format!("times is 1 to {MAX_TIMES}"))),
            }
        }
        Self::new(dialect, definitions).map_err(|error| match &error {
            super::DefinitionError::Name(name, _) => fail(name, error.to_string()),
            other => TagFileError { line: 1, name: None, why: other.to_string() },
        })
    }

    /// The tags that a controller of the family has when nothing else is said: values of all types, structures, arrays,
    /// values that move, one that can only be read and one that is not to be seen. The tables are in `tags/usual`.
    pub fn usual(dialect: Dialect) -> Self {
        let text = match dialect {
            Dialect::Logix => include_str!("usual/logix.json"),
            Dialect::Micro800 => include_str!("usual/micro800.json"),
            Dialect::Omron => include_str!("usual/omron.json"),
        };
        // That the tables are right is tested.
        Self::from_json(dialect, text).unwrap_or_else(|_| Self::empty(dialect))
    }
}

impl Row {
    fn definition(&self, types: &Types) -> Result<TagDefinition, String> {
        let kind = types.read(&self.kind).map_err(|error| format!("type: {error}"))?;
        let value = self.value.as_ref().map(|json| kind.value_of_json(json));
        let value = value.transpose().map_err(|error| format!("value: {error}"))?;
        let access = match self.access.as_deref() {
            None | Some("write") => TagAccess::Write,
            Some("read") => TagAccess::Read,
            Some("none") => TagAccess::None,
            Some(_) => return Err("access is one of write, read, none".to_owned()),
        };
        let motion = |json: &Json| {
            let text = json.as_str().unwrap_or_default();
            text.parse().map_err(|error: super::UnknownMotion| format!("moves: {error}"))
        };
        let moves = match &self.moves {
            None => Vec::new(),
            Some(Json::Object(parts)) => parts
                .iter()
                .map(|(part, json)| Ok((part.clone(), motion(json)?)))
                .collect::<Result<_, String>>()?,
            Some(json) => alloc::vec![(String::new(), motion(json)?)],
        };
        Ok(TagDefinition { name: self.name.clone(), kind, value, moves, access, range: self.range })
    }
}

/// The name with its number where the signs `#` are.
fn numbered(name: &str, number: u32) -> String {
    let signs = name.matches('#').count();
    let digits = format!("{number:0signs$}");
    match name.find('#') {
        Some(at) => {
            let rest = name.get(at..).unwrap_or_default().trim_start_matches('#');
            format!("{}{digits}{rest}", name.get(..at).unwrap_or_default())
        }
        None => format!("{name}{digits}"),
    }
}

/// The line on which a name stands first, counted from 1.
fn line_of(text: &str, name: &str) -> usize {
    let quoted = serde_json::to_string(name).unwrap_or_default();
    let before = text.find(&quoted).and_then(|at| text.get(..at)).unwrap_or_default();
    before.matches('\n').count() + 1
}

/// The place is said before.
fn without_place(error: &str) -> String {
    error.rsplit_once(" at line ").map_or(error, |(error, _)| error).to_owned()
}
