//! Everything that a person types: `cipdeck serve`, and the commands that talk to a device from here.

mod audit;
mod backup;
mod check;
mod convert;
mod discover;
mod exit;
mod explain;
mod once;
mod project;
mod read_only;
mod remote;
mod report;
mod run;
mod send;
mod serve;
mod simulate;
mod tags;
mod user;
mod words;

use std::process::ExitCode;

use clap::{Args, Parser, Subcommand};

pub(crate) use self::exit::Exit;
use crate::settings::LogFormat;
use crate::telemetry;

/// The workbench for EtherNet/IP explicit messages.
#[derive(Debug, Parser)]
#[command(name = "cipdeck", version, about, max_term_width = 100, after_help = EXIT_CODES)]
struct Cli {
    #[command(flatten)]
    logging: Logging,
    #[command(flatten)]
    remote: remote::Remote,
    #[command(subcommand)]
    command: Command,
}

const EXIT_CODES: &str = "Exit: 0 success; 1 internal, cannot listen, or cannot write a capture; 2 usage or error \
                          findings; 3 the device refused (ErrorID 224); 4 everything else (timeout, refused, \
                          malformed, nobody answered)";

/// Options of every command stand below its own.
const LOG: &str = "Log";

#[derive(Clone, Debug, Args)]
struct Logging {
    /// What is logged to stderr: error, warn, info, debug, trace or target=level,… [default: info for serve, else
    /// error]
    #[arg(long, global = true, help_heading = LOG, value_name = "FILTER")]
    log: Option<String>,
    /// How it is logged. [default: text]
    #[arg(long, global = true, help_heading = LOG, value_enum)]
    log_format: Option<LogFormat>,
}

#[derive(Debug, Subcommand)]
enum Command {
    /// Serve the page and the interfaces; prints one line when it listens.
    Serve(serve::Serve),
    /// Be a small EtherNet/IP device on TCP and UDP; prints one line when it listens.
    Simulate(simulate::Simulate),
    /// Send one message to a device from here; needs no relay.
    Send(send::Send),
    /// Run a block from a file: from here, or by the relay that --relay names.
    Run(run::Run),
    /// Read tags of a controller from here; needs no relay.
    Read(tags::Read),
    /// Write a tag of a controller from here, and read it back.
    Write(tags::Write),
    /// List the tags of a controller.
    Tags(tags::List),
    /// Find devices on the network: who answers to ListIdentity.
    Discover(discover::Discover),
    /// Who did what: verify the relay's records, or go on after a break.
    Audit(audit::Audit),
    /// The users of a relay that is stopped: for the first administrator, and for a lost one.
    User(user::User),
    /// Stop all writes of a relay, or let them go on.
    ReadOnly(read_only::Switch),
    /// Copy a relay's data into one file; it may be running.
    Backup(backup::Backup),
    /// Go back to a backup.
    Restore(backup::Restore),
    /// A project: check its folder, pack it, unpack it; `serve --project` serves it.
    Project(project::Project),
    /// Check a block in a file: all findings, and the bytes that would be sent.
    Check(check::Check),
    /// Code of controllers and programs: from one language to another; losses and what is not understood on stderr.
    Convert(convert::Convert),
}

/// The process, from its arguments to its exit code.
pub fn main() -> ExitCode {
    let cli = Cli::parse();
    let runtime = match tokio::runtime::Builder::new_multi_thread().enable_all().build() {
        Ok(runtime) => runtime,
        Err(error) => return Exit::internal(&format!("cannot start: {error}")).report(),
    };
    runtime.block_on(cli.execute()).report()
}

impl Cli {
    async fn execute(self) -> Exit {
        if self.remote.is_given() && !matches!(self.command, Command::Run(_)) {
            return Exit::usage(&"--relay, --token-file and --fingerprint go with run");
        }
        if let Command::Serve(serve) = self.command {
            return serve.execute(self.logging).await;
        }
        let log = self.logging.log.as_deref().unwrap_or("error");
        if let Err(error) = telemetry::start(log, self.logging.log_format.unwrap_or_default()) {
            return Exit::usage(&format!("the log filter {log:?} cannot be used: {error}"));
        }
        match self.command {
            Command::Serve(serve) => serve.execute(self.logging).await,
            Command::Simulate(simulate) => simulate.execute().await,
            Command::Send(send) => send.execute().await,
            Command::Run(run) => run.execute(&self.remote).await,
            Command::Read(read) => read.execute().await,
            Command::Write(write) => write.execute().await,
            Command::Tags(list) => list.execute().await,
            Command::Discover(discover) => discover.execute().await,
            Command::Audit(audit) => audit.execute().await,
            Command::User(user) => user.execute().await,
            Command::ReadOnly(switch) => switch.execute(),
            Command::Backup(backup) => backup.execute(),
            Command::Restore(restore) => restore.execute(),
            Command::Project(project) => project.execute(),
            Command::Check(check) => check.execute(),
            Command::Convert(convert) => convert.execute(),
        }
    }
}

/// What somebody types, for tests of the whole relay: the exit code.
#[cfg(test)]
pub(crate) async fn act(arguments: &[&str]) -> u8 {
    let arguments = std::iter::once(&"cipdeck").chain(arguments);
    Cli::try_parse_from(arguments).expect("arguments").execute().await.code()
}

/// Prints a line on stdout. A reader that has gone away is no error of ours.
fn say(line: &str) {
    use std::io::Write;
    let mut stdout = std::io::stdout();
    let _ = writeln!(stdout, "{line}").and_then(|()| stdout.flush());
}
