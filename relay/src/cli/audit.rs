//! `cipdeck audit`: works on the files of this machine, whether a relay runs or not.

use std::path::{Path, PathBuf};
use std::time::Duration;

use clap::{Args, Subcommand};
use tokio::time::Instant;

use super::{Exit, say};
use crate::settings::{self, SettingsError};
use crate::{audit, owner};

/// How long a running relay has to take up an acceptance.
const PATIENCE: Duration = Duration::from_secs(3);

/// How often it is looked for.
const PACE: Duration = Duration::from_millis(50);

/// `cipdeck audit`
#[derive(Debug, Args)]
pub(super) struct Audit {
    #[command(subcommand)]
    command: Command,
}

#[derive(Debug, Subcommand)]
enum Command {
    /// Read the audit and compare each record with the one before: exit 0 unbroken, 1 broken.
    Verify(Verify),
    /// Let writes go on after a break that you have looked at.
    Accept(Accept),
}

#[derive(Debug, Args)]
struct Verify {
    /// Folder of the relay's data. [default: cipdeck in your folder for application data]
    #[arg(long, value_name = "DIR", conflicts_with = "file")]
    data: Option<PathBuf>,
    /// A file that was exported.
    #[arg(value_name = "FILE")]
    file: Option<PathBuf>,
}

#[derive(Debug, Args)]
struct Accept {
    /// Folder of the relay's data. [default: cipdeck in your folder for application data]
    #[arg(long, value_name = "DIR")]
    data: Option<PathBuf>,
}

impl Audit {
    /// Runs to its end.
    pub(super) async fn execute(self) -> Exit {
        match self.command {
            Command::Verify(verify) => verify.execute(),
            Command::Accept(accept) => accept.execute().await,
        }
    }
}

impl Verify {
    fn execute(self) -> Exit {
        let result = match &self.file {
            Some(file) => audit::verify_file(file).map_err(|error| (file.clone(), error)),
            None => match data(self.data) {
                Ok(folder) => {
                    audit::verify_folder(&folder).map_err(|error| (folder.join(audit::FILE), error))
                }
                Err(error) => return Exit::usage(&error),
            },
        };
        match result {
            Ok(Ok(verified)) => {
                match &verified.span {
                    Some((from, to)) => {
                        say(&format!("{} records, unbroken from {from} to {to}", verified.records));
                    }
                    None => say("0 records"),
                }
                for note in &verified.notes {
                    eprintln!("note: {note}");
                }
                Exit::SUCCESS
            }
            Ok(Err(what)) => {
                say(&format!("broken: {what}"));
                Exit::INCOMPLETE
            }
            Err((path, error)) => Exit::internal(&format!("cannot read {}: {error}", path.display())),
        }
    }
}

impl Accept {
    async fn execute(self) -> Exit {
        let folder = match data(self.data) {
            Ok(folder) => folder,
            Err(error) => return Exit::usage(&error),
        };
        match audit::accept(&folder, &account()) {
            Ok(Some(what)) => {
                owner::hand_over(&folder);
                say(&format!("accepted: {what}"));
            }
            Ok(None) => return nothing_to_accept(&folder),
            Err(error) => return Exit::internal(&error),
        }
        let deadline = Instant::now() + PATIENCE;
        while Instant::now() < deadline {
            if audit::pending(&folder) == Ok(None) {
                say("the relay has recorded it: writes go on");
                return Exit::SUCCESS;
            }
            tokio::time::sleep(PACE).await;
        }
        say("no relay has taken it up yet: it will at its next start");
        Exit::SUCCESS
    }
}

fn nothing_to_accept(folder: &Path) -> Exit {
    match audit::verify_folder(folder) {
        Ok(Ok(_)) => {
            say("the audit is unbroken: there is nothing to accept");
            Exit::SUCCESS
        }
        Ok(Err(what)) => Exit::usage(&format!(
            "the audit is broken ({what}), but no relay has found that yet: start it, so that it keeps the broken file \
             under another name, then accept"
        )),
        Err(error) => Exit::internal(&format!("cannot read the audit in {}: {error}", folder.display())),
    }
}

fn data(given: Option<PathBuf>) -> Result<PathBuf, SettingsError> {
    given.or_else(settings::default_data).ok_or(SettingsError::NoDataFolder)
}

/// The account of this machine, as far as it says.
fn account() -> String {
    let variable = |name| std::env::var(name).ok().filter(|text| !text.is_empty());
    let name = ["SUDO_USER", "USER", "LOGNAME", "USERNAME"].into_iter().find_map(variable);
    name.map_or_else(|| "local".to_owned(), |name| format!("local:{name}"))
}
