//! The first administrator: made by whoever reads the relay's terminal.

use std::net::IpAddr;

use cipdeck_shared::api::{Role, SetUp};
use subtle::ConstantTimeEq;
use tokio::sync::watch;

use super::back_off::Key;
use super::secret::{self, Digest};
use super::sessions::SignedIn;
use super::trail::Event;
use super::users::check_name;
use super::{Access, password};
use crate::error::ApiError;
use crate::runner::lock;

/// Douglas Crockford's base 32: no I, L, O and U; whoever reads a 0 as O, or a 1 as I or L, is understood.
const ALPHABET: &[u8; 32] = b"0123456789ABCDEFGHJKMNPQRSTVWXYZ";

/// Characters, each 5 bits.
const LENGTH: usize = 12;

/// Opens the set-up. In memory only, another one at each start of the relay.
pub(super) struct Code {
    text: String,
    digest: Digest,
}

impl std::fmt::Debug for Code {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        f.debug_struct("Code").finish_non_exhaustive()
    }
}

impl Code {
    pub(super) fn new() -> Result<Self, ApiError> {
        let bytes: [u8; LENGTH] = secret::random()?;
        let plain: String = bytes.iter().map(|byte| char::from(ALPHABET[usize::from(byte & 31)])).collect();
        let text = format!("{}-{}-{}", &plain[..4], &plain[4..8], &plain[8..]);
        Ok(Self { text, digest: secret::digest(&plain) })
    }

    /// Compares in a time that does not depend on what is given.
    fn is(&self, given: &str) -> bool {
        self.digest.ct_eq(&secret::digest(&plain(given))).into()
    }
}

/// What was typed, without what does not matter.
fn plain(given: &str) -> String {
    let read = |c: char| match c.to_ascii_uppercase() {
        'O' => '0',
        'I' | 'L' => '1',
        c => c,
    };
    given.chars().filter(|c| !c.is_whitespace() && *c != '-').take(2 * LENGTH).map(read).collect()
}

impl Access {
    /// The code that makes the first administrator, for the terminal; none once there is one.
    pub(crate) fn setup_code(&self) -> Option<String> {
        lock(&self.0.code).as_ref().map(|code| code.text.clone())
    }

    /// TRUE from the moment when there is an administrator.
    pub(crate) fn is_set_up(&self) -> watch::Receiver<bool> {
        self.0.is_set_up.subscribe()
    }

    /// Makes the first administrator and signs them in.
    pub(crate) async fn set_up(&self, form: SetUp, from: IpAddr) -> Result<SignedIn, ApiError> {
        let SetUp { code, name, password } = form;
        self.0.back_off.attempt(&[Key::Code])?;
        let is_right = match &*lock(&self.0.code) {
            None => return Err(done()),
            Some(own) => own.is(&code),
        };
        let from_text = from.to_string();
        if !is_right {
            self.0.trail.record(Event::SignInFailed, "set-up", &from_text, &[]);
            return Err(ApiError::NotPermitted(
                "this is not the set-up code: the relay has printed it where it was started".to_owned(),
            ));
        }
        self.0.back_off.was_right(&[Key::Code]);
        check_name(&name)?;
        password::check(&name, &password)?;
        let password = self.0.passwords.hash(password).await?;
        let _edit = self.0.edit.lock().await;
        // Somebody else with the code may have been faster.
        if lock(&self.0.code).is_none() {
            return Err(done());
        }
        if lock(&self.0.users).get(&name).is_some() {
            return Err(ApiError::Conflict(format!("there is a user {name} already")));
        }
        self.insert_user(name.clone(), Role::Admin, password).await?;
        let _used = lock(&self.0.code).take();
        let signed_in = self.begin_session(&name, from)?;
        self.0.trail.note(Event::Setup, &signed_in.actor, &[("user", &name)]);
        self.0.is_set_up.send_replace(true);
        Ok(signed_in)
    }
}

fn done() -> ApiError {
    ApiError::Conflict("there is an administrator already: sign in".to_owned())
}
