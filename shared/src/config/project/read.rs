//! The files of a project → the project, and everything that is wrong with them.

use alloc::borrow::ToOwned;
use alloc::collections::BTreeMap;
use alloc::string::{String, ToString};
use alloc::vec::Vec;

use serde_json::Value;

use super::super::block_config::BlockConfig;
use super::document::{Document, Inside, Member, Node, Position};
use super::error::{ProjectError, ProjectErrorKind as Kind};
use super::variables::parents;
use super::{
    MAX_PROJECT_BYTES, MAX_PROJECT_FILE, MAX_PROJECT_FILES, PROJECT_HEAD, PROJECT_VERSION, Project,
    ProjectGroup, ProjectHead, ProjectTarget, ProjectVariable, target_path,
};

/// What files say.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Read {
    /// What could be read. It is the whole project only without errors.
    pub project: Project,
    /// The version of the layout that was found; 0 = loose blocks, without `cipdeck.json`.
    pub version: u64,
    /// Everything that has to be repaired first, by file.
    pub errors: Vec<ProjectError>,
    /// What somebody should know, by file.
    pub warnings: Vec<ProjectError>,
    /// Files that are none of the project's.
    pub ignored: Vec<String>,
    /// The file of each block, where that is not `blocks/KEY.json`.
    pub origins: BTreeMap<String, String>,
}

/// Reads a project. The keys are paths with `/`.
pub fn read(files: &BTreeMap<String, String>) -> Read {
    let mut reader = Reader::default();
    if files.len() > MAX_PROJECT_FILES {
        reader.error(PROJECT_HEAD, None, Kind::TooManyFiles);
        return reader.read;
    }
    if files.values().map(String::len).sum::<usize>() > MAX_PROJECT_BYTES {
        reader.error(PROJECT_HEAD, None, Kind::TooLong);
        return reader.read;
    }
    if let Some(text) = files.get(PROJECT_HEAD)
        && !reader.head(text)
    {
        return reader.read;
    }
    for (path, text) in files {
        reader.file(path, text);
    }
    reader.groups_find_their_targets();
    reader.names();
    reader.read.errors.sort_by(|a, b| (&a.file, a.position).cmp(&(&b.file, b.position)));
    reader.read.warnings.sort_by(|a, b| (&a.file, a.position).cmp(&(&b.file, b.position)));
    reader.read
}

/// Reads one block, wherever it comes from: also one with the id and the revision that it had in a relay.
pub fn block(file: &str, text: &str) -> Result<BlockConfig, Vec<ProjectError>> {
    let mut reader = Reader::default();
    let block = reader.block(file, text);
    block.ok_or(reader.read.errors)
}

/// Reads a device's file, without its groups.
pub fn target(file: &str, text: &str) -> Result<ProjectTarget, Vec<ProjectError>> {
    let mut reader = Reader::default();
    reader.target(file, String::new(), text);
    reader.read.project.targets.into_values().next().ok_or(reader.read.errors)
}

/// Reads a group's file.
pub fn group(file: &str, text: &str) -> Result<ProjectGroup, Vec<ProjectError>> {
    let mut reader = Reader::default();
    reader.group(file, "", String::new(), text);
    let group = reader.groups.pop().map(|(.., group)| group);
    if reader.read.errors.is_empty() { group.ok_or_else(Vec::new) } else { Err(reader.read.errors) }
}

/// Members that the relay gives to a block.
const GIVEN: [&str; 2] = ["id", "revision"];

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

#[derive(Debug, Default)]
struct Reader {
    read: Read,
    /// Groups by their targets and names, with their paths.
    groups: Vec<(String, String, String, ProjectGroup)>,
    /// Paths that were taken, in small letters.
    taken: BTreeMap<String, String>,
}

impl Reader {
    /// `cipdeck.json`; whether the rest can be read.
    fn head(&mut self, text: &str) -> bool {
        let Some(document) = self.document(PROJECT_HEAD, text) else { return false };
        let at = |member: Option<&Member>| {
            document.position(member.map_or(document.root.at, |found| found.node.at))
        };
        let version = document.value.get("project");
        match version.and_then(Value::as_u64).filter(|version| *version > 0) {
            None => self.error(PROJECT_HEAD, Some(at(member(&document.root, "project"))), Kind::NoVersion),
            Some(version) if version > PROJECT_VERSION => {
                self.error(PROJECT_HEAD, Some(at(member(&document.root, "project"))), Kind::TooNew(version));
            }
            Some(version) => {
                self.read.version = version;
                let mut value = document.value.clone();
                if let Some(members) = value.as_object_mut() {
                    members.remove("project");
                }
                match document.read(&value, &document.root, serde_json::from_value::<ProjectHead>) {
                    Ok(head) => self.read.project.head = head,
                    Err((place, what)) => self.error(PROJECT_HEAD, Some(place), what),
                }
            }
        }
        self.read.errors.is_empty()
    }

    /// Any file.
    fn file(&mut self, path: &str, text: &str) {
        let steps: Vec<&str> = path.split('/').collect();
        let is_step = |step: &&str| {
            !matches!(*step, "" | "." | "..")
                && !step.contains(['\\', ':'])
                && !step.contains(char::is_control)
        };
        if path == PROJECT_HEAD {
            return;
        }
        if !steps.iter().all(is_step) {
            return self.error(path, None, Kind::Path);
        }
        if steps.iter().any(|step| step.starts_with('.')) {
            return; // .gitignore, .gitkeep and the like
        }
        let name = |file: &str| file.strip_suffix(".json").map(ToOwned::to_owned);
        match steps[..] {
            ["blocks", file] if name(file).is_some() => {
                self.take(path);
                let (key, block) = (name(file).unwrap_or_default(), self.block(path, text));
                self.keep_block(path, key, block);
            }
            ["targets", file] if name(file).is_some() => {
                self.take(path);
                self.target(path, name(file).unwrap_or_default(), text);
            }
            ["groups", target, file] if name(file).is_some() => {
                self.take(path);
                self.group(path, target, name(file).unwrap_or_default(), text);
            }
            // Version 0: blocks as the page copies them.
            [file] if self.read.version == 0 && name(file).is_some() => {
                let key = name(file).unwrap_or_default();
                self.take(&super::block_path(&key));
                let block = self.block(path, text);
                self.keep_block(path, key, block);
            }
            ["groups", file] if name(file).is_some() => {
                self.error(
                    path,
                    None,
                    Kind::Misplaced("a group is in the folder of its target, groups/TARGET/NAME.json"),
                );
            }
            ["blocks" | "targets", _, .., file] | ["groups", _, _, .., file] if name(file).is_some() => {
                self.error(
                    path,
                    None,
                    Kind::Misplaced("blocks and targets have no folders, and groups those of their targets"),
                );
            }
            _ => self.read.ignored.push(path.into()),
        }
    }

    /// Two paths must differ in more than small and capital letters.
    fn take(&mut self, path: &str) {
        if let Some(other) = self.taken.insert(path.to_lowercase(), path.into()) {
            self.error(path, None, Kind::SameFile(other));
        }
    }

    fn keep_block(&mut self, path: &str, key: String, block: Option<BlockConfig>) {
        let Some(block) = block else { return };
        if path != super::block_path(&key) {
            self.read.origins.insert(key.clone(), path.into());
        }
        self.read.project.blocks.insert(key, block);
    }

    fn block(&mut self, path: &str, text: &str) -> Option<BlockConfig> {
        let document = self.document(path, text)?;
        let mut value = document.value.clone();
        for given in GIVEN {
            if value.as_object_mut().is_some_and(|members| members.remove(given).is_some())
                && self.read.version > 0
            {
                let at = member(&document.root, given).map(|found| document.position(found.at));
                self.warning(path, at, Kind::Given(given));
            }
        }
        self.ok(path, document.read(&value, &document.root, serde_json::from_value::<BlockConfig>))
    }

    fn target(&mut self, path: &str, key: String, text: &str) {
        let Some(document) = self.document(path, text) else { return };
        self.unknown(path, &document, &document.root, &TARGET);
        let target = document.read(&document.value, &document.root, serde_json::from_value::<ProjectTarget>);
        if let Some(target) = self.ok(path, target) {
            self.read.project.targets.insert(key, target);
        }
    }

    fn group(&mut self, path: &str, target: &str, key: String, text: &str) {
        let Some(document) = self.document(path, text) else { return };
        self.unknown(path, &document, &document.root, &GROUP);
        let mut value = document.value.clone();
        // One after the other: what is wrong in one does not hide what is wrong in others.
        let entries = value.as_object_mut().and_then(|members| match members.get("variables") {
            Some(Value::Array(_)) => members.remove("variables"),
            _ => None,
        });
        let Some(mut group) =
            self.ok(path, document.read(&value, &document.root, serde_json::from_value::<ProjectGroup>))
        else {
            return;
        };
        let nodes = match member(&document.root, "variables").map(|found| &found.node.inside) {
            Some(Inside::Items(items)) => items.as_slice(),
            _ => &[],
        };
        let entries = entries.as_ref().and_then(Value::as_array).map_or(&[][..], Vec::as_slice);
        for (entry, node) in entries.iter().zip(nodes) {
            self.unknown(path, &document, node, &VARIABLE);
            let variable = document.read(entry, node, serde_json::from_value::<ProjectVariable>);
            group.variables.extend(self.ok(path, variable));
        }
        if group.variables.len() == nodes.len() {
            for (place, what) in parents(&group.variables).err().unwrap_or_default() {
                let at = nodes.get(place).map(|node| document.position(node.at));
                self.error(path, at, what);
            }
        }
        self.groups.push((target.into(), key, path.into(), group));
    }

    fn groups_find_their_targets(&mut self) {
        for (target, key, path, group) in core::mem::take(&mut self.groups) {
            if let Some(found) = self.read.project.targets.get_mut(&target) {
                found.groups.insert(key, group);
            } else if !self.read.errors.iter().any(|error| error.file == target_path(&target)) {
                self.error(&path, None, Kind::NoTarget(target));
            }
        }
    }

    /// Names that are there more than once.
    fn names(&mut self) {
        let project = &self.read.project;
        let mut same = Vec::new();
        let mut find = |names: &mut dyn Iterator<Item = (String, String)>| {
            let mut seen: BTreeMap<String, String> = BTreeMap::new();
            for (path, name) in names {
                if let Some(other) = seen.get(&name) {
                    same.push((path, other.clone()));
                } else {
                    seen.insert(name, path);
                }
            }
        };
        find(
            &mut project
                .blocks
                .iter()
                .map(|(key, block)| (self.path_of_block(key), block.name().to_string())),
        );
        find(&mut project.targets.iter().map(|(key, target)| (target_path(key), target.config.name.clone())));
        for (key, target) in &project.targets {
            let path = |group: &String| super::group_path(key, group);
            find(&mut target.groups.iter().map(|(group_key, group)| (path(group_key), group.name.clone())));
        }
        for (path, other) in same {
            self.warning(&path, None, Kind::SameName(other));
        }
    }

    fn path_of_block(&self, key: &str) -> String {
        self.read.origins.get(key).cloned().unwrap_or_else(|| super::block_path(key))
    }

    /// JSON, and an object.
    fn document<'a>(&mut self, path: &str, text: &'a str) -> Option<Document<'a>> {
        if text.len() > MAX_PROJECT_FILE {
            self.error(path, None, Kind::FileTooLong);
            return None;
        }
        let document = match Document::parse(text) {
            Ok(document) => document,
            Err(wrong) => {
                for (place, what) in wrong {
                    self.error(path, Some(place), what);
                }
                return None;
            }
        };
        // Read into a structure, an array would do, too: its members without their names.
        if !document.value.is_object() {
            let place = document.position(document.root.at);
            self.error(path, Some(place), Kind::Content("this has to be an object: { … }".into()));
            return None;
        }
        Some(document)
    }

    fn unknown(&mut self, path: &str, document: &Document<'_>, node: &Node, known: &[&str]) {
        let Inside::Members(members) = &node.inside else { return };
        for member in members.iter().filter(|member| !known.contains(&member.name.as_str())) {
            self.warning(path, Some(document.position(member.at)), Kind::Unknown(member.name.clone()));
        }
    }

    fn ok<T>(&mut self, path: &str, result: Result<T, (Position, Kind)>) -> Option<T> {
        result.map_err(|(place, what)| self.error(path, Some(place), what)).ok()
    }

    fn error(&mut self, path: &str, position: Option<Position>, what: Kind) {
        self.read.errors.push(ProjectError { file: path.into(), position, what });
    }

    fn warning(&mut self, path: &str, position: Option<Position>, what: Kind) {
        self.read.warnings.push(ProjectError { file: path.into(), position, what });
    }
}

fn member<'a>(node: &'a Node, name: &str) -> Option<&'a Member> {
    match &node.inside {
        Inside::Members(members) => members.iter().find(|member| member.name == name),
        _ => None,
    }
}
