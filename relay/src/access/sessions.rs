//! Sessions of users: signing in and out.

use std::collections::{BTreeMap, HashMap};
use std::net::IpAddr;
use std::sync::Arc;
use std::time::{Duration, SystemTime};

use cipdeck_shared::api::{ActorKind, PasswordChange, Role, SessionEntry, SignIn};

use super::caller::Known;
use super::secret::{self, Digest};
use super::trail::Event;
use super::users::check_name;
use super::{Access, password};
use crate::actor::{Actor, Life, Limits, Standing};
use crate::error::ApiError;
use crate::runner::lock;
use crate::wall_clock;

/// How long a session of a person lasts.
pub(super) const LIMITS: Limits =
    Limits { idle: Some(Duration::from_mins(15)), absolute: Duration::from_hours(12) };

/// Sessions of one user; the oldest ends.
const MOST_OF_ONE: usize = 16;

/// Sessions in all; the one that was not used for the longest time ends.
const MOST: usize = 512;

/// All sessions, by the digest of what the browser has.
#[derive(Debug, Default)]
pub(super) struct Sessions(HashMap<Digest, Session>);

#[derive(Clone, Debug)]
pub(super) struct Session {
    pub(super) user: String,
    pub(super) standing: Arc<Standing>,
    pub(super) life: Arc<Life>,
    from: String,
    started: SystemTime,
}

/// A new session.
#[derive(Clone)]
pub(crate) struct SignedIn {
    /// What the browser is to keep.
    pub(crate) secret: String,
    /// Who has signed in.
    pub(crate) actor: Actor,
}

impl SignedIn {
    /// Who has signed in, as the next request will know them.
    pub(crate) fn known(&self) -> Known {
        Known { actor: self.actor.clone(), csrf: Some(secret::csrf(&self.secret)) }
    }
}

impl Sessions {
    /// A session that lasts.
    pub(super) fn get(&self, digest: &Digest) -> Option<&Session> {
        self.0.get(digest).filter(|session| session.life.is_live())
    }

    pub(super) fn count_by_user(&self) -> BTreeMap<String, usize> {
        let mut counts = BTreeMap::new();
        for session in self.0.values().filter(|session| session.life.is_live()) {
            *counts.entry(session.user.clone()).or_default() += 1;
        }
        counts
    }

    fn insert(&mut self, digest: Digest, session: Session) {
        let of_one = |other: &Session| other.user == session.user;
        if self.0.values().filter(|other| of_one(other)).count() >= MOST_OF_ONE {
            self.end_least(of_one, |other| other.life.id);
        }
        if self.0.len() >= MOST {
            self.end_least(|_| true, |other| other.life.active_at());
        }
        self.0.insert(digest, session);
    }

    fn end_least<K: Ord>(&mut self, which: impl Fn(&Session) -> bool, key: impl Fn(&Session) -> K) {
        let of_those = self.0.iter().filter(|(_, session)| which(session));
        let least = of_those.min_by_key(|(_, session)| key(session)).map(|(digest, _)| *digest);
        if let Some(session) = least.and_then(|digest| self.0.remove(&digest)) {
            session.life.end();
        }
    }

    /// Ends and forgets those that `which` names.
    fn end(&mut self, which: impl Fn(&Session) -> bool) -> Vec<Session> {
        let ended: Vec<_> =
            self.0.extract_if(|_, session| which(session)).map(|(_, session)| session).collect();
        for session in &ended {
            session.life.end();
        }
        ended
    }

    /// Forgets those whose time is over.
    pub(super) fn sweep(&mut self) -> Vec<Session> {
        self.end(|session| !session.life.is_live())
    }
}

impl Session {
    /// As it acts from an address.
    pub(super) fn actor(&self, from: IpAddr) -> Actor {
        let (standing, life) = (Arc::clone(&self.standing), Arc::clone(&self.life));
        Actor::in_session(&self.user, ActorKind::Person, from.to_string(), standing, life)
    }
}

impl Access {
    /// Signs a user in.
    pub(crate) async fn sign_in(&self, form: SignIn, from: IpAddr) -> Result<SignedIn, ApiError> {
        let SignIn { name, password } = form;
        check_name(&name).map_err(|_| wrong())?;
        let keys = self.0.back_off.of_user(&name, from);
        self.0.back_off.attempt(&keys)?;
        let user = lock(&self.0.users).get(&name).cloned();
        let kept =
            user.as_ref().filter(|user| !user.stored.disabled).map(|user| user.stored.password.clone());
        let is_right = match self.0.passwords.is_right(kept.clone(), password).await {
            Ok(is_right) => is_right,
            Err(error) => {
                self.0.back_off.was_not_tried(&keys);
                return Err(error);
            }
        };
        let from_text = from.to_string();
        if !is_right {
            let who = if user.is_some() { &name } else { "unknown" };
            self.0.trail.record(Event::SignInFailed, who, &from_text, &[]);
            return Err(wrong());
        }
        self.0.back_off.was_right(&keys);
        let _edit = self.0.edit.lock().await;
        // Checking took a while: the account may have changed meanwhile.
        let user = lock(&self.0.users).get(&name).cloned();
        let user = user.filter(|user| !user.stored.disabled && Some(&user.stored.password) == kept.as_ref());
        let mut stored = user.ok_or_else(wrong)?.stored;
        stored.last_sign_in = Some(wall_clock::now());
        // A full disk locks nobody out.
        if let Err(error) = self.0.store.change_user(stored.clone()).await {
            tracing::warn!(%error, "not stored when a user has signed in");
        }
        lock(&self.0.users).put(stored);
        let signed_in = self.begin_session(&name, from)?;
        self.0.trail.note(Event::SignIn, &signed_in.actor, &[]);
        Ok(signed_in)
    }

    /// A session for somebody whose right to it has been checked. Whoever calls holds `edit`.
    pub(super) fn begin_session(&self, user: &str, from: IpAddr) -> Result<SignedIn, ApiError> {
        let secret = secret::new()?;
        let standing = lock(&self.0.users).get(user).map(|user| Arc::clone(&user.standing));
        let session = Session {
            user: user.to_owned(),
            standing: standing.ok_or_else(wrong)?,
            life: Arc::new(Life::begin(self.0.next_life(), LIMITS)),
            from: from.to_string(),
            started: SystemTime::now(),
        };
        let actor = session.actor(from);
        lock(&self.0.sessions).insert(secret::digest(&secret), session);
        Ok(SignedIn { secret, actor })
    }

    /// Ends the caller's session; nothing for somebody without.
    pub(crate) fn sign_out(&self, actor: &Actor) {
        let Some(id) = actor.life().map(|life| life.id) else { return };
        if !lock(&self.0.sessions).end(|session| session.life.id == id).is_empty() {
            self.0.trail.note(Event::SignOut, actor, &[]);
        }
    }

    /// Changes one's own password, and ends one's other sessions.
    pub(crate) async fn change_password(&self, change: PasswordChange, by: &Actor) -> Result<(), ApiError> {
        let (ActorKind::Person, Ok(from)) = (by.kind(), by.from().parse()) else {
            return Err(ApiError::NotPermitted("only somebody who has signed in has a password".to_owned()));
        };
        let name = by.name();
        password::check(name, &change.new)?;
        let keys = self.0.back_off.of_user(name, from);
        self.0.back_off.attempt(&keys)?;
        let kept = lock(&self.0.users).get(name).map(|user| user.stored.password.clone());
        if !self.0.passwords.is_right(kept.clone(), change.old).await? {
            self.0.trail.note(Event::SignInFailed, by, &[]);
            return Err(ApiError::NotPermitted("the present password is not right".to_owned()));
        }
        self.0.back_off.was_right(&keys);
        let password = self.0.passwords.hash(change.new).await?;
        let _edit = self.0.edit.lock().await;
        let user = lock(&self.0.users).get(name).cloned();
        let user = user.filter(|user| Some(&user.stored.password) == kept.as_ref());
        let mut stored = user.ok_or_else(wrong)?.stored;
        stored.password = password;
        self.0.store.change_user(stored.clone()).await?;
        lock(&self.0.users).put(stored);
        self.end_sessions_of(name, by.life().map(|life| life.id));
        self.0.trail.note(Event::PasswordChanged, by, &[("user", name)]);
        Ok(())
    }

    /// All sessions that last, the oldest first.
    pub(crate) fn sessions(&self) -> Vec<SessionEntry> {
        let sessions = lock(&self.0.sessions);
        let mut all: Vec<_> =
            sessions.0.values().filter(|session| session.life.is_live()).map(entry).collect();
        all.sort_by_key(|entry| entry.id);
        all
    }

    /// Ends a session at once.
    pub(crate) fn end_session(&self, id: u64, by: &Actor) -> Result<(), ApiError> {
        let ended = lock(&self.0.sessions).end(|session| session.life.id == id);
        let session = ended.first().ok_or_else(|| ApiError::NotFound(format!("there is no session {id}")))?;
        self.0.trail.note(Event::SessionEnded, by, &[("user", &session.user), ("why", "revoked")]);
        Ok(())
    }

    /// Ends the sessions of a user, but for one.
    pub(super) fn end_sessions_of(&self, user: &str, but: Option<u64>) {
        lock(&self.0.sessions).end(|session| session.user == user && Some(session.life.id) != but);
    }
}

fn entry(session: &Session) -> SessionEntry {
    SessionEntry {
        id: session.life.id,
        name: session.user.clone(),
        kind: ActorKind::Person,
        role: session.standing.role().unwrap_or(Role::Viewer),
        from: session.from.clone(),
        started_at: wall_clock::at(session.started),
        active_at: wall_clock::of(session.life.active_at()),
        ends_at: wall_clock::of(session.life.ends_in_any_case()),
    }
}

/// The same words whatever was wrong: nobody learns which names there are.
fn wrong() -> ApiError {
    ApiError::SignedOut("the name or the password is not right".to_owned())
}
