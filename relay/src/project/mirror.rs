//! The files and the database change together: in one transaction, whose end waits for the files.

use std::collections::BTreeMap;

use cipdeck_shared::config::project::{
    self as files, PROJECT_HEAD, Project, block_path, file_name, free_file_name, group_path, is_portable,
    target_path,
};
use rusqlite::{Connection, Transaction};

use super::journal::name_of_a_change;
use super::wanted::{Wanted, in_the_order_of, stem};
use super::{FilesError, Folder, How, Outcome, Touched, group_of, merge, target_of};
use crate::draft::normalised;
use crate::store::{
    Scope, StoreError, StoredBlock, StoredGroup, StoredTarget, Table, load_project, put_change, put_head,
};

/// The folder, and which file is whose.
#[derive(Debug)]
pub(crate) struct Mirror {
    folder: Folder,
    places: BTreeMap<Touched, String>,
}

impl Mirror {
    /// The database becomes what the folder says. What only the database has is written into the folder.
    pub(crate) fn join(
        connection: &mut Connection,
        folder: Folder,
        read: &files::Read,
    ) -> Result<(Self, Outcome), StoreError> {
        let is_project = folder.files().contains_key(PROJECT_HEAD);
        let transaction = connection.transaction()?;
        let outcome = follow(&transaction, is_project, &read.project)?;
        let mut mirror = Self { folder, places: BTreeMap::new() };
        let mut wanted = Wanted::default();
        let mut head = read.project.head.clone();
        if !is_project {
            head.name = mirror.folder.name();
            wanted.files.insert(PROJECT_HEAD.to_owned(), Some(files::write_head(&head)));
        }
        put_head(&transaction, &head)?;
        mirror.find(&transaction)?;
        let stored = load_project(&transaction, Scope::All)?;
        for block in &stored.blocks {
            mirror.want_block(block, &mut wanted);
        }
        for target in &stored.targets {
            mirror.want_target(target, &mut wanted);
            for group in &target.groups {
                mirror.want_group(target, group, &mut wanted);
            }
        }
        mirror.end(transaction, wanted)?;
        Ok((mirror, outcome))
    }

    /// What [`join`](Self::join) would do.
    pub(crate) fn look(
        connection: &mut Connection,
        folder: &Folder,
        project: &Project,
    ) -> Result<Outcome, StoreError> {
        // Dropped without its end, the transaction changes nothing.
        follow(&connection.transaction()?, folder.files().contains_key(PROJECT_HEAD), project)
    }

    /// Writes the files of what was touched and ends the transaction: both, or neither.
    pub(crate) fn commit(
        &mut self,
        transaction: Transaction<'_>,
        touched: &[Touched],
    ) -> Result<(), StoreError> {
        let mut wanted = Wanted::default();
        for touched in touched {
            self.want(&transaction, *touched, &mut wanted)?;
        }
        self.end(transaction, wanted)
    }

    /// The files as they are known, without those that are none of the project's.
    pub(crate) fn files(&self) -> BTreeMap<String, String> {
        let known =
            self.folder.files().iter().filter(|(path, _)| *path == PROJECT_HEAD || path.contains('/'));
        known.map(|(path, text)| (path.clone(), text.clone())).collect()
    }

    /// Whose the files of the folder are.
    fn find(&mut self, transaction: &Transaction<'_>) -> Result<(), StoreError> {
        let mut places = Vec::new();
        for target in load_project(transaction, Scope::All)?.targets {
            let Some(file) = &target.file else { continue };
            places.push((Touched::Device(target.device.id), target_path(file)));
            for group in &target.groups {
                let path = group.file.as_ref().map(|name| group_path(file, name));
                places.extend(path.map(|path| (Touched::Group(group.group.id), path)));
            }
        }
        for block in load_project(transaction, Scope::All)?.blocks {
            let path = block.file.as_deref().map(block_path);
            places.extend(path.map(|path| (Touched::Block(block.block.id), path)));
        }
        let known = self.folder.files();
        self.places = places.into_iter().filter(|(_, path)| known.contains_key(path)).collect();
        Ok(())
    }

    fn end(&mut self, transaction: Transaction<'_>, wanted: Wanted) -> Result<(), StoreError> {
        for (touched, path) in &wanted.places {
            let Some(name) = path.as_deref().and_then(stem) else { continue };
            match touched {
                Touched::Block(id) => Table::Block.set_file(&transaction, id.0, Some(name))?,
                Touched::Device(id) => Table::Device.set_file(&transaction, id.0, Some(name))?,
                Touched::Group(id) => Table::Group.set_file(&transaction, id.0, Some(name))?,
            }
        }
        let change = name_of_a_change()?;
        if wanted.files.len() > 1 {
            put_change(&transaction, &change)?;
        }
        let undo = self.folder.apply(&wanted.files, &change).map_err(StoreError::Files)?;
        if let Err(error) = transaction.commit() {
            self.folder.undo(undo);
            return Err(error.into());
        }
        self.folder.done();
        self.folder.adopt(wanted.files);
        for (touched, path) in wanted.places {
            match path {
                Some(path) => drop(self.places.insert(touched, path)),
                None => drop(self.places.remove(&touched)),
            }
        }
        Ok(())
    }

    fn want(
        &self,
        transaction: &Transaction<'_>,
        touched: Touched,
        wanted: &mut Wanted,
    ) -> Result<(), StoreError> {
        let scope = match touched {
            Touched::Block(id) => Scope::Block(id),
            Touched::Device(id) => Scope::Device(id),
            Touched::Group(id) => Scope::Group(id),
        };
        let stored = load_project(transaction, scope)?;
        match (touched, stored.blocks.first(), stored.targets.first()) {
            (Touched::Block(_), Some(block), _) => self.want_block(block, wanted),
            (Touched::Device(_), _, Some(target)) => {
                self.want_target(target, wanted);
                let is_new =
                    |group: &&StoredGroup| self.place(Touched::Group(group.group.id), wanted).is_none();
                let new: Vec<_> = target.groups.iter().filter(is_new).collect();
                for group in new {
                    self.want_group(target, group, wanted);
                }
            }
            (Touched::Group(_), _, Some(target)) if !target.groups.is_empty() => {
                for group in &target.groups {
                    self.want_group(target, group, wanted);
                }
            }
            _ => self.want_gone(touched, wanted),
        }
        Ok(())
    }

    fn want_block(&self, stored: &StoredBlock, wanted: &mut Wanted) {
        let (config, key) = (&stored.block.config, Touched::Block(stored.block.id));
        let old = self.place(key, wanted);
        let known = old.as_deref().and_then(|path| self.known(path));
        let before = known.and_then(|text| files::block("", text).ok()).map(normalised);
        let name_before = before.as_ref().map(|block| block.name().to_owned());
        let path =
            self.path(old.as_ref(), name_before, stored.file.as_deref(), config.name(), &block_path, wanted);
        let is_same = before.as_ref() == Some(config);
        wanted.put(key, old, path, (!is_same).then(|| files::write_block(config)), known);
    }

    fn want_target(&self, stored: &StoredTarget, wanted: &mut Wanted) {
        let (target, key) = (target_of(stored), Touched::Device(stored.device.id));
        let old = self.place(key, wanted);
        let known = old.as_deref().and_then(|path| self.known(path));
        let before = known.and_then(|text| files::target("", text).ok());
        let name_before = before.as_ref().map(|target| target.config.name.clone());
        let name = target.config.name.clone();
        let path = self.path(old.as_ref(), name_before, stored.file.as_deref(), &name, &target_path, wanted);
        if let (Some(old), Some(folder)) = (&old, stem(&path))
            && *old != path
        {
            self.move_groups(old, folder, wanted);
        }
        let is_same = before.as_ref() == Some(&target);
        wanted.put(key, old, path, (!is_same).then(|| files::write_target(&target)), known);
    }

    /// A target has another name: its groups are in another folder.
    fn move_groups(&self, old: &str, folder: &str, wanted: &mut Wanted) {
        let Some(before) = stem(old) else { return };
        let before = group_path(before, "");
        let before = before.trim_end_matches(".json");
        for (key, path) in &self.places {
            if let Some(name) = path.strip_prefix(before).and_then(|name| name.strip_suffix(".json")) {
                let (path, text) = (path.clone(), self.known(path).map(str::to_owned));
                wanted.files.insert(path, None);
                wanted.files.insert(group_path(folder, name), text);
                wanted.places.insert(*key, Some(group_path(folder, name)));
            }
        }
    }

    fn want_group(&self, target: &StoredTarget, stored: &StoredGroup, wanted: &mut Wanted) {
        let (mut group, key) = (group_of(stored), Touched::Group(stored.group.id));
        let Some(target_path) = self.place(Touched::Device(target.device.id), wanted) else { return };
        let folder = stem(&target_path).unwrap_or_default().to_owned();
        let old = self.place(key, wanted);
        let known = old.as_deref().and_then(|path| self.text(path, wanted));
        let known = known.as_deref();
        let before = known.and_then(|text| files::group("", text).ok());
        if let Some(before) = &before {
            in_the_order_of(before, &mut group);
        }
        let name_before = before.as_ref().map(|group| group.name.clone());
        let in_folder = |name: &str| group_path(&folder, name);
        let path =
            self.path(old.as_ref(), name_before, stored.file.as_deref(), &group.name, &in_folder, wanted);
        let is_same = before.as_ref() == Some(&group);
        wanted.put(key, old, path, (!is_same).then(|| files::write_group(&group)), known);
    }

    fn want_gone(&self, touched: Touched, wanted: &mut Wanted) {
        let Some(path) = self.place(touched, wanted) else { return };
        if let (Touched::Device(_), Some(name)) = (touched, stem(&path)) {
            let folder = group_path(name, "");
            let folder = folder.trim_end_matches(".json");
            for (key, path) in self.places.iter().filter(|(_, path)| path.starts_with(folder)) {
                wanted.files.insert(path.clone(), None);
                wanted.places.insert(*key, None);
            }
        }
        wanted.files.insert(path, None);
        wanted.places.insert(touched, None);
    }

    /// Where the file is, or will be.
    fn place(&self, key: Touched, wanted: &Wanted) -> Option<String> {
        wanted.places.get(&key).cloned().unwrap_or_else(|| self.places.get(&key).cloned())
    }

    fn known(&self, path: &str) -> Option<&str> {
        self.folder.files().get(path).map(String::as_str)
    }

    fn text(&self, path: &str, wanted: &Wanted) -> Option<String> {
        let wanted = wanted.files.get(path).cloned();
        wanted.unwrap_or_else(|| self.known(path).map(str::to_owned))
    }

    /// Where the file belongs: where it is, unless people call the thing something else now.
    fn path(
        &self,
        old: Option<&String>,
        name_before: Option<String>,
        stored: Option<&str>,
        name: &str,
        path: &dyn Fn(&str) -> String,
        wanted: &Wanted,
    ) -> String {
        let is_taken = |file: &str| {
            let path = path(file);
            let wanted = wanted.files.iter().filter(|(_, text)| text.is_some()).map(|(path, _)| path);
            self.folder.files().keys().chain(wanted).any(|there| there.eq_ignore_ascii_case(&path))
        };
        match (old, stored) {
            (Some(old), _) if name_before.is_none_or(|before| file_name(&before) == file_name(name)) => {
                old.clone()
            }
            (None, Some(file)) if is_portable(file) && !is_taken(file) => path(file),
            _ => path(&free_file_name(name, is_taken)),
        }
    }
}

/// What is stored becomes what the folder says.
fn follow(transaction: &Transaction<'_>, is_project: bool, project: &Project) -> Result<Outcome, StoreError> {
    let was_joined = load_project(transaction, Scope::All)?.head.is_some();
    if was_joined && !is_project {
        return Err(StoreError::Files(FilesError::NotTheProject));
    }
    merge(transaction, project, How::Folder { was_joined })
}
