//! `cipdeck tags`.

use clap::Args;

use super::Place;
use crate::cli::Exit;

/// The tags of a controller.
#[derive(Debug, Args)]
pub(in crate::cli) struct List {
    #[command(flatten)]
    place: Place,
}

impl List {
    /// Lists and prints.
    pub(in crate::cli) async fn execute(self) -> Exit {
        Exit::usage(&format!("{} cannot be listed yet", self.place.path))
    }
}
