//! `cipdeck backup` and `cipdeck restore`.

use std::path::PathBuf;

use clap::Args;

use super::{Exit, say};
use crate::backup::{self, BackupError};
use crate::settings::{self, SettingsError};

/// `cipdeck backup`
#[derive(Debug, Args)]
pub(super) struct Backup {
    /// Folder of the relay's data. [default: cipdeck in your folder for application data]
    #[arg(long, value_name = "DIR")]
    data: Option<PathBuf>,
    /// Leave out the history, which may be big.
    #[arg(long)]
    without_history: bool,
    /// A new file. It holds hashes of passwords and the relay's private key: keep it as you keep these.
    #[arg(value_name = "FILE")]
    file: PathBuf,
}

/// `cipdeck restore`
#[derive(Debug, Args)]
pub(super) struct Restore {
    /// The backup.
    #[arg(value_name = "FILE")]
    file: PathBuf,
    /// A folder that is empty or not there.
    #[arg(long, value_name = "DIR")]
    data: PathBuf,
}

impl Backup {
    /// Runs to its end.
    pub(super) fn execute(self) -> Exit {
        let Some(data) = self.data.or_else(settings::default_data) else {
            return Exit::usage(&SettingsError::NoDataFolder);
        };
        match backup::make(&data, &self.file, !self.without_history) {
            Ok(bytes) => {
                say(&format!("{} has {bytes} bytes", self.file.display()));
                Exit::SUCCESS
            }
            Err(error) => exit(&error),
        }
    }
}

impl Restore {
    /// Runs to its end.
    pub(super) fn execute(self) -> Exit {
        match backup::restore(&self.file, &self.data) {
            Ok((at, version)) => {
                say(&format!("{} is as it was at {at} (cipdeck {version})", self.data.display()));
                Exit::SUCCESS
            }
            Err(error) => exit(&error),
        }
    }
}

fn exit(error: &BackupError) -> Exit {
    match error {
        BackupError::NoDatabase(_) | BackupError::Exists(_) | BackupError::Damaged(_) => Exit::usage(error),
        BackupError::Io { .. } | BackupError::Sqlite { .. } => Exit::internal(error),
    }
}
