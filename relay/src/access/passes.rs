//! API tokens for programs, and view links for tablets: secrets that open without a password, for a time.

use std::collections::BTreeMap;
use std::net::IpAddr;
use std::sync::Arc;
use std::sync::atomic::{AtomicU64, Ordering};
use std::time::{Duration, SystemTime, UNIX_EPOCH};

use cipdeck_shared::api::{ActorKind, NewToken, NewViewLink, PassView, Role};

use super::Access;
use super::back_off::BackOff;
use super::secret::{self, Digest};
use super::trail::Event;
use crate::actor::{Actor, Life, Limits, Standing};
use crate::error::ApiError;
use crate::permit::TargetRule;
use crate::runner::lock;
pub(crate) use crate::store::PassKind;
use crate::store::StoredPass;
use crate::wall_clock;

/// What a token begins with, so that people and scanners know one when they see it.
const PREFIX: &str = "cdt_";

/// Characters of a name.
const LONGEST_NAME: usize = 64;

/// Most tokens, and most links.
const MOST: usize = 256;

/// Most targets that a token is limited to.
const MOST_TARGETS: usize = 64;

/// Longest life of a token, in days.
const MOST_DAYS: u32 = 366;

/// Longest life of a link, in hours.
const MOST_HOURS: u32 = 24 * MOST_DAYS;

/// All tokens and links, by id.
#[derive(Debug, Default)]
pub(super) struct Passes(BTreeMap<u64, Pass>);

#[derive(Debug)]
pub(super) struct Pass {
    stored: StoredPass,
    rules: Vec<TargetRule>,
    standing: Arc<Standing>,
    life: Arc<Life>,
    /// s since 1970; 0 = never.
    used: AtomicU64,
}

/// A token, and its secret, which is told this once.
pub(crate) struct MadeToken {
    /// What can be seen of it.
    pub(crate) view: PassView,
    /// `cdt_3_…`
    pub(crate) secret: String,
}

/// A view link, and its secret, which is told this once.
pub(crate) struct MadeLink {
    /// What can be seen of it.
    pub(crate) view: PassView,
    /// Goes into the address.
    pub(crate) secret: String,
}

impl Passes {
    pub(super) fn new(stored: Vec<(u64, StoredPass)>, mut next_life: impl FnMut() -> u64) -> Self {
        Self(stored.into_iter().map(|(id, stored)| (id, Pass::new(stored, next_life()))).collect())
    }

    /// The pass with this secret, if it has not ended.
    fn find(&self, kind: PassKind, digest: &Digest) -> Option<(u64, &Pass)> {
        let is_it = |pass: &Pass| pass.stored.kind == kind && pass.stored.digest == *digest;
        let (id, pass) = self.0.iter().find(|(_, pass)| is_it(pass))?;
        pass.is_live().then_some((*id, pass))
    }

    fn views(&self, kind: PassKind) -> Vec<PassView> {
        let those = self.0.iter().filter(|(_, pass)| pass.stored.kind == kind);
        those.map(|(id, pass)| pass.view(*id)).collect()
    }

    /// Ends those whose time is over.
    pub(super) fn end_ended(&self) {
        for pass in self.0.values() {
            pass.is_live();
        }
    }

    /// When tokens and links were used, where that is not stored yet: pairs of an id and s since 1970.
    pub(super) fn newly_used(&mut self) -> Vec<(u64, u64)> {
        let mut used = Vec::new();
        for (id, pass) in &mut self.0 {
            let at = pass.used.load(Ordering::Relaxed);
            if at > pass.stored.last_used.unwrap_or(0) {
                pass.stored.last_used = Some(at);
                used.push((*id, at));
            }
        }
        used
    }
}

impl Pass {
    fn new(stored: StoredPass, life: u64) -> Self {
        let rules: Result<Vec<TargetRule>, _> = stored.scope.lines().map(str::parse).collect();
        let role = match &rules {
            Ok(_) => Some(stored.role),
            // Without its limits it must not be used.
            Err(error) => {
                tracing::error!(pass = stored.name, %error, "a token has a scope that cannot be read");
                None
            }
        };
        let left = time(stored.ends_at).duration_since(SystemTime::now()).unwrap_or_default();
        Self {
            rules: rules.unwrap_or_default(),
            standing: Arc::new(Standing::new(role)),
            life: Arc::new(Life::begin(life, Limits { idle: None, absolute: left })),
            used: AtomicU64::new(stored.last_used.unwrap_or(0)),
            stored,
        }
    }

    /// The end is a time of day: a machine that was asleep must not make it later.
    fn is_live(&self) -> bool {
        if SystemTime::now() >= time(self.stored.ends_at) {
            self.life.end();
        }
        self.life.is_live()
    }

    fn actor(&self, from: IpAddr) -> Actor {
        self.used.fetch_max(seconds(SystemTime::now()), Ordering::Relaxed);
        let (standing, life) = (Arc::clone(&self.standing), Arc::clone(&self.life));
        let (name, from) = (self.actor_name(), from.to_string());
        match self.stored.kind {
            PassKind::Token => Actor::with_token(name, from, standing, life, self.rules.clone()),
            PassKind::ViewLink => Actor::in_session(name, ActorKind::ViewLink, from, standing, life),
        }
    }

    /// As the audit names it. No user's name has a colon.
    fn actor_name(&self) -> String {
        let kind = match self.stored.kind {
            PassKind::Token => "token",
            PassKind::ViewLink => "view",
        };
        format!("{kind}:{}", self.stored.name)
    }

    fn view(&self, id: u64) -> PassView {
        let used = self.used.load(Ordering::Relaxed);
        PassView {
            id,
            name: self.stored.name.clone(),
            role: self.stored.role,
            scope: self.stored.scope.lines().map(str::to_owned).collect(),
            created_by: self.stored.created_by.clone(),
            ends_at: wall_clock::at(time(self.stored.ends_at)),
            last_used: (used > 0).then(|| wall_clock::at(time(used))),
        }
    }
}

impl Access {
    /// All tokens or all links, by id.
    pub(crate) fn passes(&self, kind: PassKind) -> Vec<PassView> {
        lock(&self.0.passes).views(kind)
    }

    /// Makes a token.
    pub(crate) async fn make_token(&self, new: NewToken, by: &Actor) -> Result<MadeToken, ApiError> {
        let NewToken { name, role, scope, days } = new;
        if !matches!(role, Role::Viewer | Role::Operator | Role::Engineer) {
            return Err(ApiError::Unreadable(
                "a token is for a viewer, an operator or an engineer".to_owned(),
            ));
        }
        if !(1..=MOST_DAYS).contains(&days) {
            return Err(ApiError::Unreadable(format!("a token is good for 1 to {MOST_DAYS} days")));
        }
        if scope.len() > MOST_TARGETS {
            return Err(ApiError::Unreadable(format!(
                "a token is limited to at most {MOST_TARGETS} targets"
            )));
        }
        let scope: Vec<_> = scope.iter().map(|target| target.trim()).collect();
        for target in &scope {
            if let Err(error) = target.parse::<TargetRule>() {
                return Err(ApiError::Unreadable(error.to_string()));
            }
        }
        let secret = secret::new()?;
        let lasts = Duration::from_secs(u64::from(days) * 86_400);
        let view = self.make_pass(PassKind::Token, name, role, &scope, &secret, lasts, by).await?;
        Ok(MadeToken { secret: format!("{PREFIX}{}_{secret}", view.id), view })
    }

    /// Makes a view link.
    pub(crate) async fn make_link(&self, new: NewViewLink, by: &Actor) -> Result<MadeLink, ApiError> {
        let NewViewLink { name, hours } = new;
        if !(1..=MOST_HOURS).contains(&hours) {
            return Err(ApiError::Unreadable(format!("a view link is good for 1 to {MOST_HOURS} hours")));
        }
        let secret = secret::new()?;
        let lasts = Duration::from_secs(u64::from(hours) * 3_600);
        let view = self.make_pass(PassKind::ViewLink, name, Role::Viewer, &[], &secret, lasts, by).await?;
        Ok(MadeLink { view, secret })
    }

    #[expect(clippy::too_many_arguments, reason = "what a pass consists of")]
    async fn make_pass(
        &self,
        kind: PassKind,
        name: String,
        role: Role,
        scope: &[&str],
        secret: &str,
        lasts: Duration,
        by: &Actor,
    ) -> Result<PassView, ApiError> {
        let name = name.trim().to_owned();
        if !(1..=LONGEST_NAME).contains(&name.chars().count()) || name.chars().any(char::is_control) {
            return Err(ApiError::Unreadable(format!("the name has 1 to {LONGEST_NAME} characters")));
        }
        let _edit = self.0.edit.lock().await;
        {
            let passes = lock(&self.0.passes);
            let same_kind = || passes.0.values().filter(|pass| pass.stored.kind == kind);
            if same_kind().any(|pass| pass.stored.name == name) {
                return Err(ApiError::Conflict(format!(
                    "{name:?} is there already: revoke it, or take another name"
                )));
            }
            if same_kind().count() >= MOST {
                return Err(ApiError::Conflict(format!(
                    "there are {MOST} already: revoke those that have ended"
                )));
            }
        }
        let stored = StoredPass {
            kind,
            name,
            role,
            scope: scope.join("\n"),
            digest: secret::digest(secret),
            created_by: by.name().to_owned(),
            ends_at: seconds(SystemTime::now() + lasts),
            last_used: None,
        };
        let id = self.0.store.add_pass(stored.clone()).await?;
        let pass = Pass::new(stored, self.0.next_life());
        let (view, actor) = (pass.view(id), pass.actor_name());
        lock(&self.0.passes).0.insert(id, pass);
        let scope = view.scope.join(", ");
        let members =
            [("token", actor.as_str()), ("role", role.word()), ("scope", &scope), ("ends_at", &view.ends_at)];
        self.0.trail.note(Event::TokenCreated, by, &members);
        Ok(view)
    }

    /// Ends a token or a link, and everything that acts with it, at once.
    pub(crate) async fn revoke(&self, kind: PassKind, id: u64, by: &Actor) -> Result<(), ApiError> {
        let _edit = self.0.edit.lock().await;
        let is_there = lock(&self.0.passes).0.get(&id).is_some_and(|pass| pass.stored.kind == kind);
        if !is_there {
            let what = match kind {
                PassKind::Token => "token",
                PassKind::ViewLink => "view link",
            };
            return Err(ApiError::NotFound(format!("there is no {what} {id}")));
        }
        self.0.store.remove_pass(id).await?;
        if let Some(pass) = lock(&self.0.passes).0.remove(&id) {
            pass.standing.set(None);
            pass.life.end();
            self.0.trail.note(Event::TokenRevoked, by, &[("token", &pass.actor_name())]);
        }
        Ok(())
    }

    /// Whoever calls with a token.
    pub(super) fn with_token(&self, text: &str, from: IpAddr) -> Result<Actor, ApiError> {
        let read = || {
            let (id, secret) = text.strip_prefix(PREFIX)?.split_once('_')?;
            Some((id.parse::<u64>().ok()?, secret::digest(secret)))
        };
        let found = read().and_then(|(id, digest)| {
            let passes = lock(&self.0.passes);
            let found = passes.find(PassKind::Token, &digest).filter(|(own, _)| *own == id);
            found.map(|(_, pass)| pass.actor(from))
        });
        found.ok_or_else(|| {
            self.wrong_secret(from, "the token is not good: it was revoked, has ended, or is not whole")
        })
    }

    /// Whoever opens a view link, or has opened it: the browser keeps the link's secret, so that a tablet on the wall
    /// goes on after a restart of the relay.
    pub(super) fn with_link(&self, secret: &str, from: IpAddr) -> Option<Actor> {
        let digest = secret::digest(secret);
        lock(&self.0.passes).find(PassKind::ViewLink, &digest).map(|(_, pass)| pass.actor(from))
    }

    /// A view link is opened: how long it lasts.
    pub(crate) fn open_link(&self, secret: &str, from: IpAddr) -> Result<Duration, ApiError> {
        let Some(actor) = self.with_link(secret, from) else {
            return Err(self.wrong_secret(from, "this view link is not good any more: ask for a new one"));
        };
        self.0.trail.note(Event::SignIn, &actor, &[]);
        let ends = actor.life().map(|life| life.ends());
        Ok(ends.map_or(Duration::ZERO, |ends| ends.saturating_duration_since(tokio::time::Instant::now())))
    }

    /// Counted and recorded, but not faster than anybody could look at the records.
    fn wrong_secret(&self, from: IpAddr, why: &str) -> ApiError {
        if let Err(too_many) = self.0.back_off.attempt(&BackOff::of_secret(from)) {
            return too_many;
        }
        self.0.trail.record(Event::SignInFailed, "unknown", &from.to_string(), &[]);
        ApiError::SignedOut(why.to_owned())
    }
}

fn time(seconds: u64) -> SystemTime {
    UNIX_EPOCH + Duration::from_secs(seconds)
}

fn seconds(time: SystemTime) -> u64 {
    time.duration_since(UNIX_EPOCH).unwrap_or_default().as_secs()
}
