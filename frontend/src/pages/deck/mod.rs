//! The deck: the list of blocks beside the chosen one. Without blocks: the first start.

mod dialogs;
mod first_start;
mod list;

use cipdeck_shared::api::Role;
use yew::prelude::*;

use self::{first_start::FirstStart, list::BlockList};
use crate::{
    desk::Gone,
    hooks::{use_ids, use_link, use_row, use_title, use_workbench},
    i18n::tr,
    net::session,
    pages::block::BlockPane,
    route::{self, Route, redirect},
    store::DeckId,
    workbench::Workbench,
};

/// What is chosen.
#[derive(Clone, Debug, PartialEq, Properties)]
pub struct DeckPageProps {
    /// The chosen entry.
    #[prop_or_default]
    pub id: Option<DeckId>,
}

/// List and block, or the first start.
#[component]
pub fn DeckPage(props: &DeckPageProps) -> Html {
    let bench = use_workbench();
    let ids = use_ids();
    let name = props.id.map(|id| bench.name(id));
    use_title(&name.unwrap_or_default());
    // Renders again when it is known whether there is a relay.
    use_link();
    if ids.is_empty() && bench.relay().is_undecided() {
        return html! { <p class="waiting" role="status">{ tr!("deck.connecting") }</p> };
    }
    match props.id {
        None if ids.is_empty() && !session::may(Role::may_edit) => {
            html! { <div class="empty"><h1>{ tr!("nav.deck") }</h1><p>{ tr!("deck.none_for_you") }</p></div> }
        }
        None if ids.is_empty() => html! { <FirstStart /> },
        None => html! {
            <div class="deck">
                <BlockList {ids} />
                <div class="empty"><h1 class="unseen">{ tr!("nav.deck") }</h1><p>{ tr!("deck.choose") }</p></div>
            </div>
        },
        Some(id) => html! {
            <div class="deck">
                <BlockList {ids} chosen={id} />
                <Chosen {id} />
            </div>
        },
    }
}

#[derive(Clone, PartialEq, Properties)]
struct ChosenProps {
    id: DeckId,
}

/// The chosen block, where it has gone, or that it is gone.
#[component]
fn Chosen(props: &ChosenProps) -> Html {
    let bench = use_workbench();
    let id = props.id;
    if use_row(id).is_some() {
        return html! { <BlockPane key={id.to_string()} {id} /> };
    }
    match bench.gone(id) {
        Some(Gone::Stored(to)) => redirect(Route::Block(to)),
        Some(Gone::Deleted) => redirect(Route::Deck),
        None if bench.relay().is_undecided() => {
            html! { <p class="empty" role="status">{ tr!("deck.connecting") }</p> }
        }
        None => missing(&bench, id),
    }
}

/// An entry that is not there; what was changed in it can be kept.
fn missing(bench: &Workbench, id: DeckId) -> Html {
    let has_draft = bench.drafts().draft(id).is_some();
    let bench = bench.clone();
    let on_rescue = move |_: MouseEvent| {
        if let Some(id) = bench.rescue(id) {
            route::go(Route::Block(id));
        }
    };
    html! {
        <div class="empty">
            <h1>{ tr!("deck.gone_title") }</h1>
            <p>{ tr!("deck.gone") }</p>
            if has_draft {
                <button type="button" class="button" onclick={on_rescue}>{ tr!("deck.rescue") }</button>
            }
        </div>
    }
}
