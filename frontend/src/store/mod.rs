//! What the page shows, kept outside the virtual DOM.

mod deck_id;
mod rows;
mod trace;
mod watch;

pub use self::{
    deck_id::{DeckId, NotAnId},
    rows::{AskForFrame, Row, RowStore},
    trace::{Edge, Trace},
    watch::{Watch, Watchers},
};
