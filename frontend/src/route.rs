//! The addresses of the workbench's pages, and how to get there.
//!
//! A hundred lines instead of yew-router, which cost 28 kB of a page that may have 400 (gzipped).

use yew::prelude::*;

pub use crate::address::{go, link, redirect, use_page};
use crate::{
    address::Pages,
    store::{DeckId, Row},
};

/// A page.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Route {
    /// The deck, or the first start.
    Deck,
    /// One entry of the deck.
    Block(DeckId),
    /// All blocks, live.
    Monitor,
    /// Buffers, targets, discovery.
    Connections,
    /// Words and keys.
    Help,
    /// Everything else.
    NotFound,
}

impl Pages for Route {
    fn read(path: &str) -> Self {
        let path = path.trim_end_matches('/');
        match path.strip_prefix("/deck/") {
            Some(id) => id.parse().map_or(Self::NotFound, Self::Block),
            None => match path {
                "" => Self::Deck,
                "/monitor" => Self::Monitor,
                "/connections" => Self::Connections,
                "/help" => Self::Help,
                _ => Self::NotFound,
            },
        }
    }

    fn path(self) -> String {
        match self {
            Self::Deck => "/".to_owned(),
            Self::Block(id) => format!("/deck/{id}"),
            Self::Monitor => "/monitor".to_owned(),
            Self::Connections => "/connections".to_owned(),
            Self::Help => "/help".to_owned(),
            Self::NotFound => "/404".to_owned(),
        }
    }
}

/// A link to a block: a `SEND_REQ` or `DATA_EXCH` has its page in another document.
pub fn block_link(row: &Row, words: Html) -> Html {
    if row.config.as_msg().is_some() {
        return link(Route::Block(row.id), "", words);
    }
    html! { <a href={format!("/words/{}", row.id)}>{ words }</a> }
}

#[cfg(test)]
mod tests {
    use super::*;
    use cipdeck_shared::config::BlockId;

    #[test]
    fn a_page_is_found_by_the_path_that_it_writes() {
        let block = Route::Block(DeckId::Stored(BlockId(7)));
        for route in [
            Route::Deck,
            block,
            Route::Block(DeckId::New(1)),
            Route::Monitor,
            Route::Connections,
            Route::Help,
            Route::NotFound,
        ] {
            assert_eq!(Route::read(&route.path()), route);
        }
        assert_eq!(Route::read("/monitor/"), Route::Monitor);
        for path in ["/deck/", "/deck/7", "/deck/b7/x", "/nowhere"] {
            assert_eq!(Route::read(path), Route::NotFound, "{path}");
        }
    }
}
