//! What files say → what is stored.

use cipdeck_shared::api::{ProjectChange, ProjectPart, ProjectPartKind};
use cipdeck_shared::config::project::{
    Project, ProjectGroup, ProjectTarget, block_path, group_path, is_portable, target_path,
};
use cipdeck_shared::config::{BlockConfig, BlockId, DeviceId, GroupConfig, GroupId};
use rusqlite::Connection;

use super::difference::{difference, together};
use super::variables::variables;
use super::{Outcome, Touched, target_of};
use crate::draft::normalised;
use crate::plant::{MAX_DEVICES, MAX_GROUPS};
use crate::store::{
    Scope, StoreError, StoredBlock, StoredGroup, StoredProject, StoredTarget, Table, load_project,
};

/// What is known of the files.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum How {
    /// They are the folder of the project: files are who they were. If they have been it before, what has no file any
    /// more is gone.
    Folder { was_joined: bool },
    /// They come from elsewhere: names count, and what is not among them stays.
    Import,
}

/// Makes what is stored what the files say, or as much of it as they speak of.
pub(crate) fn merge(connection: &Connection, project: &Project, how: How) -> Result<Outcome, StoreError> {
    let stored = load_project(connection, Scope::All)?;
    let mut merge = Merge { connection, how, outcome: Outcome::default() };
    merge.blocks(project, &stored)?;
    merge.targets(project, &stored)?;
    if how == How::Import {
        let is_device = |part: &&ProjectPart| part.what == ProjectPartKind::Target;
        at_most(MAX_DEVICES, merge.outcome.parts.iter().filter(is_device).count(), "devices")?;
    }
    Ok(merge.outcome)
}

/// Whether a file, with the name in it, is something that is stored, with its file.
type Rule = fn((&str, &str), (Option<&str>, &str)) -> bool;

struct Merge<'a> {
    connection: &'a Connection,
    how: How,
    outcome: Outcome,
}

impl Merge<'_> {
    fn blocks(&mut self, project: &Project, stored: &StoredProject) -> Result<(), StoreError> {
        let there: Vec<_> =
            stored.blocks.iter().map(|one| (one.file.as_deref(), one.block.config.name())).collect();
        let matches =
            self.matches(project.blocks.iter().map(|(file, block)| (file.as_str(), block.name())), &there);
        for ((file, config), found) in project.blocks.iter().zip(&matches) {
            let found = found.and_then(|place| stored.blocks.get(place));
            self.block(file, &normalised(config.clone()), found)?;
        }
        for (_, one) in left(&stored.blocks, &matches) {
            let (id, name) = (one.block.id, one.block.config.name());
            let how = self.left(Table::Block, id.0, one.file.as_deref())?;
            let file = one.file.as_deref().map(block_path);
            self.tell(ProjectPartKind::Block, how, name, id.to_string(), file, None);
            self.touch(how, Touched::Block(id));
        }
        Ok(())
    }

    fn block(
        &mut self,
        file: &str,
        config: &BlockConfig,
        found: Option<&StoredBlock>,
    ) -> Result<(), StoreError> {
        let (how, id) = match found {
            None => (ProjectChange::Created, Table::Block.insert(self.connection, None, config)?),
            Some(found) if found.block.config == *config => (ProjectChange::Unchanged, found.block.id.0),
            Some(found) => {
                Table::Block.update(self.connection, found.block.id.0, config)?;
                (ProjectChange::Changed, found.block.id.0)
            }
        };
        let id = BlockId(id);
        self.name(Table::Block, id.0, file, found.and_then(|found| found.file.as_deref()))?;
        let detail = found.and_then(|found| difference(&found.block.config, config));
        self.tell(ProjectPartKind::Block, how, config.name(), id.to_string(), Some(block_path(file)), detail);
        self.touch(how, Touched::Block(id));
        Ok(())
    }

    fn targets(&mut self, project: &Project, stored: &StoredProject) -> Result<(), StoreError> {
        let there: Vec<_> =
            stored.targets.iter().map(|one| (one.file.as_deref(), one.device.config.name.as_str())).collect();
        let wanted =
            project.targets.iter().map(|(file, target)| (file.as_str(), target.config.name.as_str()));
        let matches = self.matches(wanted, &there);
        for ((file, target), found) in project.targets.iter().zip(&matches) {
            self.target(file, target, found.and_then(|place| stored.targets.get(place)))?;
        }
        for (_, one) in left(&stored.targets, &matches) {
            let (id, file) = (one.device.id, one.file.as_deref());
            let how = self.left(Table::Device, id.0, file)?;
            let groups: Vec<_> = one.groups.iter().map(|group| group.group.config.name.as_str()).collect();
            let is_more = how == ProjectChange::Removed && !groups.is_empty();
            let detail = is_more.then(|| format!("with its groups: {}", groups.join(", ")));
            let name = &one.device.config.name;
            self.tell(ProjectPartKind::Target, how, name, id.to_string(), file.map(target_path), detail);
            self.touch(how, Touched::Device(id));
        }
        Ok(())
    }

    fn target(
        &mut self,
        file: &str,
        target: &ProjectTarget,
        found: Option<&StoredTarget>,
    ) -> Result<(), StoreError> {
        let table = Table::Device;
        let (how, id) = match found {
            None => (ProjectChange::Created, table.insert(self.connection, None, &target.config)?),
            Some(found) if found.device.config == target.config && found.extra == target.extra => {
                (ProjectChange::Unchanged, found.device.id.0)
            }
            Some(found) => {
                if found.device.config != target.config {
                    table.update(self.connection, found.device.id.0, &target.config)?;
                }
                (ProjectChange::Changed, found.device.id.0)
            }
        };
        table.set_extra(self.connection, id, &target.extra)?;
        self.name(table, id, file, found.and_then(|found| found.file.as_deref()))?;
        let id = DeviceId(id);
        let detail = found.and_then(|found| difference(&target_of(found), target));
        let name = &target.config.name;
        self.tell(ProjectPartKind::Target, how, name, id.to_string(), Some(target_path(file)), detail);
        self.touch(how, Touched::Device(id));
        let groups = found.map_or(&[][..], |found| found.groups.as_slice());
        let there: Vec<_> =
            groups.iter().map(|one| (one.file.as_deref(), one.group.config.name.as_str())).collect();
        let wanted = target.groups.iter().map(|(file, group)| (file.as_str(), group.name.as_str()));
        let matches = self.matches(wanted, &there);
        if self.how == How::Import {
            let new = matches.iter().filter(|found| found.is_none()).count();
            at_most(MAX_GROUPS, groups.len() + new, "groups of one device")?;
        }
        for ((name, group), found) in target.groups.iter().zip(&matches) {
            self.group(id, &group_path(file, name), name, group, found.and_then(|place| groups.get(place)))?;
        }
        for (_, one) in left(groups, &matches) {
            let (id, name) = (one.group.id, one.file.as_deref());
            let how = self.left(Table::Group, id.0, name)?;
            let path = name.map(|name| group_path(file, name));
            let count = one.variables.len();
            let is_more = how == ProjectChange::Removed && count > 0;
            let detail = is_more.then(|| format!("variables: {count} removed"));
            self.tell(ProjectPartKind::Group, how, &one.group.config.name, id.to_string(), path, detail);
            self.touch(how, Touched::Group(id));
        }
        Ok(())
    }

    fn group(
        &mut self,
        device: DeviceId,
        path: &str,
        file: &str,
        group: &ProjectGroup,
        found: Option<&StoredGroup>,
    ) -> Result<(), StoreError> {
        let table = Table::Group;
        let ProjectGroup { name, period_ms, on, order, extra, .. } = group;
        let config =
            GroupConfig { device, name: name.clone(), period_ms: *period_ms, on: *on, order: *order };
        let id = match found {
            None => table.insert(self.connection, Some(device.0), &config)?,
            Some(found) => {
                if found.group.config != config {
                    table.update(self.connection, found.group.id.0, &config)?;
                }
                found.group.id.0
            }
        };
        table.set_extra(self.connection, id, extra)?;
        self.name(table, id, file, found.and_then(|found| found.file.as_deref()))?;
        let id = GroupId(id);
        let counts = variables(self.connection, id, group, found)?;
        let how = match found {
            None => ProjectChange::Created,
            Some(found) if found.group.config == config && found.extra == *extra && counts.is_nothing() => {
                ProjectChange::Unchanged
            }
            Some(_) => ProjectChange::Changed,
        };
        let own = found.map(|found| {
            together([difference(&found.group.config, &config), difference(&found.extra, extra)])
        });
        let detail = together([own.flatten(), counts.words()]);
        self.tell(ProjectPartKind::Group, how, name, id.to_string(), Some(path.to_owned()), detail);
        self.touch(how, Touched::Group(id));
        Ok(())
    }

    /// What in the store each file is, by its place; nothing is twice.
    fn matches<'b>(
        &self,
        wanted: impl Iterator<Item = (&'b str, &'b str)>,
        there: &[(Option<&str>, &str)],
    ) -> Vec<Option<usize>> {
        let wanted: Vec<_> = wanted.collect();
        let mut matches = vec![None; wanted.len()];
        let mut free = vec![true; there.len()];
        let same: Rule = |(file, name), (its_file, its_name)| its_file == Some(file) && its_name == name;
        let same_file: Rule = |(file, _), (its_file, _)| its_file == Some(file);
        let same_name: Rule = |(_, name), (_, its_name)| its_name == name;
        let rules: &[Rule] = match self.how {
            How::Folder { was_joined: true } => &[same_file, same_name],
            _ => &[same, same_name],
        };
        for rule in rules {
            for (wanted, found) in wanted.iter().zip(&mut matches).filter(|(_, found)| found.is_none()) {
                let mut places = there.iter().zip(&mut free).enumerate();
                if let Some((place, (_, free))) =
                    places.find(|(_, (there, free))| **free && rule(*wanted, **there))
                {
                    *found = Some(place);
                    *free = false;
                }
            }
        }
        matches
    }

    /// What becomes of something that no file speaks of.
    fn left(&self, table: Table, id: u32, file: Option<&str>) -> Result<ProjectChange, StoreError> {
        match self.how {
            How::Folder { was_joined: true } if file.is_some() => {
                table.delete(self.connection, id)?;
                Ok(ProjectChange::Removed)
            }
            How::Folder { .. } => {
                table.set_file(self.connection, id, None)?;
                Ok(ProjectChange::Left)
            }
            How::Import => Ok(ProjectChange::Left),
        }
    }

    /// In a folder a file is called as it is; what comes from elsewhere is a wish, for what has no file yet.
    fn name(&self, table: Table, id: u32, file: &str, known: Option<&str>) -> Result<(), StoreError> {
        match self.how {
            How::Folder { .. } if known != Some(file) => table.set_file(self.connection, id, Some(file)),
            How::Import if known.is_none() && is_portable(file) => {
                table.set_file(self.connection, id, Some(file))
            }
            _ => Ok(()),
        }
    }

    fn tell(
        &mut self,
        what: ProjectPartKind,
        how: ProjectChange,
        name: &str,
        id: String,
        file: Option<String>,
        detail: Option<String>,
    ) {
        let part = ProjectPart { what, how, name: name.to_owned(), id: Some(id), file, detail };
        self.outcome.parts.push(part);
    }

    fn touch(&mut self, how: ProjectChange, touched: Touched) {
        if !matches!(how, ProjectChange::Unchanged | ProjectChange::Left) {
            self.outcome.touched.push(touched);
        }
    }
}

/// What is there and what comes fits together.
fn at_most(max: usize, there: usize, of_what: &str) -> Result<(), StoreError> {
    if there <= max {
        return Ok(());
    }
    Err(StoreError::TooMany(format!("there would be {there} {of_what}, and no more than {max} fit")))
}

/// What none of the files is.
fn left<'a, T>(all: &'a [T], matches: &[Option<usize>]) -> Vec<(usize, &'a T)> {
    all.iter().enumerate().filter(|(place, _)| !matches.contains(&Some(*place))).collect()
}
