//! `cipdeck serve`.

use std::net::SocketAddr;
use std::path::PathBuf;

use cipdeck_shared::api::{NewAllowedTarget, Role};
use clap::Args;

use super::{Exit, Logging, say};
use crate::error::RunError;
use crate::settings::{Allow, Given, HostName, Local, Settings};
use crate::{listen, shutdown, telemetry};

/// The flags of `serve`; docs/CONFIGURATION.md describes them.
#[derive(Debug, Args)]
pub(super) struct Serve {
    /// Address and port; port 0 takes a free one. Beyond loopback only once there is an administrator, and with TLS.
    /// [default: 127.0.0.1:8818]
    #[arg(long, value_name = "ADDRESS:PORT")]
    listen: Option<SocketAddr>,
    /// Folder of the database. [default: cipdeck in your folder for application data]
    #[arg(long, value_name = "DIR")]
    data: Option<PathBuf>,
    /// Folder of a project: blocks and devices as small files for version control. Without --data only they are kept
    #[arg(long, value_name = "DIR")]
    project: Option<PathBuf>,
    /// Whoever is at this machine acts as viewer, operator, engineer or admin, without signing in. Loopback only
    #[arg(long, value_name = "ROLE", value_parser = role)]
    local: Option<Role>,
    /// A target that may be reached: an address, a network or a name, with :PORT or :*, and " via 1,0" or " via *"
    #[arg(long, value_name = "TARGET")]
    allow: Vec<String>,
    /// A further name under which browsers may call: that of a tunnel, of a container's host, of this machine.
    #[arg(long = "allow-host", value_name = "NAME[:PORT]")]
    allow_hosts: Vec<HostName>,
    /// Configuration in TOML; flags override it.
    #[arg(long, value_name = "FILE")]
    config: Option<PathBuf>,
}

impl Serve {
    /// Runs until the process is asked to stop.
    pub(super) async fn execute(self, logging: Logging) -> Exit {
        let file = match self.config.as_deref().map(Given::read).transpose() {
            Ok(file) => file.unwrap_or_default(),
            Err(error) => return Exit::usage(&error),
        };
        let flags = Given {
            listen: self.listen,
            data: self.data,
            project: self.project,
            log: logging.log,
            log_format: logging.log_format,
            local: self.local.map(|role| Local { role }),
            allow: Allow { target: self.allow.into_iter().map(by_flag).collect(), write: Vec::new() },
            allow_hosts: self.allow_hosts,
            ..Given::default()
        };
        let settings = match Settings::resolve(flags, file) {
            Ok(settings) => settings,
            Err(error) => return Exit::usage(&error),
        };
        if let Err(error) = telemetry::start(&settings.log, settings.log_format) {
            return Exit::usage(&format!("the log filter {:?} cannot be used: {error}", settings.log));
        }
        match listen_and_run(settings).await {
            Ok(()) => Exit::SUCCESS,
            Err(error @ RunError::Project(_)) => Exit::usage(&error),
            Err(error) => Exit::internal(&error),
        }
    }
}

fn by_flag(target: String) -> NewAllowedTarget {
    NewAllowedTarget { target, note: "--allow".to_owned() }
}

fn role(text: &str) -> Result<Role, String> {
    let found = Role::ALL.into_iter().find(|role| role.word() == text);
    found.ok_or_else(|| "one of viewer, operator, engineer, admin".to_owned())
}

async fn listen_and_run(settings: Settings) -> Result<(), RunError> {
    let shutdown = shutdown::requested();
    let listener = listen::bind(listen::before_set_up(settings.listen)).await?;
    crate::serve(settings, listener, shutdown, |listening, setup_code| {
        // Whoever started the relay waits for what is said here.
        say(&listening.to_string());
        if let Some(code) = setup_code {
            say(&format!("set-up code: {code}"));
        }
    })
    .await
}
