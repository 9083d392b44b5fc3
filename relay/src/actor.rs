//! Who acts: a person, a token, a view link, whoever is at this machine, or the relay itself.
//!
//! An [`Actor`] is taken along by every command and asked again before every message: what it may do is looked up in
//! its [`Standing`] each time, so that a changed role or a revoked session acts at once.

use std::sync::Arc;
use std::sync::atomic::{AtomicU8, AtomicU64, Ordering};
use std::time::Duration;

use cipdeck_shared::api::{ActorKind, Role};
use tokio::time::Instant;
use tokio_util::sync::CancellationToken;

use crate::permit::TargetRule;

/// Who acts, and from where. Clones are the same actor.
#[derive(Clone, Debug)]
pub(crate) struct Actor(Arc<Inner>);

#[derive(Debug)]
struct Inner {
    name: String,
    kind: ActorKind,
    from: String,
    standing: Arc<Standing>,
    life: Option<Arc<Life>>,
    scope: Vec<TargetRule>,
}

/// What an account may do at this moment: one for each user, token and link, shared by all who act with it.
#[derive(Debug)]
pub(crate) struct Standing(AtomicU8);

/// A session: ends once, for good.
#[derive(Debug)]
pub(crate) struct Life {
    /// Names it; opens nothing.
    pub(crate) id: u64,
    began: Instant,
    /// ms since `began`.
    active: AtomicU64,
    limits: Limits,
    ended: CancellationToken,
}

/// How long a session lasts.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) struct Limits {
    /// Without activity; `None` for a session that only looks.
    pub(crate) idle: Option<Duration>,
    /// In any case.
    pub(crate) absolute: Duration,
}

impl Actor {
    /// Somebody with a session.
    pub(crate) fn in_session(
        name: impl Into<String>,
        kind: ActorKind,
        from: impl Into<String>,
        standing: Arc<Standing>,
        life: Arc<Life>,
    ) -> Self {
        let (name, from) = (name.into(), from.into());
        Self(Arc::new(Inner { name, kind, from, standing, life: Some(life), scope: Vec::new() }))
    }

    /// A program with a token. `life` ends with the token.
    pub(crate) fn with_token(
        name: impl Into<String>,
        from: impl Into<String>,
        standing: Arc<Standing>,
        life: Arc<Life>,
        scope: Vec<TargetRule>,
    ) -> Self {
        let (name, from, life) = (name.into(), from.into(), Some(life));
        Self(Arc::new(Inner { name, kind: ActorKind::Token, from, standing, life, scope }))
    }

    /// Whoever is at this machine. Nothing but the end of the relay ends it.
    pub(crate) fn local(role: Role, from: impl Into<String>) -> Self {
        Self::unending("local", ActorKind::Local, from.into(), role)
    }

    /// The relay itself, for a block that resumes: reads only.
    pub(crate) fn relay() -> Self {
        Self::unending("relay", ActorKind::Relay, String::new(), Role::Operator)
    }

    fn unending(name: &str, kind: ActorKind, from: String, role: Role) -> Self {
        let (name, standing) = (name.to_owned(), Arc::new(Standing::new(Some(role))));
        Self(Arc::new(Inner { name, kind, from, standing, life: None, scope: Vec::new() }))
    }

    /// As the audit names it.
    pub(crate) fn name(&self) -> &str {
        &self.0.name
    }

    /// How the actor is known.
    pub(crate) fn kind(&self) -> ActorKind {
        self.0.kind
    }

    /// The address that the actor called from; empty for the relay itself.
    pub(crate) fn from(&self) -> &str {
        &self.0.from
    }

    /// What the actor may do now. `None` when the account is gone or locked; a session may have ended all the same.
    pub(crate) fn role(&self) -> Option<Role> {
        self.0.standing.role()
    }

    /// Whether the session, if there is one, still lasts.
    pub(crate) fn is_present(&self) -> bool {
        self.0.life.as_ref().is_none_or(|life| life.is_live())
    }

    /// What the actor is limited to; empty for everything that the lists allow.
    pub(crate) fn scope(&self) -> &[TargetRule] {
        &self.0.scope
    }

    /// The session, if there is one.
    pub(crate) fn life(&self) -> Option<&Arc<Life>> {
        self.0.life.as_ref()
    }

    /// Whether both are the same session, or the same actor without one.
    pub(crate) fn is_same(&self, other: &Self) -> bool {
        self.name() == other.name()
            && self.kind() == other.kind()
            && self.life().map(|life| life.id) == other.life().map(|life| life.id)
    }

    /// Ready when the session ends; never for one without.
    pub(crate) async fn gone(&self) {
        match self.life() {
            Some(life) => life.ended.cancelled().await,
            None => std::future::pending().await,
        }
    }

    /// The actor has done something.
    pub(crate) fn touch(&self) {
        if let Some(life) = self.life() {
            life.touch();
        }
    }
}

impl Standing {
    /// With a role; `None` for one who may nothing.
    pub(crate) fn new(role: Option<Role>) -> Self {
        Self(AtomicU8::new(code(role)))
    }

    /// What it is now.
    pub(crate) fn role(&self) -> Option<Role> {
        Role::ALL.into_iter().find(|role| code(Some(*role)) == self.0.load(Ordering::Relaxed))
    }

    /// From now on.
    pub(crate) fn set(&self, role: Option<Role>) {
        self.0.store(code(role), Ordering::Relaxed);
    }
}

const fn code(role: Option<Role>) -> u8 {
    match role {
        None => 0,
        Some(role) => role as u8 + 1,
    }
}

impl Life {
    /// Begins now.
    pub(crate) fn begin(id: u64, limits: Limits) -> Self {
        Self { id, began: Instant::now(), active: AtomicU64::new(0), limits, ended: CancellationToken::new() }
    }

    /// Whether it lasts. One whose time has passed ends by being asked.
    pub(crate) fn is_live(&self) -> bool {
        if !self.ended.is_cancelled() && Instant::now() >= self.ends() {
            self.end();
        }
        !self.ended.is_cancelled()
    }

    /// When it ends if nothing happens any more.
    pub(crate) fn ends(&self) -> Instant {
        let absolute = self.began + self.limits.absolute;
        let active = Duration::from_millis(self.active.load(Ordering::Relaxed));
        self.limits.idle.map_or(absolute, |idle| absolute.min(self.began + active + idle))
    }

    /// When it ends in any case.
    pub(crate) fn ends_in_any_case(&self) -> Instant {
        self.began + self.limits.absolute
    }

    /// Minutes without activity after which it ends.
    pub(crate) fn idle_minutes(&self) -> Option<u32> {
        self.limits.idle.and_then(|idle| u32::try_from(idle.as_secs() / 60).ok())
    }

    /// When it was last used.
    pub(crate) fn active_at(&self) -> Instant {
        self.began + Duration::from_millis(self.active.load(Ordering::Relaxed))
    }

    /// Somebody is there. An ended session stays ended.
    pub(crate) fn touch(&self) {
        if self.is_live() {
            let since = u64::try_from(self.began.elapsed().as_millis()).unwrap_or(u64::MAX);
            self.active.fetch_max(since, Ordering::Relaxed);
        }
    }

    /// Ends it, for good.
    pub(crate) fn end(&self) {
        self.ended.cancel();
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    const LIMITS: Limits = Limits { idle: Some(Duration::from_mins(15)), absolute: Duration::from_mins(25) };

    #[tokio::test(start_paused = true)]
    async fn a_session_ends_when_nobody_is_there_and_in_any_case() {
        let life = Life::begin(1, LIMITS);
        tokio::time::advance(Duration::from_secs(899)).await;
        assert!(life.is_live());
        life.touch();
        tokio::time::advance(Duration::from_mins(10)).await;
        assert!(life.is_live());
        tokio::time::advance(Duration::from_secs(1)).await;
        assert!(!life.is_live(), "1,500 s in all");
        let idle = Life::begin(2, LIMITS);
        tokio::time::advance(Duration::from_mins(15)).await;
        idle.touch();
        assert!(!idle.is_live(), "an ended session stays ended");
    }

    #[test]
    fn a_changed_standing_is_seen_by_everybody_who_acts_with_it() {
        let standing = Arc::new(Standing::new(Some(Role::Engineer)));
        let life = Arc::new(Life::begin(1, LIMITS));
        let actor = Actor::in_session("a", ActorKind::Person, "", Arc::clone(&standing), Arc::clone(&life));
        assert_eq!(actor.role(), Some(Role::Engineer));
        for role in Role::ALL.map(Some).into_iter().chain([None]) {
            standing.set(role);
            assert_eq!(actor.role(), role);
        }
        assert!(actor.is_present());
        life.end();
        assert!(!actor.is_present());
    }
}
