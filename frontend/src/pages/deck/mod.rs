//! The deck: the list of blocks beside the chosen one. Without blocks: the first start.

mod dialogs;
mod first_start;
mod list;

use yew::prelude::*;
use yew_router::prelude::*;

use self::{first_start::FirstStart, list::BlockList};
use crate::{
    hooks::{use_ids, use_link, use_row, use_workbench},
    i18n::tr,
    pages::block::BlockPane,
    route::Route,
    store::DeckId,
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
    // Renders again when it is known whether there is a relay.
    use_link();
    if ids.is_empty() && bench.relay().is_undecided() {
        return html! { <p class="waiting" role="status">{ tr!("deck.connecting") }</p> };
    }
    match props.id {
        None if ids.is_empty() => html! { <FirstStart /> },
        None => html! {
            <div class="deck">
                <BlockList {ids} />
                <p class="empty">{ tr!("deck.choose") }</p>
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
    let there = use_row(id).is_some();
    if there {
        return html! { <BlockPane key={id.to_string()} {id} /> };
    }
    if let Some(to) = bench.moved(id) {
        return html! { <Redirect<Route> to={Route::Block { id: to.to_string() }} /> };
    }
    if bench.relay().is_undecided() {
        return html! { <p class="empty" role="status">{ tr!("deck.connecting") }</p> };
    }
    html! { <div class="empty"><h1>{ tr!("deck.gone_title") }</h1><p>{ tr!("deck.gone") }</p></div> }
}
