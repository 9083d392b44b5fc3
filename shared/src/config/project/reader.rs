//! One file of a project → what it says, and everything that is wrong with it.

use alloc::string::String;
use alloc::vec::Vec;

use serde::de::DeserializeOwned;
use serde_json::Value;

use super::super::block_config::BlockConfig;
use super::culprit::Search;
use super::document::{Document, Inside, MAX_TOLD, Member, Node, read_part};
use super::error::{ProjectError, ProjectErrorKind as Kind};
use super::place::Position;
use super::variables::parents;
use super::{MAX_PROJECT_FILE, PROJECT_VERSION, ProjectGroup, ProjectHead, ProjectTarget, ProjectVariable};

/// Members that the relay gives to a block.
const GIVEN: [&str; 2] = ["id", "revision"];

/// Members of `cipdeck.json`.
const HEAD: [&str; 2] = ["project", "name"];

/// Members of a target.
const TARGET: [&str; 8] =
    ["name", "site", "path", "profile", "connection", "timeout_ms", "max_requests_per_s", "types"];

/// Members of a group.
const GROUP: [&str; 5] = ["name", "period_ms", "on", "order", "variables"];

/// Members of a variable.
const VARIABLE: [&str; 13] = [
    "parent_address",
    "name",
    "address",
    "type",
    "scale",
    "unit",
    "digits",
    "display",
    "choices",
    "writable",
    "min",
    "max",
    "order",
];

/// What is wrong with one file. Of much only the beginning is told, and how much there is.
#[derive(Debug)]
pub(super) struct Notes<'a> {
    path: &'a str,
    pub(super) errors: Vec<ProjectError>,
    pub(super) warnings: Vec<ProjectError>,
    more_errors: usize,
    more_warnings: usize,
}

impl<'a> Notes<'a> {
    fn about(path: &'a str) -> Self {
        Self { path, errors: Vec::new(), warnings: Vec::new(), more_errors: 0, more_warnings: 0 }
    }

    fn error(&mut self, place: impl FnOnce() -> Option<Position>, what: Kind) {
        tell(self.path, &mut self.errors, &mut self.more_errors, place, what);
    }

    fn warning(&mut self, place: impl FnOnce() -> Option<Position>, what: Kind) {
        tell(self.path, &mut self.warnings, &mut self.more_warnings, place, what);
    }

    fn end(mut self) -> Self {
        for (told, more) in [(&mut self.errors, self.more_errors), (&mut self.warnings, self.more_warnings)] {
            if more > 0 {
                let position = told.last().and_then(|last| last.position);
                told.push(ProjectError { file: self.path.into(), position, what: Kind::More(more) });
            }
        }
        self
    }
}

fn tell(
    path: &str,
    told: &mut Vec<ProjectError>,
    more: &mut usize,
    place: impl FnOnce() -> Option<Position>,
    what: Kind,
) {
    if told.len() < MAX_TOLD {
        told.push(ProjectError { file: path.into(), position: place(), what });
    } else {
        *more += 1;
    }
}

/// A file that is an object in JSON.
struct File<'a, 's> {
    document: Document<'a>,
    notes: Notes<'a>,
    search: &'s mut Search,
}

/// Reads one file; nothing, if it is not to be used.
fn read<'a, T>(
    (path, text): (&'a str, &'a str),
    search: &mut Search,
    read: impl FnOnce(&mut File<'a, '_>) -> Option<T>,
) -> (Option<T>, Notes<'a>) {
    let mut notes = Notes::about(path);
    if text.len() > MAX_PROJECT_FILE {
        notes.error(|| None, Kind::FileTooLong);
        return (None, notes);
    }
    let document = match Document::parse(text) {
        Ok(document) => document,
        Err(wrong) => {
            notes.errors.extend(wrong.into_iter().map(|(place, what)| ProjectError {
                file: path.into(),
                position: Some(place),
                what,
            }));
            return (None, notes);
        }
    };
    // Read into a structure, an array would do, too: its members without their names.
    if !document.value.is_object() {
        let place = document.position(document.root.at);
        notes.error(|| Some(place), Kind::Content("this has to be an object: { … }".into()));
        return (None, notes);
    }
    let mut file = File { document, notes, search };
    let value = read(&mut file);
    (value, file.notes.end())
}

/// `cipdeck.json`: the version of the layout, and the rest.
pub(super) fn head<'a>(
    file: (&'a str, &'a str),
    search: &mut Search,
) -> (Option<(u64, ProjectHead)>, Notes<'a>) {
    read(file, search, |file| {
        let File { document, notes, .. } = file;
        let place = || {
            let found = member(&document.root, "project");
            Some(document.position(found.map_or(document.root.at, |found| found.node.at)))
        };
        let version = document.value.get("project").and_then(Value::as_u64);
        match version.filter(|version| *version > 0) {
            None => notes.error(place, Kind::NoVersion),
            Some(version) if version > PROJECT_VERSION => notes.error(place, Kind::TooNew(version)),
            Some(version) => {
                unknown(document, &document.root, &HEAD, notes);
                let mut value = document.value.clone();
                if let Some(members) = value.as_object_mut() {
                    members.remove("project");
                }
                return file.whole(&value).map(|head| (version, head));
            }
        }
        None
    })
}

/// A block. One that `is_loose` may have what the relay gives.
pub(super) fn block<'a>(
    file: (&'a str, &'a str),
    search: &mut Search,
    is_loose: bool,
) -> (Option<BlockConfig>, Notes<'a>) {
    read(file, search, |file| {
        let mut value = file.document.value.clone();
        for given in GIVEN {
            let is_there = value.as_object_mut().is_some_and(|members| members.remove(given).is_some());
            if is_there && !is_loose {
                let File { document, notes, .. } = &mut *file;
                let place = || member(&document.root, given).map(|found| document.position(found.at));
                notes.warning(place, Kind::Given(given));
            }
        }
        file.whole(&value)
    })
}

/// A device, without its groups.
pub(super) fn target<'a>(
    file: (&'a str, &'a str),
    search: &mut Search,
) -> (Option<ProjectTarget>, Notes<'a>) {
    read(file, search, |file| {
        let File { document, notes, .. } = &mut *file;
        unknown(document, &document.root, &TARGET, notes);
        let value = document.value.clone();
        file.whole(&value)
    })
}

/// A group with its variables.
pub(super) fn group<'a>(file: (&'a str, &'a str), search: &mut Search) -> (Option<ProjectGroup>, Notes<'a>) {
    read(file, search, |file| {
        let File { document, notes, .. } = &mut *file;
        unknown(document, &document.root, &GROUP, notes);
        let mut value = document.value.clone();
        // One after the other: what is wrong in one does not hide what is wrong in others.
        let entries = value.as_object_mut().and_then(|members| match members.get("variables") {
            Some(Value::Array(_)) => members.remove("variables"),
            _ => None,
        });
        let mut group: ProjectGroup = file.whole(&value)?;
        let File { document, notes, search } = file;
        let nodes = match member(&document.root, "variables").map(|found| &found.node.inside) {
            Some(Inside::Items(items)) => items.as_slice(),
            _ => &[],
        };
        let entries = entries.as_ref().and_then(Value::as_array).map_or(&[][..], Vec::as_slice);
        for (entry, node) in entries.iter().zip(nodes) {
            unknown(document, node, &VARIABLE, notes);
            group.variables.extend(part::<ProjectVariable>(document, entry, node, search, notes));
        }
        if group.variables.len() == nodes.len() {
            for (place, what) in parents(&group.variables).err().unwrap_or_default() {
                notes.error(|| nodes.get(place).map(|node| document.position(node.at)), what);
            }
        }
        Some(group)
    })
}

impl File<'_, '_> {
    /// The file, with the value that is left of it.
    fn whole<T: DeserializeOwned>(&mut self, value: &Value) -> Option<T> {
        part(&self.document, value, &self.document.root, self.search, &mut self.notes)
    }
}

fn part<T: DeserializeOwned>(
    document: &Document<'_>,
    value: &Value,
    node: &Node,
    search: &mut Search,
    notes: &mut Notes<'_>,
) -> Option<T> {
    match read_part(value, node, search, serde_json::from_value) {
        Ok(part) => Some(part),
        Err((at, what)) => {
            notes.error(|| Some(document.position(at)), what);
            None
        }
    }
}

fn unknown(document: &Document<'_>, node: &Node, known: &[&str], notes: &mut Notes<'_>) {
    let Inside::Members(members) = &node.inside else { return };
    for member in members.iter().filter(|member| !known.contains(&member.name.as_str())) {
        let what = Kind::Unknown(String::clone(&member.name));
        notes.warning(|| Some(document.position(member.at)), what);
    }
}

fn member<'a>(node: &'a Node, name: &str) -> Option<&'a Member> {
    match &node.inside {
        Inside::Members(members) => members.iter().find(|member| member.name == name),
        _ => None,
    }
}
