//! `cipdeck check`.

use std::path::PathBuf;

use cipdeck_shared::config::{write_hex, write_words};
use cipdeck_shared::plan::MessagePlan;
use clap::Args;

use super::report::{self, checked};
use super::{Exit, run, say};

/// A block from a file.
#[derive(Debug, Args)]
pub(super) struct Check {
    /// A block as JSON, as the page copies it; - = stdin
    #[arg(value_name = "BLOCK.json")]
    file: PathBuf,
    /// For machines: {"findings":[…],"request":"HEX"}
    #[arg(long)]
    json: bool,
}

impl Check {
    /// Checks and prints.
    pub(super) fn execute(self) -> Exit {
        let config = match run::read(&self.file) {
            Ok(config) => config,
            Err(exit) => return exit,
        };
        let (plan, findings) = MessagePlan::check(&config);
        if self.json {
            say(&checked(plan.as_ref(), &findings));
        } else {
            report::findings(&findings);
            if let Some(plan) = &plan {
                say(&format!("{} is ready to be sent: {}", config.name(), write_hex(plan.bytes())));
                if let Some(words) = plan.words() {
                    let data = write_words(&words.words);
                    say(&format!("  Data_to_Send {data}, {} bytes of it", words.length));
                }
            }
        }
        if plan.is_some() { Exit::SUCCESS } else { Exit::FINDINGS }
    }
}
