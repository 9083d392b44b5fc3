//! What the page shows, kept outside the virtual DOM.

mod deck_id;
mod rows;
mod shelf;
mod targets;
mod trace;
mod watch;

pub use self::{
    deck_id::{DeckId, NotAnId},
    rows::{AskForFrame, Row, RowStore},
    shelf::Shelf,
    targets::{TargetStore, target_of},
    trace::{Edge, Trace},
    watch::{Watch, Watchers},
};
