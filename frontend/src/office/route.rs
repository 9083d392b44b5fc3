//! The addresses of the office's pages.

use crate::address::Pages;
pub use crate::address::{go, link, use_page};
use cipdeck_shared::{api::Role, config::BlockId};

/// A page of the office.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Page {
    /// Oneself, the write window, the certificate.
    Overview,
    /// Signing in.
    SignIn,
    /// Making the first administrator.
    SetUp,
    /// Users.
    Users,
    /// Who is signed in now.
    Sessions,
    /// API tokens.
    Tokens,
    /// Links for tablets.
    ViewLinks,
    /// What may be reached and written.
    Allowed,
    /// Who did what.
    Audit,
    /// Runs of all blocks, or of one.
    History(Option<BlockId>),
    /// The data of a block, field by field.
    Data(BlockId),
    /// Everything else.
    NotFound,
}

impl Pages for Page {
    fn read(path: &str) -> Self {
        let Some(rest) = path.trim_end_matches('/').strip_prefix("/office") else { return Self::NotFound };
        if let Some(id) = rest.strip_prefix("/data/") {
            return id.parse().map_or(Self::NotFound, Self::Data);
        }
        match rest.strip_prefix("/history/") {
            Some(id) => id.parse().map_or(Self::NotFound, |id| Self::History(Some(id))),
            None => match rest {
                "" => Self::Overview,
                "/sign-in" => Self::SignIn,
                "/set-up" => Self::SetUp,
                "/users" => Self::Users,
                "/sessions" => Self::Sessions,
                "/tokens" => Self::Tokens,
                "/view-links" => Self::ViewLinks,
                "/allowed" => Self::Allowed,
                "/audit" => Self::Audit,
                "/history" => Self::History(None),
                _ => Self::NotFound,
            },
        }
    }

    fn path(self) -> String {
        let rest = match self {
            Self::Overview => "",
            Self::SignIn => "/sign-in",
            Self::SetUp => "/set-up",
            Self::Users => "/users",
            Self::Sessions => "/sessions",
            Self::Tokens => "/tokens",
            Self::ViewLinks => "/view-links",
            Self::Allowed => "/allowed",
            Self::Audit => "/audit",
            Self::History(None) => "/history",
            Self::History(Some(id)) => return format!("/office/history/{id}"),
            Self::Data(id) => return format!("/office/data/{id}"),
            Self::NotFound => "/404",
        };
        format!("/office{rest}")
    }
}

impl Page {
    /// Those of the navigation, in its order.
    pub const LISTED: [Self; 8] = [
        Self::Overview,
        Self::Users,
        Self::Sessions,
        Self::Tokens,
        Self::ViewLinks,
        Self::Allowed,
        Self::Audit,
        Self::History(None),
    ];

    /// Whether a role has anything to do there. The relay decides; this only leaves out what it would refuse.
    pub const fn is_for(self, role: Role) -> bool {
        match self {
            Self::Users | Self::Sessions | Self::Tokens | Self::ViewLinks => role.may_manage(),
            Self::Audit => role.may_audit(),
            _ => true,
        }
    }
}

/// Where to go after signing in: a path of this relay and nothing else, whatever the address says.
pub fn next(query: &str) -> String {
    let wanted = query.trim_start_matches('?').split('&').find_map(|pair| pair.strip_prefix("next="));
    let decoded = wanted.and_then(decode);
    decoded.filter(|path| is_ours(path)).unwrap_or_else(|| "/".to_owned())
}

/// `//elsewhere` and `/\elsewhere` are addresses of other servers to a browser, and it drops tabs and line ends.
fn is_ours(path: &str) -> bool {
    let mut rest = path.chars();
    rest.next() == Some('/')
        && !matches!(rest.next(), Some('/' | '\\'))
        && !path.contains(|c: char| c.is_control() || c == '\\')
        && !path.starts_with("/office/sign-in")
        && !path.starts_with("/office/set-up")
        && !path.starts_with("/api")
}

/// `%2F` and its like. `None` for what is no text.
fn decode(text: &str) -> Option<String> {
    let mut bytes = Vec::new();
    let mut rest = text.bytes();
    while let Some(byte) = rest.next() {
        let decoded = match byte {
            b'%' => {
                let digits = [rest.next()?, rest.next()?];
                u8::from_str_radix(std::str::from_utf8(&digits).ok()?, 16).ok()?
            }
            other => other,
        };
        bytes.push(decoded);
    }
    String::from_utf8(bytes).ok()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_page_is_found_by_the_path_that_it_writes() {
        let mut pages = Page::LISTED.to_vec();
        pages.extend([Page::SignIn, Page::SetUp, Page::History(Some(BlockId(7))), Page::NotFound]);
        for page in pages {
            assert_eq!(Page::read(&page.path()), page);
        }
        assert_eq!(Page::read("/office/"), Page::Overview);
        for path in ["/", "/officer", "/office/history/7", "/office/nowhere"] {
            assert_eq!(Page::read(path), Page::NotFound, "{path}");
        }
    }

    #[test]
    fn after_signing_in_nobody_leaves_this_relay() {
        assert_eq!(next("?next=%2Fdeck%2Fb7"), "/deck/b7");
        assert_eq!(next("?a=1&next=/office/audit%3Fevent%3Drun"), "/office/audit?event=run");
        for foreign in [
            "",
            "?next=",
            "?next=https%3A%2F%2Fevil.example%2F",
            "?next=%2F%2Fevil.example",
            "?next=//evil.example",
            "?next=/%5Cevil.example",
            "?next=/%09/evil.example",
            "?next=%0A//evil.example",
            "?next=javascript:alert(1)",
            "?next=/office/sign-in",
            "?next=/api/v1/session",
            "?next=%F0%28",
            "?next=/%2",
        ] {
            assert_eq!(next(foreign), "/", "{foreign}");
        }
    }

    #[test]
    fn what_only_administrators_do_is_shown_to_them_only() {
        let shown = |role: Role| Page::LISTED.into_iter().filter(|page| page.is_for(role)).count();
        assert_eq!([Role::Viewer, Role::Operator, Role::Engineer, Role::Admin].map(shown), [3, 3, 4, 8]);
    }
}
