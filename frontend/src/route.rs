//! The addresses of the workbench's pages, and how to get there.
//!
//! A hundred lines instead of yew-router, which cost 28 kB of a page that may have 400 (gzipped).

use yew::prelude::*;

use crate::{
    address::{self, use_path},
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

impl Route {
    /// The page of a path.
    pub fn read(path: &str) -> Self {
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

    /// The path of a page.
    pub fn path(self) -> String {
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

/// Goes to a page.
pub fn go(to: Route) {
    address::go(&to.path());
}

/// Where we are; renders again when that changes.
#[hook]
pub fn use_route() -> Route {
    Route::read(&use_path())
}

/// A link to a page.
pub fn link(to: Route, class: &'static str, words: Html) -> Html {
    address::link(to.path(), class, words)
}

/// A link to a block: a `SEND_REQ` or `DATA_EXCH` has its page in another document.
pub fn block_link(row: &Row, words: Html) -> Html {
    if row.config.as_msg().is_some() {
        return link(Route::Block(row.id), "", words);
    }
    html! { <a href={format!("/words/{}", row.id)}>{ words }</a> }
}

/// Where to go instead.
#[derive(Clone, Debug, PartialEq, Properties)]
pub struct RedirectProps {
    /// The page.
    pub to: Route,
}

/// Replaces this address: the back button does not lead here again.
#[component]
pub fn Redirect(props: &RedirectProps) -> Html {
    use_effect_with(props.to, |to| address::replace(&to.path()));
    html! {}
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
