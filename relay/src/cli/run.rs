//! `cipdeck run`.

use std::path::{Path, PathBuf};

use cipdeck_shared::config::BlockConfig;
use clap::Args;

use super::Exit;
use super::once::{Mode, execute};
use super::remote::Remote;
use crate::draft::Draft;

/// A block from a file.
#[derive(Debug, Args)]
pub(super) struct Run {
    /// A block as JSON, as the page copies it
    #[arg(value_name = "BLOCK.json")]
    file: PathBuf,
    #[command(flatten)]
    mode: Mode,
}

impl Run {
    /// Runs and prints.
    pub(super) async fn execute(self, remote: &Remote) -> Exit {
        match read(&self.file) {
            Ok(config) if remote.is_given() => remote.run(&config, &self.mode).await,
            Ok(config) => execute(&config, &self.mode).await,
            Err(exit) => exit,
        }
    }
}

/// Reads a block; its id and revision do not matter here.
pub(super) fn read(file: &Path) -> Result<BlockConfig, Exit> {
    let name = file.display();
    let text = std::fs::read(file).map_err(|error| Exit::usage(&format!("cannot read {name}: {error}")))?;
    let draft: Draft = serde_json::from_slice(&text)
        .map_err(|error| Exit::usage(&format!("{name} is not a block: {error}")))?;
    Ok(draft.config)
}
