//! `cipdeck user`: works on the data folder of a relay that is stopped. Whoever can do that needs no password.

use std::io::{self, BufRead, IsTerminal};
use std::path::PathBuf;

use cipdeck_shared::api::{NewUser, Role, UserChange, UserView};
use clap::{Args, Subcommand};

use super::{Exit, say};
use crate::access::Access;
use crate::actor::Actor;
use crate::audit::Audit;
use crate::error::ApiError;
use crate::owner;
use crate::settings::{self, Settings, SettingsError};
use crate::store::{Store, StoreError};

/// `cipdeck user`
#[derive(Debug, Args)]
#[command(
    after_help = "Passwords are asked for without echo; without a terminal the first line of the standard \
                        input is taken."
)]
pub(super) struct User {
    /// Folder of the relay's data. [default: cipdeck in your folder for application data]
    #[arg(long, global = true, value_name = "DIR")]
    data: Option<PathBuf>,
    #[command(subcommand)]
    command: Command,
}

#[derive(Debug, Subcommand)]
enum Command {
    /// All users.
    List,
    /// A new user; also before the relay's first start.
    Add {
        /// 1 to 64 of a-z 0-9 . _ -
        name: String,
        /// viewer, operator, engineer or admin
        #[arg(long, value_parser = role)]
        role: Role,
    },
    /// Another password.
    Password {
        /// Whose.
        name: String,
    },
    /// Lock a user out.
    Disable {
        /// Whom.
        name: String,
    },
    /// Let a user in again.
    Enable {
        /// Whom.
        name: String,
    },
    /// Forget a user.
    Remove {
        /// Whom.
        name: String,
    },
}

/// Why it was not done.
#[derive(Debug, thiserror::Error)]
enum Failed {
    #[error(transparent)]
    Settings(#[from] SettingsError),
    #[error("there is no relay's database in {}: name its folder with --data", .0.display())]
    NoDatabase(PathBuf),
    #[error("a relay uses {}: stop it first", .0.display())]
    InUse(PathBuf),
    #[error("{0}")]
    Unusable(String),
    #[error("no password: {0}")]
    NoPassword(io::Error),
    #[error("the two are not the same")]
    NotTheSame,
    #[error(transparent)]
    Refused(#[from] ApiError),
}

impl User {
    /// Runs to its end.
    pub(super) async fn execute(self) -> Exit {
        match self.run().await {
            Ok(()) => Exit::SUCCESS,
            Err(
                error @ (Failed::Unusable(_) | Failed::InUse(_) | Failed::Refused(ApiError::Internal(_))),
            ) => Exit::internal(&error),
            Err(error) => Exit::usage(&error),
        }
    }

    async fn run(self) -> Result<(), Failed> {
        let folder = self.data.or_else(settings::default_data).ok_or(SettingsError::NoDataFolder)?;
        let settings = Settings::stored_in(&folder);
        let database = settings.database().unwrap_or_default();
        if !matches!(self.command, Command::Add { .. }) && !database.exists() {
            return Err(Failed::NoDatabase(folder));
        }
        let unusable =
            |error: &dyn std::fmt::Display| Failed::Unusable(format!("{}: {error}", folder.display()));
        let store = Store::open(Some(&database)).await.map_err(|error| match error {
            StoreError::InUse => Failed::InUse(folder.clone()),
            error => unusable(&error),
        })?;
        let audit = Audit::open(Some(&folder)).map_err(|error| unusable(&error))?;
        let access = Access::open(store.clone(), audit, None).await.map_err(|error| unusable(&error))?;
        let result = self.command.run(&access).await;
        store.close().await;
        owner::hand_over(&folder);
        result
    }
}

impl Command {
    async fn run(self, access: &Access) -> Result<(), Failed> {
        let by = Actor::local(Role::Admin, "");
        let change = |disabled| UserChange { disabled: Some(disabled), ..UserChange::default() };
        match self {
            Self::List => access.users().iter().for_each(|user| say(&line(user))),
            Self::Add { name, role } => {
                let password = password(&name)?;
                say(&line(&access.add_user(NewUser { name, role, password }, &by).await?));
            }
            Self::Password { name } => {
                access.user(&name)?;
                let password = Some(password(&name)?);
                access.change_user(&name, UserChange { password, ..UserChange::default() }, &by).await?;
            }
            Self::Disable { name } => say(&line(&access.change_user(&name, change(true), &by).await?)),
            Self::Enable { name } => say(&line(&access.change_user(&name, change(false), &by).await?)),
            Self::Remove { name } => access.remove_user(&name, &by).await?,
        }
        Ok(())
    }
}

fn line(user: &UserView) -> String {
    let UserView { name, role, disabled, last_sign_in, .. } = user;
    let seen = last_sign_in.as_deref().unwrap_or("never");
    let disabled = if *disabled { "  disabled" } else { "" };
    format!("{name:<16} {:<9} last signed in: {seen}{disabled}", role.word())
}

/// From the terminal, twice; otherwise the first line of the standard input.
fn password(name: &str) -> Result<String, Failed> {
    if io::stdin().is_terminal() {
        let ask = |prompt: String| rpassword::prompt_password(prompt).map_err(Failed::NoPassword);
        let password = ask(format!("Password for {name}: "))?;
        return if ask("The same again: ".to_owned())? == password {
            Ok(password)
        } else {
            Err(Failed::NotTheSame)
        };
    }
    let mut line = String::new();
    io::stdin().lock().read_line(&mut line).map_err(Failed::NoPassword)?;
    Ok(line.trim_end_matches(['\r', '\n']).to_owned())
}

fn role(text: &str) -> Result<Role, String> {
    let found = Role::ALL.into_iter().find(|role| role.word() == text);
    found.ok_or_else(|| "one of viewer, operator, engineer, admin".to_owned())
}
