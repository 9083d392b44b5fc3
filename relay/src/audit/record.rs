//! What can be recorded: an event, who did it, from where, and members that depend on the event.

use serde_json::{Map, Value};

/// Longest text of one member; a longer one is cut and ends with `…`.
const MAX_TEXT: usize = 16 * 1024;

/// Members that every record has; an event cannot name its own like that.
const RESERVED: [&str; 7] = ["seq", "at", "event", "actor", "from", "prev", "hash"];

/// One thing to be recorded. Never a password, a token, a cookie or a set-up code.
#[derive(Clone, Debug, PartialEq)]
pub(crate) struct Record {
    event: Event,
    actor: String,
    from: String,
    members: Map<String, Value>,
}

impl Record {
    /// `actor` is who acts (`anna`, `token:nightly`, `local`), `from` the address of their machine, or empty.
    pub(crate) fn new(event: Event, actor: &str, from: &str) -> Self {
        Self { event, actor: cut(actor.to_owned()), from: cut(from.to_owned()), members: Map::new() }
    }

    /// One more member; docs/AUDIT.md lists those of each event.
    #[must_use]
    pub(crate) fn with(mut self, key: &str, value: impl Into<Value>) -> Self {
        debug_assert!(!RESERVED.contains(&key), "{key} is a member of every record");
        let value = match value.into() {
            Value::String(text) => Value::String(cut(text)),
            value => value,
        };
        self.members.insert(key.to_owned(), value);
        self
    }

    /// A member that may be unknown, and is left out then.
    #[must_use]
    pub(crate) fn with_some(self, key: &str, value: Option<impl Into<Value>>) -> Self {
        match value {
            Some(value) => self.with(key, value),
            None => self,
        }
    }

    pub(super) const fn event(&self) -> Event {
        self.event
    }

    pub(super) fn actor(&self) -> &str {
        &self.actor
    }

    pub(super) fn from(&self) -> &str {
        &self.from
    }

    pub(super) const fn members(&self) -> &Map<String, Value> {
        &self.members
    }
}

fn cut(mut text: String) -> String {
    if text.len() > MAX_TEXT {
        text.truncate(text.floor_char_boundary(MAX_TEXT));
        text.push('…');
    }
    text
}

/// Makes the enumeration, its words in JSON, and the list of all.
macro_rules! events {
    ($($(#[$doc:meta])* $name:ident = $word:literal,)*) => {
        /// What has happened.
        #[derive(Clone, Copy, Debug, PartialEq, Eq)]
        pub(crate) enum Event {
            $($(#[$doc])* $name,)*
        }

        impl Event {
            /// All of them.
            #[cfg(test)]
            pub(crate) const ALL: &[Self] = &[$(Self::$name),*];

            /// The word in JSON.
            pub(crate) const fn word(self) -> &'static str {
                match self {
                    $(Self::$name => $word,)*
                }
            }
        }
    };
}

events! {
    /// The relay has started.
    Start = "start",
    /// The relay stops.
    Stop = "stop",
    /// The first administrator was made with the set-up code.
    Setup = "setup",
    /// Somebody has signed in.
    SignIn = "sign_in",
    /// A name and a password, a token or a link that was not right.
    SignInFailed = "sign_in_failed",
    /// Somebody has signed out.
    SignOut = "sign_out",
    /// A session ended without a sign-out: idle, too old, revoked.
    SessionEnded = "session_ended",
    /// An account is new.
    UserCreated = "user_created",
    /// An account has another role, or was locked or unlocked.
    UserChanged = "user_changed",
    /// An account is gone.
    UserDeleted = "user_deleted",
    /// An account has another password.
    PasswordChanged = "password_changed",
    /// An API token or a view link is new.
    TokenCreated = "token_created",
    /// An API token or a view link holds no longer.
    TokenRevoked = "token_revoked",
    /// A target or a write was allowed.
    ListAdded = "list_added",
    /// A target or a write is allowed no longer.
    ListRemoved = "list_removed",
    /// A write window was opened.
    WindowOpened = "window_opened",
    /// A write window was closed, or its time was over.
    WindowClosed = "window_closed",
    /// The relay was switched to read-only.
    ReadOnlyOn = "read_only_on",
    /// The relay is no longer read-only.
    ReadOnlyOff = "read_only_off",
    /// A person asks to write and is shown the old and the new value.
    WriteRequested = "write_requested",
    /// A write goes out: this is recorded before its first byte.
    WritePermitted = "write_permitted",
    /// A write has ended: what the device has answered.
    WriteEnded = "write_ended",
    /// What was read after a write.
    WriteReadBack = "write_read_back",
    /// A write was refused, and why.
    WriteDenied = "write_denied",
    /// A block is new.
    BlockCreated = "block_created",
    /// A block has another configuration.
    BlockChanged = "block_changed",
    /// A block is gone.
    BlockDeleted = "block_deleted",
    /// A device, a group or variables were made, changed or deleted.
    PlantChanged = "plant_changed",
    /// Another certificate is in use.
    CertificateReloaded = "certificate_reloaded",
    /// The records before this one are broken, and were set aside. Writes are stopped.
    ChainBroken = "chain_broken",
    /// A person with access to the machine has seen the break. Writes go on.
    ChainAccepted = "chain_accepted",
    /// Records could not be written for a while.
    AuditResumed = "audit_resumed",
}

impl Event {
    /// Without this record nothing may be written to a device.
    pub(super) const fn allows_a_write(self) -> bool {
        matches!(self, Self::WriteRequested | Self::WritePermitted)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_long_text_is_cut_where_a_character_ends() {
        let record = Record::new(Event::SignIn, &"ä".repeat(20_000), "").with("detail", "x".repeat(20_000));
        assert!(record.actor().len() <= MAX_TEXT + 3 && record.actor().ends_with("ä…"));
        assert!(record.members()["detail"].as_str().unwrap().ends_with("x…"));
    }

    #[test]
    fn every_event_is_documented() {
        let text = include_str!("../../../docs/AUDIT.md");
        for event in Event::ALL {
            let row = format!("| `{}` |", event.word());
            assert!(text.contains(&row), "docs/AUDIT.md lacks {row}");
        }
    }
}
