//! The files of a project → the project, and everything that is wrong with them.

use alloc::borrow::ToOwned;
use alloc::collections::{BTreeMap, BTreeSet};
use alloc::string::{String, ToString};
use alloc::vec::Vec;

use super::super::block_config::BlockConfig;
use super::culprit::Search;
use super::error::{ProjectError, ProjectErrorKind as Kind};
use super::place::Position;
use super::reader::{self, Notes};
use super::{
    MAX_PROJECT_BYTES, MAX_PROJECT_FILES, PROJECT_HEAD, Project, ProjectGroup, ProjectTarget, target_path,
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
    let (block, notes) = reader::block((file, text), &mut Search::default(), true);
    block.ok_or(notes.errors)
}

/// Reads a device's file, without its groups.
pub fn target(file: &str, text: &str) -> Result<ProjectTarget, Vec<ProjectError>> {
    let (target, notes) = reader::target((file, text), &mut Search::default());
    target.ok_or(notes.errors)
}

/// Reads a group's file.
pub fn group(file: &str, text: &str) -> Result<ProjectGroup, Vec<ProjectError>> {
    let (group, notes) = reader::group((file, text), &mut Search::default());
    group.filter(|_| notes.errors.is_empty()).ok_or(notes.errors)
}

#[derive(Debug, Default)]
struct Reader {
    read: Read,
    /// Groups by their targets and names, with their paths.
    groups: Vec<(String, String, String, ProjectGroup)>,
    /// Paths that were taken, in small letters.
    taken: BTreeMap<String, String>,
    search: Search,
}

impl Reader {
    /// `cipdeck.json`; whether the rest can be read.
    fn head(&mut self, text: &str) -> bool {
        let found = reader::head((PROJECT_HEAD, text), &mut self.search);
        if let Some((version, head)) = self.noted(found) {
            self.read.version = version;
            self.read.project.head = head;
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
                let block = reader::block((path, text), &mut self.search, self.read.version == 0);
                self.keep_block(path, name(file).unwrap_or_default(), block);
            }
            ["targets", file] if name(file).is_some() => {
                self.take(path);
                let target = reader::target((path, text), &mut self.search);
                if let Some(target) = self.noted(target) {
                    self.read.project.targets.insert(name(file).unwrap_or_default(), target);
                }
            }
            ["groups", target, file] if name(file).is_some() => {
                self.take(path);
                let group = reader::group((path, text), &mut self.search);
                if let Some(group) = self.noted(group) {
                    let key = name(file).unwrap_or_default();
                    self.groups.push(((*target).into(), key, path.into(), group));
                }
            }
            // Version 0: blocks as the page copies them.
            [file] if self.read.version == 0 && name(file).is_some() => {
                let key = name(file).unwrap_or_default();
                self.take(&super::block_path(&key));
                let block = reader::block((path, text), &mut self.search, true);
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

    fn keep_block(&mut self, path: &str, key: String, block: (Option<BlockConfig>, Notes<'_>)) {
        let Some(block) = self.noted(block) else { return };
        if path != super::block_path(&key) {
            self.read.origins.insert(key.clone(), path.into());
        }
        self.read.project.blocks.insert(key, block);
    }

    fn groups_find_their_targets(&mut self) {
        let wrong: BTreeSet<String> = self.read.errors.iter().map(|error| error.file.clone()).collect();
        for (target, key, path, group) in core::mem::take(&mut self.groups) {
            if let Some(found) = self.read.project.targets.get_mut(&target) {
                found.groups.insert(key, group);
            } else if !wrong.contains(&target_path(&target)) {
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

    /// What a file says; what is wrong with it is kept.
    fn noted<T>(&mut self, (found, notes): (Option<T>, Notes<'_>)) -> Option<T> {
        self.read.errors.extend(notes.errors);
        self.read.warnings.extend(notes.warnings);
        found
    }

    fn error(&mut self, path: &str, position: Option<Position>, what: Kind) {
        self.read.errors.push(ProjectError { file: path.into(), position, what });
    }

    fn warning(&mut self, path: &str, position: Option<Position>, what: Kind) {
        self.read.warnings.push(ProjectError { file: path.into(), position, what });
    }
}
