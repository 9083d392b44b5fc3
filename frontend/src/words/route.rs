//! The addresses of this document's pages.

use yew::prelude::*;

use crate::{
    address::{self, use_path},
    store::DeckId,
};

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

impl Page {
    /// The page of a path.
    pub fn read(path: &str) -> Self {
        let Some(rest) = path.trim_end_matches('/').strip_prefix("/words") else { return Self::NotFound };
        match rest.strip_prefix('/') {
            None if rest.is_empty() => Self::All,
            Some("new") => Self::New,
            Some(id) => id.parse().map_or(Self::NotFound, Self::Block),
            None => Self::NotFound,
        }
    }

    /// The path of a page.
    pub fn path(self) -> String {
        match self {
            Self::All => "/words".to_owned(),
            Self::New => "/words/new".to_owned(),
            Self::Block(id) => format!("/words/{id}"),
            Self::NotFound => "/words/404".to_owned(),
        }
    }
}

/// Goes to a page.
pub fn go(to: Page) {
    address::go(&to.path());
}

/// Where we are; renders again when that changes.
#[hook]
pub fn use_page() -> Page {
    Page::read(&use_path())
}

/// A link to a page.
pub fn link(to: Page, class: &'static str, words: Html) -> Html {
    address::link(to.path(), class, words)
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
