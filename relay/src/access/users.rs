//! Users: their names, roles and passwords.

use std::collections::BTreeMap;
use std::sync::Arc;

use cipdeck_shared::api::{NewUser, Role, UserChange, UserView};

use super::trail::Event;
use super::{Access, password};
use crate::actor::{Actor, Standing};
use crate::error::ApiError;
use crate::runner::lock;
use crate::store::StoredUser;
use crate::wall_clock;

/// Longest name.
const LONGEST_NAME: usize = 64;

/// Most users.
const MOST: usize = 1024;

/// All users, by name.
#[derive(Debug, Default)]
pub(super) struct Users(BTreeMap<String, User>);

#[derive(Clone, Debug)]
pub(super) struct User {
    pub(super) stored: StoredUser,
    /// Shared by all sessions of the user.
    pub(super) standing: Arc<Standing>,
}

impl Users {
    pub(super) fn new(stored: Vec<StoredUser>) -> Self {
        Self(stored.into_iter().map(|stored| (stored.name.clone(), User::new(stored))).collect())
    }

    /// Whether there is an administrator who can sign in.
    pub(super) fn has_admin(&self) -> bool {
        self.has_admin_beside("")
    }

    fn has_admin_beside(&self, name: &str) -> bool {
        self.0.values().any(|user| user.stored.name != name && is_admin(&user.stored))
    }

    /// A user, if there is one.
    pub(super) fn get(&self, name: &str) -> Option<&User> {
        self.0.get(name)
    }

    /// Puts a user as stored; the standing follows.
    pub(super) fn put(&mut self, stored: StoredUser) {
        match self.0.get_mut(&stored.name) {
            Some(user) => {
                user.standing.set(role(&stored));
                user.stored = stored;
            }
            None => {
                self.0.insert(stored.name.clone(), User::new(stored));
            }
        }
    }
}

impl User {
    fn new(stored: StoredUser) -> Self {
        let standing = Arc::new(Standing::new(role(&stored)));
        Self { stored, standing }
    }
}

fn role(stored: &StoredUser) -> Option<Role> {
    (!stored.disabled).then_some(stored.role)
}

fn is_admin(stored: &StoredUser) -> bool {
    role(stored) == Some(Role::Admin)
}

impl Access {
    /// All users, by name.
    pub(crate) fn users(&self) -> Vec<UserView> {
        let sessions = lock(&self.0.sessions).count_by_user();
        let users = lock(&self.0.users);
        let view = |user: &User| {
            let StoredUser { name, role, disabled, created_at, last_sign_in, .. } = user.stored.clone();
            let sessions = sessions.get(&name).copied().unwrap_or(0);
            UserView { name, role, disabled, created_at, last_sign_in, sessions }
        };
        users.0.values().map(view).collect()
    }

    /// One user.
    pub(crate) fn user(&self, name: &str) -> Result<UserView, ApiError> {
        self.users().into_iter().find(|user| user.name == name).ok_or_else(|| no_user(name))
    }

    /// Makes a user.
    pub(crate) async fn add_user(&self, new: NewUser, by: &Actor) -> Result<UserView, ApiError> {
        check_name(&new.name)?;
        password::check(&new.name, &new.password)?;
        let password = self.0.passwords.hash(new.password).await?;
        let _edit = self.0.edit.lock().await;
        {
            let users = lock(&self.0.users);
            if users.get(&new.name).is_some() {
                return Err(ApiError::Conflict(format!("there is a user {} already", new.name)));
            }
            if users.0.len() >= MOST {
                return Err(ApiError::Conflict(format!("there are {MOST} users already")));
            }
        }
        self.insert_user(new.name.clone(), new.role, password).await?;
        self.0.trail.note(Event::UserCreated, by, &[("user", &new.name), ("role", new.role.word())]);
        self.user(&new.name)
    }

    /// Stores a new user. Whoever calls holds `edit`, and has looked.
    pub(super) async fn insert_user(
        &self,
        name: String,
        role: Role,
        password: String,
    ) -> Result<(), ApiError> {
        let created_at = wall_clock::now();
        let stored = StoredUser { name, role, disabled: false, password, created_at, last_sign_in: None };
        self.0.store.add_user(stored.clone()).await?;
        lock(&self.0.users).put(stored);
        Ok(())
    }

    /// Changes a user: a role acts at once; a new password and being locked out end all sessions.
    pub(crate) async fn change_user(
        &self,
        name: &str,
        change: UserChange,
        by: &Actor,
    ) -> Result<UserView, ApiError> {
        let UserChange { role, disabled, password } = change;
        let hashed = match password {
            Some(password) => {
                password::check(name, &password)?;
                Some(self.0.passwords.hash(password).await?)
            }
            None => None,
        };
        let _edit = self.0.edit.lock().await;
        let mut stored = lock(&self.0.users).get(name).ok_or_else(|| no_user(name))?.stored.clone();
        let (has_password, is_other) = (hashed.is_some(), role.is_some() || disabled.is_some());
        stored.role = role.unwrap_or(stored.role);
        stored.disabled = disabled.unwrap_or(stored.disabled);
        stored.password = hashed.unwrap_or(stored.password);
        if !is_admin(&stored) {
            self.keep_an_admin(name, "keep the role, or make another administrator first")?;
        }
        self.0.store.change_user(stored.clone()).await?;
        let (role, disabled) = (stored.role, stored.disabled);
        lock(&self.0.users).put(stored);
        if has_password || disabled {
            self.end_sessions_of(name, None);
        }
        if has_password {
            self.0.trail.note(Event::PasswordChanged, by, &[("user", name)]);
        }
        if is_other {
            let disabled = if disabled { "true" } else { "false" };
            let members = [("user", name), ("role", role.word()), ("disabled", disabled)];
            self.0.trail.note(Event::UserChanged, by, &members);
        }
        self.user(name)
    }

    /// Forgets a user. What acts for them stops at once.
    pub(crate) async fn remove_user(&self, name: &str, by: &Actor) -> Result<(), ApiError> {
        let _edit = self.0.edit.lock().await;
        if lock(&self.0.users).get(name).is_none() {
            return Err(no_user(name));
        }
        self.keep_an_admin(name, "make another administrator first")?;
        self.0.store.remove_user(name.to_owned()).await?;
        if let Some(user) = lock(&self.0.users).0.remove(name) {
            user.standing.set(None);
        }
        self.end_sessions_of(name, None);
        self.0.trail.note(Event::UserDeleted, by, &[("user", name)]);
        Ok(())
    }

    /// Without an administrator nobody could ever change anything again.
    fn keep_an_admin(&self, name: &str, advice: &str) -> Result<(), ApiError> {
        let users = lock(&self.0.users);
        let is_the_last =
            users.get(name).is_some_and(|user| is_admin(&user.stored)) && !users.has_admin_beside(name);
        if is_the_last {
            return Err(ApiError::Conflict(format!("{name} is the last administrator: {advice}")));
        }
        Ok(())
    }
}

pub(super) fn check_name(name: &str) -> Result<(), ApiError> {
    let is_allowed = |b: u8| b.is_ascii_lowercase() || b.is_ascii_digit() || b"._-".contains(&b);
    if (1..=LONGEST_NAME).contains(&name.len()) && name.bytes().all(is_allowed) {
        return Ok(());
    }
    Err(ApiError::Unreadable(format!(
        "a user's name has 1 to {LONGEST_NAME} of the characters a-z 0-9 . _ -"
    )))
}

fn no_user(name: &str) -> ApiError {
    ApiError::NotFound(format!("there is no user {name}"))
}
