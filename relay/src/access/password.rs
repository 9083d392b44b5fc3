//! Passwords: Argon2id, a few at a time.

use std::sync::atomic::{AtomicUsize, Ordering};
use std::sync::{Arc, Mutex};
use std::time::Duration;

use argon2::password_hash::Result as Computed;
use argon2::password_hash::phc::{Output, ParamsString, PasswordHash, Salt};
use argon2::{Algorithm, Argon2, Block, Params, Version};
use tokio::sync::Semaphore;

use super::secret;
use crate::error::ApiError;
use crate::runner::lock;

/// What one attempt costs: OWASP's Password Storage Cheat Sheet, Argon2id, asks for at least 19 MiB, two passes, one
/// lane.
pub(super) const COST: (u32, u32, u32) = (19 * 1024, 2, 1);

/// How many are computed at once: messages to devices need the processor, too.
const AT_ONCE: usize = 2;

/// How many may wait for their turn.
const WAITING: usize = 32;

/// Characters, at least.
const SHORTEST: usize = 12;

/// Characters, at most. Nothing is cut off silently.
const LONGEST: usize = 256;

/// Computes hashes of passwords.
#[derive(Clone, Debug)]
pub(super) struct Passwords {
    hasher: Argon2<'static>,
    /// A hash of no password: an unknown user takes as long as a wrong password.
    nobody: String,
    turns: Arc<Semaphore>,
    waiting: Arc<AtomicUsize>,
    tables: Tables,
}

impl Passwords {
    /// With memory in KiB, passes and lanes.
    pub(super) fn new((memory, passes, lanes): (u32, u32, u32)) -> Result<Self, ApiError> {
        let params = Params::new(memory, passes, lanes, None)
            .map_err(|error| ApiError::Internal(format!("Argon2: {error}")))?;
        Ok(Self {
            hasher: Argon2::new(Algorithm::Argon2id, Version::V0x13, params),
            nobody: format!(
                "$argon2id$v=19$m={memory},t={passes},p={lanes}${}${}",
                "A".repeat(22),
                "A".repeat(43)
            ),
            turns: Arc::new(Semaphore::new(AT_ONCE)),
            waiting: Arc::default(),
            tables: Tables::default(),
        })
    }

    /// As it is kept: a PHC string with a salt of its own.
    pub(super) async fn hash(&self, password: String) -> Result<String, ApiError> {
        let (hasher, tables) = (self.hasher.clone(), self.tables.clone());
        let salt: [u8; 16] = secret::random()?;
        let kept = self.in_turn(move || hashed(&hasher, &tables, &password, &salt)).await?;
        kept.map_err(|error| ApiError::Internal(format!("Argon2: {error}")))
    }

    /// Whether it is the password that was kept. Without one it is not, and that takes as long.
    pub(super) async fn is_right(&self, kept: Option<String>, password: String) -> Result<bool, ApiError> {
        let (tables, is_known) = (self.tables.clone(), kept.is_some());
        let kept = kept.unwrap_or_else(|| self.nobody.clone());
        let is_right = self.in_turn(move || is_right(&tables, &kept, &password).unwrap_or(false));
        Ok(is_right.await? && is_known)
    }

    async fn in_turn<T: Send + 'static>(
        &self,
        work: impl FnOnce() -> T + Send + 'static,
    ) -> Result<T, ApiError> {
        let _place = Place::take(&self.waiting)?;
        let failed = |error: &dyn std::fmt::Display| ApiError::Internal(format!("Argon2: {error}"));
        let turn = Arc::clone(&self.turns).acquire_owned().await.map_err(|error| failed(&error))?;
        let work = move || {
            // Given back when the work is done, even if nobody waits for it any more.
            let _turn = turn;
            work()
        };
        tokio::task::spawn_blocking(work).await.map_err(|error| failed(&error))
    }
}

/// A PHC string.
fn hashed(hasher: &Argon2<'_>, tables: &Tables, password: &str, salt: &[u8]) -> Computed<String> {
    let hash = PasswordHash {
        algorithm: Algorithm::Argon2id.ident(),
        version: Some(Version::V0x13.into()),
        params: ParamsString::try_from(hasher.params())?,
        salt: Some(Salt::new(salt)?),
        hash: Some(tables.output(hasher, password, salt)?),
    };
    Ok(hash.to_string())
}

/// Whether it is the password of a PHC string, which says itself what it costs.
fn is_right(tables: &Tables, kept: &str, password: &str) -> Computed<bool> {
    let kept = PasswordHash::new(kept)?;
    let version = kept.version.map_or(Ok(Version::V0x13), Version::try_from)?;
    let hasher =
        Argon2::new(Algorithm::try_from(kept.algorithm.as_str())?, version, Params::try_from(&kept)?);
    let (Some(salt), Some(expected)) = (kept.salt, kept.hash) else { return Ok(false) };
    // Compared in a time that does not depend on what is found.
    Ok(tables.output(&hasher, password, &salt)? == expected)
}

/// The memory of the computation, which is kept for the next one: an allocator would keep what was given back for the
/// thread that had it, and so 19 MiB for each of the runtime's many threads.
#[derive(Clone, Debug, Default)]
struct Tables(Arc<Mutex<Vec<Vec<Block>>>>);

impl Tables {
    fn output(&self, hasher: &Argon2<'_>, password: &str, salt: &[u8]) -> Computed<Output> {
        let mut table = lock(&self.0).pop().unwrap_or_default();
        let blocks = hasher.params().block_count();
        if table.len() < blocks {
            table.resize(blocks, Block::new());
        }
        let mut output = [0; Params::DEFAULT_OUTPUT_LEN];
        let result =
            hasher.hash_password_into_with_memory(password.as_bytes(), salt, &mut output, &mut table);
        lock(&self.0).push(table);
        result?;
        Ok(Output::new(&output)?)
    }
}

/// One of those who wait.
struct Place(Arc<AtomicUsize>);

impl Place {
    fn take(waiting: &Arc<AtomicUsize>) -> Result<Self, ApiError> {
        let place = Self(Arc::clone(waiting));
        if waiting.fetch_add(1, Ordering::Relaxed) < WAITING + AT_ONCE {
            return Ok(place);
        }
        let why = "many passwords are being checked at this moment".to_owned();
        Err(ApiError::TooMany { retry_after: Duration::from_secs(1), why })
    }
}

impl Drop for Place {
    fn drop(&mut self) {
        self.0.fetch_sub(1, Ordering::Relaxed);
    }
}

/// Whether a password may be chosen.
pub(super) fn check(name: &str, password: &str) -> Result<(), ApiError> {
    let length = password.chars().count();
    if !(SHORTEST..=LONGEST).contains(&length) {
        return Err(ApiError::Unreadable(format!(
            "the password has {length} characters: choose {SHORTEST} to {LONGEST}, such as four words"
        )));
    }
    if password.eq_ignore_ascii_case(name) {
        return Err(ApiError::Unreadable("the password is the name: choose another one".to_owned()));
    }
    Ok(())
}

#[cfg(test)]
pub(super) const CHEAP: (u32, u32, u32) = (8, 1, 1);

#[cfg(test)]
mod tests {
    use super::*;

    #[tokio::test]
    async fn only_the_password_itself_is_right_and_nobody_has_none() {
        let passwords = Passwords::new(CHEAP).unwrap();
        let kept = passwords.hash("correct horse battery".to_owned()).await.unwrap();
        let again = passwords.hash("correct horse battery".to_owned()).await.unwrap();
        assert_ne!(kept, again, "each has its own salt");
        for (password, expected) in
            [("correct horse battery", true), ("correct horse batter", false), ("", false), ("x", false)]
        {
            let is_right = passwords.is_right(Some(kept.clone()), password.to_owned()).await.unwrap();
            assert_eq!(is_right, expected, "{password}");
            assert!(!passwords.is_right(None, password.to_owned()).await.unwrap());
        }
        assert!(!passwords.is_right(Some("x".to_owned()), "x".to_owned()).await.unwrap());
    }

    #[tokio::test]
    async fn many_passwords_take_no_more_memory_than_two() {
        let passwords = Passwords::new(CHEAP).unwrap();
        let attempts = (0..WAITING).map(|_| passwords.is_right(None, "x".to_owned()));
        for attempt in futures_util::future::join_all(attempts).await {
            assert!(!attempt.unwrap());
        }
        let tables = lock(&passwords.tables.0).iter().map(Vec::len).collect::<Vec<_>>();
        assert!((1..=AT_ONCE).contains(&tables.len()), "{tables:?}");
        assert!(tables.iter().all(|blocks| *blocks == 8), "{tables:?}");
    }

    /// Hashed by the library's own way, as earlier versions did.
    #[tokio::test]
    async fn what_was_kept_before_still_opens() {
        use argon2::{PasswordHasher, PasswordVerifier};
        let passwords = Passwords::new(CHEAP).unwrap();
        let kept = Argon2::default().hash_password(b"correct horse battery").unwrap().to_string();
        assert!(passwords.is_right(Some(kept.clone()), "correct horse battery".to_owned()).await.unwrap());
        assert!(!passwords.is_right(Some(kept), "correct horse batterz".to_owned()).await.unwrap());
        let own = passwords.hash("correct horse battery".to_owned()).await.unwrap();
        Argon2::default().verify_password(b"correct horse battery", own.as_str()).unwrap();
    }

    #[test]
    fn what_is_kept_costs_what_owasp_asks_for() {
        let passwords = Passwords::new(COST).unwrap();
        assert!(PasswordHash::new(&passwords.nobody).is_ok(), "nobody's hash is computed like everybody's");
        assert!(passwords.nobody.starts_with("$argon2id$v=19$m=19456,t=2,p=1$"));
    }

    #[tokio::test]
    async fn who_comes_when_many_wait_is_sent_away() {
        let passwords = Passwords::new(CHEAP).unwrap();
        let places: Vec<_> =
            (0..WAITING + AT_ONCE).map(|_| Place::take(&passwords.waiting).unwrap()).collect();
        let refused = passwords.hash("correct horse battery".to_owned()).await.unwrap_err();
        assert!(matches!(refused, ApiError::TooMany { .. }), "{refused:?}");
        drop(places);
        passwords.hash("correct horse battery".to_owned()).await.unwrap();
    }

    #[test]
    fn a_password_is_long_enough_and_not_the_name() {
        check("anna", "123456789012").unwrap();
        check("anna", &"ä".repeat(256)).unwrap();
        for password in ["", "12345678901", &"x".repeat(257)] {
            check("anna", password).unwrap_err();
        }
        check("anna.maria.x", "Anna.Maria.X").unwrap_err();
    }
}
