//! Who calls: users and their sessions, API tokens, view links, and the set-up that makes the first administrator.
//!
//! Users, tokens and links lie in the database and in memory; a change is stored first. Sessions are in memory alone: a
//! restart of the relay signs everybody out, which is simple, and leaves no session in a backup. Of every secret only
//! its SHA-256 is kept, of a password its Argon2id hash.

mod back_off;
mod caller;
mod passes;
mod password;
mod secret;
mod sessions;
mod setup;
mod sweep;
mod trail;
mod users;

#[cfg(test)]
mod tests;

use std::sync::atomic::{AtomicU64, Ordering};
use std::sync::{Arc, Mutex};

use cipdeck_shared::api::Role;
use tokio::sync::watch;

use self::back_off::BackOff;
use self::passes::Passes;
use self::password::Passwords;
use self::sessions::Sessions;
use self::setup::Code;
use self::trail::Trail;
use self::users::Users;
use crate::audit::Audit;
use crate::error::ApiError;
use crate::store::{Store, StoreError};

pub(crate) use self::caller::{
    CSRF_HEADER, Known, SESSION as SESSION_COOKIE, VIEW as VIEW_COOKIE, no_cookie, session_cookie,
    view_cookie,
};
pub(crate) use self::passes::{MadeLink, MadeToken, PassKind};
pub(crate) use self::sessions::SignedIn;

/// Everybody who may call. Clones share it.
#[derive(Clone, Debug)]
pub(crate) struct Access(Arc<Inner>);

#[derive(Debug)]
struct Inner {
    store: Store,
    passwords: Passwords,
    users: Mutex<Users>,
    passes: Mutex<Passes>,
    sessions: Mutex<Sessions>,
    back_off: BackOff,
    trail: Trail,
    /// While there is no administrator.
    code: Mutex<Option<Code>>,
    is_set_up: watch::Sender<bool>,
    /// What whoever is at this machine may do without signing in.
    local: Option<Role>,
    /// Counts everything that can end: sessions, tokens, links.
    lives: AtomicU64,
    /// Held from the store to the memory, so that both have changes in the same order.
    edit: tokio::sync::Mutex<()>,
}

impl Access {
    /// Loads users, tokens and links. `local` is what whoever is at this machine may do without signing in.
    pub(crate) async fn open(store: Store, audit: Audit, local: Option<Role>) -> Result<Self, StoreError> {
        Self::open_at_cost(store, audit, local, password::COST).await
    }

    /// [`Self::open`] for tests that are about something else than the cost of a password.
    #[cfg(test)]
    pub(crate) async fn open_cheaply(store: Store, audit: Audit, local: Option<Role>) -> Self {
        Self::open_at_cost(store, audit, local, password::CHEAP).await.unwrap()
    }

    async fn open_at_cost(
        store: Store,
        audit: Audit,
        local: Option<Role>,
        cost: (u32, u32, u32),
    ) -> Result<Self, StoreError> {
        let lives = AtomicU64::new(0);
        let users = Users::new(store.users().await?);
        let passes = Passes::new(store.passes().await?, || lives.fetch_add(1, Ordering::Relaxed) + 1);
        let is_set_up = users.has_admin();
        let code = if is_set_up { None } else { Some(Code::new()?) };
        let access = Self(Arc::new(Inner {
            store,
            passwords: Passwords::new(cost)?,
            users: Mutex::new(users),
            passes: Mutex::new(passes),
            sessions: Mutex::default(),
            back_off: BackOff::default(),
            trail: Trail::new(audit),
            code: Mutex::new(code),
            is_set_up: watch::Sender::new(is_set_up),
            local,
            lives,
            edit: tokio::sync::Mutex::default(),
        }));
        sweep::start(&access.0);
        Ok(access)
    }
}

impl Inner {
    /// The next number of something that can end.
    fn next_life(&self) -> u64 {
        self.lives.fetch_add(1, Ordering::Relaxed) + 1
    }
}

impl From<ApiError> for StoreError {
    fn from(error: ApiError) -> Self {
        Self::Secrets(error.to_string())
    }
}
