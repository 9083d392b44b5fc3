//! How components learn of changes outside the virtual DOM.

use std::rc::Rc;

use yew::prelude::*;

use super::{desk::Desk, edit::Draft};
use crate::{
    hooks::{use_draft_of, use_link_of, use_row_of},
    net::Link,
    store::{DeckId, Row},
};

/// The document's state, from the context.
#[hook]
pub(super) fn use_desk() -> Desk {
    use_context::<Desk>().expect("the document provides a Desk")
}

/// The connection.
#[hook]
pub(super) fn use_link() -> Link {
    let desk = use_desk();
    use_link_of(desk.relay())
}

/// One row; renders once in a frame in which it has changed.
#[hook]
pub(super) fn use_row(id: DeckId) -> Option<Rc<Row>> {
    let desk = use_desk();
    use_row_of(desk.rows(), id)
}

/// All blocks of this document; renders when one comes or goes.
#[hook]
pub(super) fn use_ids() -> Vec<DeckId> {
    let desk = use_desk();
    let update = use_force_update();
    use_effect_with(desk.clone(), move |desk| {
        let watch = desk.rows().watch_ids(Callback::from(move |()| update.force_update()));
        move || drop(watch)
    });
    desk.ids()
}

/// The draft of an entry, if it has one.
#[hook]
pub(super) fn use_draft(id: DeckId) -> Option<Rc<Draft>> {
    let desk = use_desk();
    use_draft_of(&desk, id)
}
