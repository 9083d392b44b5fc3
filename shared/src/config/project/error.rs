//! What can be wrong with the files of a project.

use alloc::string::String;
use core::fmt;

use super::place::Position;
use super::{MAX_PROJECT_BYTES, MAX_PROJECT_FILE, MAX_PROJECT_FILES, PROJECT_VERSION};

/// Something that is wrong, and where.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct ProjectError {
    /// The path of the file in the project, as it was given.
    pub file: String,
    /// Where in the file, if it is about a place in it.
    pub position: Option<Position>,
    /// What.
    pub what: ProjectErrorKind,
}

/// `blocks/drive.json:4:13: invalid type: …`
impl fmt::Display for ProjectError {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self.position {
            Some(Position { line, column }) => write!(f, "{}:{line}:{column}: {}", self.file, self.what),
            None => write!(f, "{}: {}", self.file, self.what),
        }
    }
}

impl core::error::Error for ProjectError {}

/// What is wrong.
#[derive(Clone, Debug, PartialEq, Eq, thiserror::Error)]
pub enum ProjectErrorKind {
    /// Not JSON.
    #[error("this is not JSON: {0}")]
    Json(String),
    /// JSON, but not the one that belongs here.
    #[error("{0}")]
    Content(String),
    /// The same member twice: one of them would be lost.
    #[error("the member `{0}` is there twice")]
    Twice(String),
    /// A number that would come back as another one.
    #[error("the number {0} is too big to be kept exactly; put it into quotes")]
    Inexact(String),
    /// `cipdeck.json` says no version.
    #[error(
        "the member `project`, the version of the layout, has to be a whole number from 1: \"project\": 1"
    )]
    NoVersion,
    /// A newer cipdeck has written it.
    #[error("the project has version {0}, this cipdeck knows {PROJECT_VERSION}: use a newer cipdeck")]
    TooNew(u64),
    /// A path that leaves the project, or that no file system has.
    #[error("this is no path inside of a project: names separated by /, without . and .., \\ and :")]
    Path,
    /// A file where none belongs.
    #[error("there is nothing like that in a project: {0}")]
    Misplaced(&'static str),
    /// A group of a device that is not there.
    #[error("this is a group of the target `{0}`, and there is no targets/{0}.json")]
    NoTarget(String),
    /// A variable whose parent is not in the same group.
    #[error("no variable of this group has the address `{0}`")]
    NoParent(String),
    /// A variable that is a part of itself.
    #[error("this variable is a part of itself, or of more than 16 others")]
    ParentLoop,
    /// Two files that many file systems cannot tell apart.
    #[error("many file systems cannot tell this name from {0}: rename one of them")]
    SameFile(String),
    /// Two things with one name.
    #[error("{0} has the same name; they can be told apart by their files alone")]
    SameName(String),
    /// A member that does nothing.
    #[error("this version does not know the member `{0}`: it is kept, and does nothing")]
    Unknown(String),
    /// A member that is not kept.
    #[error("the member `{0}` is given by the relay: it is not kept in a project")]
    Given(&'static str),
    /// What is not told one by one.
    #[error("and {0} more in this file")]
    More(usize),
    /// A link: what it leads to is not a part of the project.
    #[error("this is a link, and a project has none: put the file itself here")]
    Link,
    /// Not UTF-8.
    #[error("this is not UTF-8")]
    Encoding,
    /// The system says no.
    #[error("this cannot be read: {0}")]
    Unreadable(String),
    /// Too many files.
    #[error("a project has at most {MAX_PROJECT_FILES} files")]
    TooManyFiles,
    /// Too long a file.
    #[error("a file of a project has at most {MAX_PROJECT_FILE} bytes")]
    FileTooLong,
    /// Too much altogether.
    #[error("the files of a project have at most {MAX_PROJECT_BYTES} bytes together")]
    TooLong,
}
