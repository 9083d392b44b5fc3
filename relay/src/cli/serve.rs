//! `cipdeck serve`.

use std::io::Write;
use std::net::SocketAddr;
use std::path::PathBuf;

use clap::Args;
use tokio::net::TcpListener;

use super::Exit;
use crate::error::RunError;
use crate::settings::{Given, LogFormat, Settings};
use crate::{shutdown, telemetry};

/// The flags of `serve`; docs/CONFIGURATION.md describes them.
#[derive(Debug, Args)]
pub(super) struct Serve {
    /// Loopback address and port; port 0 takes a free one. [default: 127.0.0.1:8818]
    #[arg(long, value_name = "ADDRESS:PORT")]
    listen: Option<SocketAddr>,
    /// Folder of the database. [default: cipdeck in your folder for application data]
    #[arg(long, value_name = "DIR")]
    data: Option<PathBuf>,
    /// Configuration in TOML; flags override it.
    #[arg(long, value_name = "FILE")]
    config: Option<PathBuf>,
    /// What is logged to stderr: error, warn, info, debug, trace or target=level,… [default: info]
    #[arg(long, value_name = "FILTER")]
    log: Option<String>,
    /// How it is logged. [default: text]
    #[arg(long, value_enum)]
    log_format: Option<LogFormat>,
}

impl Serve {
    /// Runs until the process is asked to stop.
    pub(super) async fn execute(self) -> Exit {
        let file = match self.config.as_deref().map(Given::read).transpose() {
            Ok(file) => file.unwrap_or_default(),
            Err(error) => return Exit::usage(&error),
        };
        let flags =
            Given { listen: self.listen, data: self.data, log: self.log, log_format: self.log_format };
        let settings = match Settings::resolve(flags, file) {
            Ok(settings) => settings,
            Err(error) => return Exit::usage(&error),
        };
        if let Err(error) = telemetry::start(&settings.log, settings.log_format) {
            return Exit::usage(&format!("the log filter {:?} cannot be used: {error}", settings.log));
        }
        match listen_and_run(settings).await {
            Ok(()) => Exit::SUCCESS,
            Err(error) => Exit::internal(&error),
        }
    }
}

async fn listen_and_run(settings: Settings) -> Result<(), RunError> {
    if !settings.listen.ip().is_loopback() {
        // Before binding: not even for a moment is there an open port.
        return Err(RunError::NotLoopback(settings.listen));
    }
    let listener =
        TcpListener::bind(settings.listen).await.map_err(|source| RunError::Bind(settings.listen, source))?;
    let address = listener.local_addr().map_err(RunError::Listen)?;
    crate::serve(settings, listener, shutdown::requested(), || announce(address)).await
}

/// The one line on stdout: whoever started the relay waits for it.
fn announce(address: SocketAddr) {
    let mut stdout = std::io::stdout();
    // A closed stdout is the reader's decision and no reason to stop.
    let _ = writeln!(stdout, "cipdeck listens on http://{address}").and_then(|()| stdout.flush());
}
