//! The addresses of this document's pages.

pub use crate::address::{go, link, redirect, use_page};
use crate::{address::Pages, store::DeckId};

/// A page.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Page {
    /// All blocks of words.
    All,
    /// One more.
    New,
    /// One block.
    Block(DeckId),
    /// Everything else.
    NotFound,
}

impl Pages for Page {
    fn read(path: &str) -> Self {
        let Some(rest) = path.trim_end_matches('/').strip_prefix("/words") else { return Self::NotFound };
        match rest.strip_prefix('/') {
            None if rest.is_empty() => Self::All,
            Some("new") => Self::New,
            Some(id) => id.parse().map_or(Self::NotFound, Self::Block),
            None => Self::NotFound,
        }
    }

    fn path(self) -> String {
        match self {
            Self::All => "/words".to_owned(),
            Self::New => "/words/new".to_owned(),
            Self::Block(id) => format!("/words/{id}"),
            Self::NotFound => "/words/404".to_owned(),
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use cipdeck_shared::config::BlockId;

    #[test]
    fn every_page_has_its_address() {
        let stored = Page::Block(DeckId::Stored(BlockId(7)));
        for page in [Page::All, Page::New, stored, Page::Block(DeckId::New(2))] {
            assert_eq!(Page::read(&page.path()), page, "{page:?}");
        }
        assert_eq!(Page::read("/words/"), Page::All);
        for path in ["/word", "/wordsx", "/words/7", "/words/b", "/words/b1/x"] {
            assert_eq!(Page::read(path), Page::NotFound, "{path}");
        }
    }
}
