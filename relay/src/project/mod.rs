//! A project: a folder of small files that people keep in version control, beside the database or instead of it.
//!
//! At the start the folder is the truth. From then on every change is written into its file before anybody is told that
//! it was stored; a file that somebody else has changed meanwhile is never overwritten. Whoever has changed files lets the
//! folder be read again: then it is the truth once more.

mod archive;
mod check;
mod difference;
mod error;
mod folder;
mod import;
mod journal;
mod merge;
mod mirror;
mod outcome;
mod snapshot;
mod variables;
mod walk;
mod wanted;

pub(crate) use self::archive::{ArchiveError, MAX_ARCHIVE, pack, unpack};
pub(crate) use self::check::{FILE_RULE, Looked, findings, found};
pub(crate) use self::error::FilesError;
pub(crate) use self::folder::Folder;
pub(crate) use self::import::{Wish, import, reread};
pub(crate) use self::merge::{How, merge};
pub(crate) use self::mirror::Mirror;
pub(crate) use self::outcome::{Outcome, Touched};
pub(crate) use self::snapshot::{group_of, project_of, target_of};

#[cfg(test)]
mod tests;
