//! Everything that a person types: `cipdeck serve`, and the commands that talk to a device from here.

mod exit;
mod serve;

use std::process::ExitCode;

use clap::{Parser, Subcommand};

pub(crate) use self::exit::Exit;

/// The workbench for EtherNet/IP explicit messages.
#[derive(Debug, Parser)]
#[command(name = "cipdeck", version, about, max_term_width = 100)]
struct Cli {
    #[command(subcommand)]
    command: Command,
}

#[derive(Debug, Subcommand)]
enum Command {
    /// Serve the page and the interfaces; prints one line when it listens.
    Serve(serve::Serve),
}

/// The process, from its arguments to its exit code.
pub fn main() -> ExitCode {
    let cli = Cli::parse();
    let runtime = match tokio::runtime::Builder::new_multi_thread().enable_all().build() {
        Ok(runtime) => runtime,
        Err(error) => return Exit::internal(&format!("cannot start: {error}")).report(),
    };
    let exit = runtime.block_on(async {
        match cli.command {
            Command::Serve(serve) => serve.execute().await,
        }
    });
    exit.report()
}
