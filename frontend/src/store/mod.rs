//! What the page shows, kept outside the virtual DOM.

mod deck_id;
mod rows;
mod shelf;
mod trace;
mod watch;

pub use self::{
    deck_id::{DeckId, NotAnId},
    rows::{AskForFrame, Row, RowStore},
    shelf::Shelf,
    trace::{Edge, Trace},
    watch::{Watch, Watchers},
};
