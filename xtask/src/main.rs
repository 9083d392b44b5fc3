//! `cargo xtask`: builds, runs, tests and checks cipdeck; the one entry for people and for CI.

mod arch;
mod bench;
mod check;
mod dist;
mod frontend;
mod fuzz;
mod page;
mod process;
mod report;
mod run;
mod squeeze;
mod system;
mod test;
mod toolchain;
mod tools;
mod workspace;

use std::process::ExitCode;

use anyhow::Result;
use clap::{Parser, Subcommand};

use crate::{frontend::Profile, report::Report, run::Addresses, system::Consent, toolchain::Preference};

fn main() -> ExitCode {
    let mut report = Report::new();
    match Cli::parse().command.execute(&mut report) {
        Ok(()) => {
            report.succeeded();
            ExitCode::SUCCESS
        }
        Err(error) => {
            report.failed(&error);
            ExitCode::FAILURE
        }
    }
}

/// Builds, runs, tests and checks cipdeck.
#[derive(Debug, Parser)]
#[command(name = "cargo xtask", bin_name = "cargo xtask")]
struct Cli {
    #[command(subcommand)]
    command: Task,
}

#[derive(Debug, Subcommand)]
enum Task {
    /// Builds what is missing, starts a simulated device and the relay, and prints the page's address.
    Run {
        #[command(flatten)]
        addresses: Addresses,
        #[command(flatten)]
        toolchain: Preference,
    },
    /// Installs what is missing and runs all tests.
    Test {
        /// Also what takes long: fuzzing, one minute for each target.
        #[arg(long)]
        long: bool,
        #[command(flatten)]
        toolchain: Preference,
    },
    /// Measures code of controllers, our client beside others, through the relay, with 1,000 cyclic blocks, and with tags;
    /// needs Linux.
    Bench {
        /// Fewer and shorter rounds: good for a look, not for a document.
        #[arg(long)]
        quick: bool,
        /// Only tables whose name contains this: code, peers, simulated, websocket, history, cyclic, tags, plant.
        #[arg(long)]
        only: Option<String>,
        #[command(flatten)]
        consent: Consent,
    },
    /// Format, lints, layers, documentation, licences.
    Check(Preference),
    /// Leaves the release binary at target/dist/cipdeck.
    Dist(Preference),
    /// Finds or installs a compiler for wasm32-unknown-unknown.
    Toolchain(Preference),
    /// Builds the page into frontend/dist.
    Frontend {
        /// Optimised for size, as it is shipped.
        #[arg(long)]
        release: bool,
        #[command(flatten)]
        toolchain: Preference,
    },
    /// Compares the imports with the layers.
    Arch {
        /// The workspace to read, by default this one.
        root: Option<std::path::PathBuf>,
    },
}

impl Task {
    fn execute(self, report: &mut Report) -> Result<()> {
        match self {
            Self::Run { addresses, toolchain } => run::all(report, toolchain, addresses)?,
            Self::Test { long, toolchain } => test::all(report, toolchain, long)?,
            Self::Bench { quick, only, consent } => bench::all(report, quick, only, consent)?,
            Self::Check(preference) => check::all(report, preference)?,
            Self::Dist(preference) => dist::build(report, preference)?,
            Self::Toolchain(preference) => {
                toolchain::find(report, preference)?;
            }
            Self::Frontend { release, toolchain } => {
                let wasm = toolchain::find(report, toolchain)?;
                let profile = if release { Profile::Shipped } else { Profile::Quick };
                frontend::build(report, &wasm, profile)?;
            }
            Self::Arch { root } => {
                let root = root.unwrap_or_else(workspace::root);
                report.step("arch: the arrows between layers and packages", || arch::check(&root))?;
            }
        }
        Ok(())
    }
}
