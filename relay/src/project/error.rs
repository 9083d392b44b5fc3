//! Why the files of a project could not be written, or not be read.

use cipdeck_shared::config::project::ProjectError;

/// What is wrong with the folder of a project.
#[derive(Debug, thiserror::Error)]
pub(crate) enum FilesError {
    /// Somebody else was there.
    #[error(
        "{file} {how} since the relay has read it, and nothing was stored. To go on with the folder as it is, let the relay \
         read it again: on the page \"Project files\", or with POST /api/v1/project/folder; otherwise put the file back \
         (git checkout -- {file}) and try again"
    )]
    Conflict {
        /// Which file.
        file: String,
        /// What has happened to it.
        how: &'static str,
    },
    /// The system says no.
    #[error("{file} in the project's folder cannot be written, and nothing was stored: {source}")]
    Write {
        /// Which file.
        file: String,
        /// Why.
        source: std::io::Error,
    },
    /// The relay has ended in the middle of a change, or a relay is in the middle of it.
    #[error(
        "a change of several files is under way in this folder, or was interrupted (.cipdeck-change.json says which): \
         cipdeck serve --project with the same --data puts it right when it starts"
    )]
    Unfinished,
    /// What is left of a change that was interrupted cannot be taken back.
    #[error(
        "a change of several files was interrupted, and somebody has changed {file} since: put the files in order yourself \
         (git status shows them), then remove .cipdeck-change.json"
    )]
    Torn {
        /// Which file.
        file: String,
    },
    /// What tells of such a change cannot be used.
    #[error(
        "{file} tells of a change that was interrupted, and cannot be used: {source}. Put the files in order yourself \
         (git status shows them), then remove it"
    )]
    Journal {
        /// Which file.
        file: String,
        /// Why.
        source: std::io::Error,
    },
    /// Files that cannot be read, all of them.
    #[error("the project cannot be read:\n{}", lines(.0))]
    Wrong(Vec<ProjectError>),
    /// Something is there already.
    #[error("{0} has a project already: give a folder that is empty or not there")]
    NotEmpty(String),
    /// The folder cannot be read.
    #[error("cannot read {0}: {1}")]
    Unreadable(String, #[source] std::io::Error),
    /// The database knows a project, and the folder is none.
    #[error(
        "there is no cipdeck.json in this folder, and the data folder belongs to a project: is it the right folder? To make \
         a new project, give another data folder with --data, or export the old one and import it there"
    )]
    NotTheProject,
}

fn lines(errors: &[ProjectError]) -> String {
    let lines: Vec<_> = errors.iter().map(ToString::to_string).collect();
    lines.join("\n")
}
