//! `cipdeck run`.

use std::path::{Path, PathBuf};

use cipdeck_shared::config::{BlockConfig, project};
use clap::Args;

use super::Exit;
use super::once::{Mode, execute};
use super::remote::Remote;

/// A block from a file.
#[derive(Debug, Args)]
pub(super) struct Run {
    /// A block as JSON, as the page copies it; - = stdin
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
    let name = file.display().to_string();
    let text = if file.as_os_str() == "-" {
        std::io::read_to_string(std::io::stdin())
    } else {
        std::fs::read_to_string(file)
    };
    let text = text.map_err(|error| Exit::usage(&format!("cannot read {name}: {error}")))?;
    project::block(&name, &text).map_err(|errors| {
        let lines: Vec<_> = errors.iter().map(ToString::to_string).collect();
        Exit::usage(&format!("{name} is not a block:\n{}", lines.join("\n")))
    })
}
