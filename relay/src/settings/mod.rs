//! What can be configured, from a TOML file and from flags; a flag overrides the file. docs/CONFIGURATION.md
//! describes every key.

mod access;
mod history;
mod host_name;
mod limits;
mod tls;

use std::net::{Ipv4Addr, SocketAddr};
use std::path::{Path, PathBuf};

use cipdeck_shared::api::{NewAllowedTarget, Role};
use serde::Deserialize;

pub use self::access::{Allow, Local};
pub use self::history::HistorySettings;
pub use self::host_name::{HostName, NoHostName};
pub use self::limits::Limits;
pub use self::tls::Tls;

/// Where the relay listens unless told otherwise.
pub const DEFAULT_LISTEN: SocketAddr = SocketAddr::new(std::net::IpAddr::V4(Ipv4Addr::LOCALHOST), 8818);

/// What is logged unless told otherwise.
const DEFAULT_LOG: &str = "info";

/// Name of the database in the data folder.
const DATABASE: &str = "cipdeck.sqlite";

/// Everything that can be configured.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Settings {
    /// Where to listen; beyond loopback only once there is an administrator, and with TLS.
    pub listen: SocketAddr,
    /// The folder of the database; `None` keeps blocks in memory and loses them at the end.
    pub data: Option<PathBuf>,
    /// The folder of the project: blocks and devices as files; `None` = there is none.
    pub project: Option<PathBuf>,
    /// Which log records are written: a level, or `target=level` separated by commas.
    pub log: String,
    /// How log records are written.
    pub log_format: LogFormat,
    /// What is kept of runs.
    pub history: HistorySettings,
    /// Whoever is at this machine acts with this role, without signing in; `None` = people sign in.
    pub local: Option<Role>,
    /// What may be reached and written beside what administrators add.
    pub allow: Allow,
    /// Further names under which the relay may be called.
    pub allow_hosts: Vec<HostName>,
    /// The certificate; `None` = one that the relay makes, where it needs one.
    pub tls: Option<Tls>,
    /// How much there may be of what others can ask for.
    pub limits: Limits,
}

/// How log records are written to stderr.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Deserialize, clap::ValueEnum)]
#[serde(rename_all = "lowercase")]
pub enum LogFormat {
    /// Lines for people.
    #[default]
    Text,
    /// One JSON object a line.
    Json,
}

/// The keys of the file, and the flags: both may leave out everything.
#[derive(Clone, Debug, Default, PartialEq, Eq, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Given {
    /// `listen = "127.0.0.1:8818"`
    pub listen: Option<SocketAddr>,
    /// `data = "/var/lib/cipdeck"`
    pub data: Option<PathBuf>,
    /// `project = "/srv/plant"`
    pub project: Option<PathBuf>,
    /// `log = "info,cipdeck_relay=debug"`
    pub log: Option<String>,
    /// `log_format = "json"`
    pub log_format: Option<LogFormat>,
    /// `[history]`
    pub history: Option<HistorySettings>,
    /// `[local]`
    pub local: Option<Local>,
    /// `[[allow.target]]` and `[[allow.write]]`
    #[serde(default)]
    pub allow: Allow,
    /// `allow_hosts = ["gateway.plant.local"]`
    #[serde(default)]
    pub allow_hosts: Vec<HostName>,
    /// `[tls]`
    pub tls: Option<Tls>,
    /// `[limits]`
    #[serde(default)]
    pub limits: Limits,
}

impl Settings {
    /// Blocks live in memory only.
    pub fn in_memory() -> Self {
        Self {
            listen: DEFAULT_LISTEN,
            data: None,
            project: None,
            log: DEFAULT_LOG.to_owned(),
            log_format: LogFormat::default(),
            history: HistorySettings::default(),
            local: None,
            allow: Allow::default(),
            allow_hosts: Vec::new(),
            tls: None,
            limits: Limits::default(),
        }
    }

    /// Blocks live in a database in this folder.
    pub fn stored_in(folder: impl Into<PathBuf>) -> Self {
        Self { data: Some(folder.into()), ..Self::in_memory() }
    }

    /// Whoever is at this machine acts with this role, without signing in.
    #[must_use]
    pub fn with_local(self, role: Role) -> Self {
        Self { local: Some(role), ..self }
    }

    /// One more target that may be reached; see docs/CONFIGURATION.md.
    #[must_use]
    pub fn allowing(mut self, target: impl Into<String>) -> Self {
        self.allow.target.push(NewAllowedTarget { target: target.into(), note: String::new() });
        self
    }

    /// What the flags say, then what the file says, then the defaults.
    pub fn resolve(flags: Given, file: Given) -> Result<Self, SettingsError> {
        let (data, project) = (flags.data.or(file.data), flags.project.or(file.project));
        // A project needs no database: its files are what is kept.
        let data = match (data, &project) {
            (None, None) => Some(default_data().ok_or(SettingsError::NoDataFolder)?),
            (data, _) => data,
        };
        Ok(Self {
            listen: flags.listen.or(file.listen).unwrap_or(DEFAULT_LISTEN),
            data,
            project,
            log: flags.log.or(file.log).unwrap_or_else(|| DEFAULT_LOG.to_owned()),
            log_format: flags.log_format.or(file.log_format).unwrap_or_default(),
            history: flags.history.or(file.history).unwrap_or_default().checked()?,
            local: flags.local.or(file.local).map(|local| local.role),
            allow: Allow {
                target: [flags.allow.target, file.allow.target].concat(),
                write: [flags.allow.write, file.allow.write].concat(),
            },
            allow_hosts: [flags.allow_hosts, file.allow_hosts].concat(),
            tls: file.tls.map(Tls::checked).transpose()?,
            limits: file.limits.checked()?,
        })
    }

    /// The database file.
    pub(crate) fn database(&self) -> Option<PathBuf> {
        self.data.as_ref().map(|folder| folder.join(DATABASE))
    }
}

impl Given {
    /// Reads a file. An unknown key is an error that names it.
    pub fn read(path: &Path) -> Result<Self, SettingsError> {
        let text = std::fs::read_to_string(path)
            .map_err(|source| SettingsError::Unreadable { path: path.to_owned(), source })?;
        Self::parse(&text)
            .map_err(|source| SettingsError::Invalid { path: path.to_owned(), source: Box::new(source) })
    }

    fn parse(text: &str) -> Result<Self, toml::de::Error> {
        toml::from_str(text)
    }
}

/// Why the settings cannot be used.
#[derive(Debug, thiserror::Error)]
pub enum SettingsError {
    /// The file is not there, or must not be read.
    #[error("cannot read the configuration file {path}: {source}", path = path.display())]
    Unreadable {
        /// Which file.
        path: PathBuf,
        /// Why.
        source: std::io::Error,
    },
    /// Unknown key, wrong type, not TOML.
    #[error("the configuration file {path} has an error:\n{source}", path = path.display())]
    Invalid {
        /// Which file.
        path: PathBuf,
        /// Where and what.
        source: Box<toml::de::Error>,
    },
    /// A limit of the history that cannot be.
    #[error("history.{key} is {value}; it may be 1 to {max}. To keep nothing: history.enabled = false")]
    History {
        /// Which key.
        key: &'static str,
        /// What it says.
        value: u32,
        /// What it may say.
        max: u32,
    },
    /// A certificate without its key, or the other way round.
    #[error("the configuration has a certificate without its other half: give {0}, too")]
    HalfCertificate(&'static str),
    /// A number that makes no sense.
    #[error("the configuration has a number out of its range: {0}")]
    OutOfRange(String),
    /// Neither a flag nor a home folder.
    #[error("no folder for data: this user has no home folder; give one with --data")]
    NoDataFolder,
}

/// The user's folder for application data.
pub(crate) fn default_data() -> Option<PathBuf> {
    let folder =
        |variable: &str| std::env::var_os(variable).filter(|text| !text.is_empty()).map(PathBuf::from);
    let base = if cfg!(windows) {
        folder("LOCALAPPDATA")
    } else if cfg!(target_os = "macos") {
        folder("HOME").map(|home| home.join("Library/Application Support"))
    } else {
        folder("XDG_DATA_HOME").or_else(|| folder("HOME").map(|home| home.join(".local/share")))
    };
    base.map(|base| base.join("cipdeck"))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_flag_overrides_the_file_and_the_file_the_default() {
        let file =
            Given::parse("listen = \"127.0.0.1:9000\"\ndata = \"plant\"\nlog_format = \"json\"").unwrap();
        let flags = Given { listen: Some("[::1]:1".parse().unwrap()), ..Given::default() };
        let settings = Settings::resolve(flags, file).unwrap();
        assert_eq!(settings.listen, "[::1]:1".parse().unwrap());
        assert_eq!(settings.data, Some(PathBuf::from("plant")));
        assert_eq!((settings.log.as_str(), settings.log_format), ("info", LogFormat::Json));
    }

    #[test]
    fn an_unknown_key_is_named() {
        let error = Given::parse("listne = \"127.0.0.1:9000\"").unwrap_err().to_string();
        assert!(error.contains("listne"), "{error}");
        assert!(Given::parse("listen = \"everywhere\"").is_err());
    }

    #[test]
    fn the_limits_of_the_history_are_checked_and_a_wrong_key_is_named() {
        let of = |text: &str| {
            let file = Given::parse(&format!("data = \"plant\"\n[history]\n{text}"))
                .map_err(|error| error.to_string())?;
            let settings = Settings::resolve(Given::default(), file).map_err(|error| error.to_string())?;
            Ok(settings.history)
        };
        assert_eq!(of("max_mb = 64"), Ok(HistorySettings { max_mb: 64, ..HistorySettings::default() }));
        assert_eq!(of("enabled = false").map(|history| history.enabled), Ok(false));
        for (text, named) in
            [("max_mb = 0", "max_mb"), ("max_days = 36501", "max_days"), ("max_gb = 1", "max_gb")]
        {
            let refused: Result<HistorySettings, String> = of(text);
            assert!(refused.as_ref().is_err_and(|error| error.contains(named)), "{refused:?}");
        }
    }

    #[test]
    fn what_makes_no_sense_is_refused_in_words() {
        for (text, expected) in [
            ("[tls]\ncert = \"a.pem\"", "give tls.key, too"),
            ("[tls]\nkey = \"a.pem\"", "give tls.cert, too"),
            ("[limits]\nconnections = 0", "limits.connections must be 8 to 65536"),
            ("[limits]\nconnections_per_client = 513", "must be 1 to limits.connections"),
        ] {
            let refused = Settings::resolve(Given::default(), Given::parse(text).unwrap()).unwrap_err();
            assert!(refused.to_string().contains(expected), "{refused}");
        }
        for text in ["allow_hosts = [\"https://a\"]", "[tls]\ncrt = \"a\"", "[limits]\nconnections = -1"] {
            Given::parse(text).unwrap_err();
        }
    }

    #[test]
    fn every_key_is_documented() {
        let text = include_str!("../../../docs/CONFIGURATION.md");
        let keys = [
            "listen",
            "data",
            "project",
            "log",
            "log_format",
            "history.enabled",
            "history.max_mb",
            "history.max_days",
            "local.role",
            "allow.target",
            "allow.write",
            "limits.messages_per_second",
            "allow_hosts",
            "tls.cert",
            "tls.key",
            "tls.hsts",
            "limits.connections",
            "limits.connections_per_client",
        ];
        for key in keys {
            assert!(text.contains(&format!("| `{key}` |")), "docs/CONFIGURATION.md does not describe {key}");
        }
        // The example in the document holds every key and is accepted as it stands.
        let example = text.split("```toml").nth(1).and_then(|rest| rest.split("```").next()).unwrap();
        let given = Given::parse(example).unwrap();
        let Given { listen, data, project, log, log_format, history, local, allow, allow_hosts, tls, limits } =
            given;
        assert!(
            listen.is_some() && data.is_some() && project.is_some() && log.is_some() && log_format.is_some()
        );
        assert_eq!(history, Some(HistorySettings::default()), "the example shows the defaults");
        assert!(local.is_some() && limits != Limits::default());
        assert_eq!((allow.target.len(), allow.write.len()), (1, 1));
        assert!(!allow_hosts.is_empty() && tls.is_some_and(|tls| tls.files().is_some() && tls.hsts));
    }
}
