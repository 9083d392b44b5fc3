//! `cipdeck read-only`: the switch that stops all writes, from the relay's machine. Only here it is turned off.

use std::path::PathBuf;

use clap::{Args, ValueEnum};

use super::{Exit, say};
use crate::owner;
use crate::permit::ReadOnly;
use crate::settings::{self, SettingsError};

/// `cipdeck read-only`
#[derive(Debug, Args)]
pub(super) struct Switch {
    /// What to do.
    #[arg(value_enum)]
    turn: Turn,
    /// Folder of the relay's data. [default: cipdeck in your folder for application data]
    #[arg(long, value_name = "DIR")]
    data: Option<PathBuf>,
}

#[derive(Clone, Copy, Debug, ValueEnum)]
enum Turn {
    /// Stop all writes, at once.
    On,
    /// Let writes go on, as far as they are allowed.
    Off,
    /// Say how it is.
    State,
}

impl Switch {
    /// Runs to its end. A running relay looks at the switch before each message.
    pub(super) fn execute(self) -> Exit {
        let Some(data) = self.data.or_else(settings::default_data) else {
            return Exit::usage(&SettingsError::NoDataFolder);
        };
        if !data.is_dir() {
            return Exit::usage(&format!("there is no folder {}: name it with --data", data.display()));
        }
        let switch = ReadOnly::of(Some(&data));
        let turned = match self.turn {
            Turn::On => switch.turn_on(),
            Turn::Off => switch.turn_off(),
            Turn::State => Ok(()),
        };
        if let Err(error) = turned {
            return Exit::internal(&format!("cannot turn the switch in {}: {error}", data.display()));
        }
        owner::hand_over(&data);
        say(if switch.is_on() { "read-only: on, nothing is written to a device" } else { "read-only: off" });
        Exit::SUCCESS
    }
}
