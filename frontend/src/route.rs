//! The addresses of the pages.

use yew_router::Routable;

/// A page.
#[derive(Clone, Debug, PartialEq, Routable)]
pub(crate) enum Route {
    /// The deck, or the first start.
    #[at("/")]
    Deck,
    /// One entry of the deck: `b7`, or `new-1` for one that is not stored yet.
    #[at("/deck/:id")]
    Block {
        /// A [`DeckId`](crate::store::DeckId) as text.
        id: String,
    },
    /// All blocks, live.
    #[at("/monitor")]
    Monitor,
    /// Words and keys.
    #[at("/help")]
    Help,
    /// Everything else.
    #[not_found]
    #[at("/404")]
    NotFound,
}
