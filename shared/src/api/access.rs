//! Who may do what: roles, users, sessions, tokens and view links.

use alloc::string::String;
use alloc::vec::Vec;

use serde::{Deserialize, Serialize};

use super::secret::hide;

/// What a person or a program may do. docs/SECURITY-MODEL.md has the whole table.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Hash, Serialize, Deserialize)]
#[cfg_attr(feature = "openapi", derive(utoipa::ToSchema))]
#[serde(rename_all = "lowercase")]
pub enum Role {
    /// Looks, and sends nothing.
    Viewer,
    /// Sends reads to allowed targets, and the writes that are on the list.
    Operator,
    /// Sends anything to allowed targets, writes in a write window; edits blocks.
    Engineer,
    /// Keeps users and lists; sends reads, never writes.
    Admin,
}

impl Role {
    /// From the one that may least.
    pub const ALL: [Self; 4] = [Self::Viewer, Self::Operator, Self::Engineer, Self::Admin];

    /// The word in JSON and on the command line.
    pub const fn word(self) -> &'static str {
        match self {
            Self::Viewer => "viewer",
            Self::Operator => "operator",
            Self::Engineer => "engineer",
            Self::Admin => "admin",
        }
    }

    /// Reads may be sent.
    pub const fn may_send(self) -> bool {
        !matches!(self, Self::Viewer)
    }

    /// Writes may be sent, as the lists and the write window allow.
    pub const fn may_write(self) -> bool {
        matches!(self, Self::Operator | Self::Engineer)
    }

    /// Blocks may be made, changed and deleted.
    pub const fn may_edit(self) -> bool {
        matches!(self, Self::Engineer)
    }

    /// The audit may be read.
    pub const fn may_audit(self) -> bool {
        matches!(self, Self::Engineer | Self::Admin)
    }

    /// Users, tokens and lists may be changed.
    pub const fn may_manage(self) -> bool {
        matches!(self, Self::Admin)
    }
}

/// How a caller is known.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash, Serialize, Deserialize)]
#[cfg_attr(feature = "openapi", derive(utoipa::ToSchema))]
#[serde(rename_all = "snake_case")]
pub enum ActorKind {
    /// Somebody who has signed in.
    Person,
    /// A program with an API token.
    Token,
    /// A tablet with a view link.
    ViewLink,
    /// Whoever is at this machine, while the relay is configured so.
    Local,
    /// The relay itself, for a block that resumes.
    Relay,
}

/// `GET /api/v1/session`: who the caller is.
#[derive(Clone, Debug, PartialEq, Eq, Serialize, Deserialize)]
#[cfg_attr(feature = "openapi", derive(utoipa::ToSchema))]
pub struct SessionView {
    /// What is to be done first.
    pub state: SessionState,
    /// The caller, when signed in.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub caller: Option<Caller>,
    /// SHA-256 of the certificate, as browsers show it (`A1:B2:…`), when the relay answers over TLS or will.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub fingerprint: Option<String>,
    /// Where the relay will be found after set-up, when that is another address than now.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub moves_to: Option<String>,
}

/// Whether somebody is signed in.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
#[cfg_attr(feature = "openapi", derive(utoipa::ToSchema))]
#[serde(rename_all = "snake_case")]
pub enum SessionState {
    /// There is no administrator yet: the set-up code is on the relay's terminal.
    SetUp,
    /// Sign in first.
    SignedOut,
    /// See `caller`.
    SignedIn,
}

/// Who calls.
#[derive(Clone, Debug, PartialEq, Eq, Serialize, Deserialize)]
#[cfg_attr(feature = "openapi", derive(utoipa::ToSchema))]
pub struct Caller {
    /// The user's, the token's or the link's name; `local` for local access.
    pub name: String,
    /// How the caller is known.
    pub kind: ActorKind,
    /// What the caller may do.
    pub role: Role,
    /// To be sent as `X-CSRF-Token` with every request that is not a GET; persons and view links only.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub csrf: Option<String>,
    /// When the session ends in any case (RFC 3339).
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub ends_at: Option<String>,
    /// Minutes without activity after which the session ends.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub idle_minutes: Option<u32>,
}

/// `POST /api/v1/setup`: makes the first administrator.
#[derive(Clone, PartialEq, Eq, Serialize, Deserialize)]
#[cfg_attr(feature = "openapi", derive(utoipa::ToSchema))]
#[serde(deny_unknown_fields)]
pub struct SetUp {
    /// As the relay printed it; spaces, dashes and case do not matter.
    pub code: String,
    /// The administrator's name.
    pub name: String,
    /// At least 12 characters.
    pub password: String,
}

/// `POST /api/v1/session`: signs in.
#[derive(Clone, PartialEq, Eq, Serialize, Deserialize)]
#[cfg_attr(feature = "openapi", derive(utoipa::ToSchema))]
#[serde(deny_unknown_fields)]
pub struct SignIn {
    /// The user's name.
    pub name: String,
    /// The password.
    pub password: String,
}

/// A user.
#[derive(Clone, Debug, PartialEq, Eq, Serialize, Deserialize)]
#[cfg_attr(feature = "openapi", derive(utoipa::ToSchema))]
pub struct UserView {
    /// 1 to 64 of `a-z 0-9 . _ -`.
    pub name: String,
    /// What they may do.
    pub role: Role,
    /// A disabled user cannot sign in.
    pub disabled: bool,
    /// When the user was made (RFC 3339).
    pub created_at: String,
    /// The last time that the user signed in.
    pub last_sign_in: Option<String>,
    /// How many sessions are open.
    pub sessions: usize,
}

/// `POST /api/v1/users`.
#[derive(Clone, PartialEq, Eq, Serialize, Deserialize)]
#[cfg_attr(feature = "openapi", derive(utoipa::ToSchema))]
#[serde(deny_unknown_fields)]
pub struct NewUser {
    /// 1 to 64 of `a-z 0-9 . _ -`.
    pub name: String,
    /// What they may do.
    pub role: Role,
    /// At least 12 characters.
    pub password: String,
}

/// `PATCH /api/v1/users/{name}`: what is left out stays. A changed role acts at once; a new password and `disabled`
/// end all sessions of the user.
#[derive(Clone, Default, PartialEq, Eq, Serialize, Deserialize)]
#[cfg_attr(feature = "openapi", derive(utoipa::ToSchema))]
#[serde(deny_unknown_fields)]
pub struct UserChange {
    /// The new role.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub role: Option<Role>,
    /// Whether the user is locked out.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub disabled: Option<bool>,
    /// The new password.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub password: Option<String>,
}

/// `POST /api/v1/session/password`: one's own.
#[derive(Clone, PartialEq, Eq, Serialize, Deserialize)]
#[cfg_attr(feature = "openapi", derive(utoipa::ToSchema))]
#[serde(deny_unknown_fields)]
pub struct PasswordChange {
    /// The present one.
    pub old: String,
    /// At least 12 characters.
    pub new: String,
}

/// An open session, in `GET /api/v1/sessions`.
#[derive(Clone, Debug, PartialEq, Eq, Serialize, Deserialize)]
#[cfg_attr(feature = "openapi", derive(utoipa::ToSchema))]
pub struct SessionEntry {
    /// Names it for `DELETE /api/v1/sessions/{id}`; opens nothing.
    pub id: u64,
    /// Whose.
    pub name: String,
    /// How they came in.
    pub kind: ActorKind,
    /// What they may do.
    pub role: Role,
    /// The address that they called from.
    pub from: String,
    /// When it began (RFC 3339).
    pub started_at: String,
    /// When it was last used.
    pub active_at: String,
    /// When it ends in any case.
    pub ends_at: String,
}

/// A token or a view link.
#[derive(Clone, Debug, PartialEq, Eq, Serialize, Deserialize)]
#[cfg_attr(feature = "openapi", derive(utoipa::ToSchema))]
pub struct PassView {
    /// Names it for DELETE; opens nothing.
    pub id: u64,
    /// What people call it.
    pub name: String,
    /// What it may do; always viewer for a link.
    pub role: Role,
    /// Targets that it is limited to, as in the list of allowed targets; empty: all that the list allows.
    #[serde(default)]
    pub scope: Vec<String>,
    /// Who made it.
    pub created_by: String,
    /// When it ends (RFC 3339).
    pub ends_at: String,
    /// When it was last used.
    pub last_used: Option<String>,
}

/// `POST /api/v1/tokens`.
#[derive(Clone, Debug, PartialEq, Eq, Serialize, Deserialize)]
#[cfg_attr(feature = "openapi", derive(utoipa::ToSchema))]
#[serde(deny_unknown_fields)]
pub struct NewToken {
    /// 1 to 64 characters.
    pub name: String,
    /// viewer, operator or engineer.
    pub role: Role,
    /// Targets that it is limited to; empty: all that the list allows.
    #[serde(default)]
    pub scope: Vec<String>,
    /// 1 to 366.
    #[cfg_attr(feature = "openapi", schema(minimum = 1, maximum = 366))]
    pub days: u32,
}

/// A new token: the secret is shown this once.
#[derive(Clone, PartialEq, Eq, Serialize, Deserialize)]
#[cfg_attr(feature = "openapi", derive(utoipa::ToSchema))]
pub struct TokenCreated {
    /// What can be seen of it from now on.
    pub token: PassView,
    /// To be sent as `Authorization: Bearer …`.
    pub secret: String,
}

/// `POST /api/v1/view-links`.
#[derive(Clone, Debug, PartialEq, Eq, Serialize, Deserialize)]
#[cfg_attr(feature = "openapi", derive(utoipa::ToSchema))]
#[serde(deny_unknown_fields)]
pub struct NewViewLink {
    /// 1 to 64 characters: where the tablet hangs.
    pub name: String,
    /// 1 to 8784.
    #[cfg_attr(feature = "openapi", schema(minimum = 1, maximum = 8784))]
    pub hours: u32,
}

/// A new view link: shown this once.
#[derive(Clone, PartialEq, Eq, Serialize, Deserialize)]
#[cfg_attr(feature = "openapi", derive(utoipa::ToSchema))]
pub struct ViewLinkCreated {
    /// What can be seen of it from now on.
    pub link: PassView,
    /// Opens the Monitor, read only.
    pub url: String,
    /// The same as a QR code: an SVG image.
    pub qr_svg: String,
}

hide!(SetUp, SignIn, NewUser, UserChange, PasswordChange, TokenCreated, ViewLinkCreated);
