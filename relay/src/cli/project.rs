//! `cipdeck project`: the folder of a project, without a relay.

use std::io::{IsTerminal, Write};
use std::path::{Path, PathBuf};

use cipdeck_shared::api::Finding;
use cipdeck_shared::plan::Severity;
use clap::{Args, Subcommand};
use serde_json::json;

use super::{Exit, say};
use crate::project::{self, Folder, Looked};

/// What to do with a project.
#[derive(Debug, Args)]
pub(super) struct Project {
    #[command(subcommand)]
    action: Action,
}

#[derive(Debug, Subcommand)]
enum Action {
    /// Everything that is wrong with a project, each finding with file, line and column.
    Check {
        /// The folder
        #[arg(value_name = "DIR")]
        folder: PathBuf,
        /// For machines: {"findings":[…]}
        #[arg(long)]
        json: bool,
    },
    /// A folder as an archive, on standard output: pack DIR > plant.zip
    Pack {
        /// The folder
        #[arg(value_name = "DIR")]
        folder: PathBuf,
    },
    /// An archive as a folder, which has to be empty or not there.
    Unpack {
        /// The archive
        #[arg(value_name = "FILE.zip")]
        archive: PathBuf,
        /// The folder
        #[arg(value_name = "DIR")]
        folder: PathBuf,
    },
}

impl Project {
    /// Does it.
    pub(super) fn execute(self) -> Exit {
        let done = match &self.action {
            Action::Check { folder, json } => check(folder, *json),
            Action::Pack { folder } => pack(folder),
            Action::Unpack { archive, folder } => unpack(archive, folder),
        };
        done.unwrap_or_else(|exit| exit)
    }
}

fn check(folder: &Path, json: bool) -> Result<Exit, Exit> {
    let Looked { read, findings, .. } = Looked::at(folder).map_err(|error| Exit::usage(&error))?;
    let errors = findings.iter().filter(|finding| finding.severity == Severity::Error).count();
    if json {
        say(&json!({ "findings": findings }).to_string());
    } else {
        for finding in &findings {
            say(&line(finding));
        }
        let groups: usize = read.project.targets.values().map(|target| target.groups.len()).sum();
        let (blocks, targets) = (read.project.blocks.len(), read.project.targets.len());
        let counts = [(blocks, "block"), (targets, "target"), (groups, "group")];
        let counts = counts.map(|(count, what)| counted(count, what)).join(", ");
        say(&format!("{counts}: {}", counted(errors, "error")));
    }
    Ok(if errors == 0 { Exit::SUCCESS } else { Exit::FINDINGS })
}

fn pack(folder: &Path) -> Result<Exit, Exit> {
    let folder = Folder::read(folder).map_err(|error| Exit::usage(&error))?;
    let (read, findings) = project::found(folder.files());
    wrong(&findings)?;
    let files = cipdeck_shared::config::project::files(&read.project);
    let packed = project::pack(&files).map_err(|error| Exit::internal(&error))?;
    let mut output = std::io::stdout().lock();
    if output.is_terminal() {
        return Err(Exit::usage(&"an archive is nothing to look at: cipdeck project pack DIR > plant.zip"));
    }
    output.write_all(&packed).and_then(|()| output.flush()).map_err(|error| Exit::internal(&error))?;
    Ok(Exit::SUCCESS)
}

fn unpack(archive: &Path, folder: &Path) -> Result<Exit, Exit> {
    let unreadable = |error| Exit::usage(&format!("cannot read {}: {error}", archive.display()));
    let bytes = std::fs::read(archive).map_err(unreadable)?;
    let (files, ignored) = project::unpack(&bytes).map_err(|error| Exit::usage(&error))?;
    let (read, findings) = project::found(&files);
    wrong(&findings)?;
    for file in ignored.iter().chain(&read.ignored) {
        eprintln!("cipdeck: {file} is no file of a project, and is left out");
    }
    let files = cipdeck_shared::config::project::files(&read.project);
    Folder::open(folder).and_then(|folder| folder.fill(files)).map_err(|error| Exit::usage(&error))?;
    Ok(Exit::SUCCESS)
}

/// What cannot be read is neither packed nor unpacked; wrong numbers can be.
fn wrong(findings: &[Finding]) -> Result<(), Exit> {
    for finding in findings {
        eprintln!("{}", line(finding));
    }
    let is_unreadable =
        |finding: &Finding| finding.severity == Severity::Error && finding.rule == project::FILE_RULE;
    if findings.iter().any(is_unreadable) { Err(Exit::FINDINGS) } else { Ok(()) }
}

/// `1 block`, `2 blocks`
fn counted(count: usize, what: &str) -> String {
    format!("{count} {what}{}", if count == 1 { "" } else { "s" })
}

fn line(finding: &Finding) -> String {
    let severity = match finding.severity {
        Severity::Error => "error",
        Severity::Warning => "warning",
        Severity::Note => "note",
    };
    format!("{severity}: {}: {}", finding.field, finding.message)
}
