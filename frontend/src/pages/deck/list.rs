//! The list of blocks, and what can be done with the chosen one.

use std::rc::Rc;

use cipdeck_shared::{api::Role, config::MsgCipGeneric};
use web_sys::HtmlInputElement;
use yew::prelude::*;

use super::dialogs::{Asked, Question};
use crate::{
    browser,
    hooks::{use_draft, use_row, use_session, use_workbench},
    i18n::tr,
    kit::state_mark,
    net::session,
    route::{self, Route},
    store::DeckId,
};

#[derive(Clone, PartialEq, Properties)]
pub(super) struct BlockListProps {
    pub(super) ids: Rc<[DeckId]>,
    #[prop_or_default]
    pub(super) chosen: Option<DeckId>,
}

/// Buttons, filter, and one line per block.
#[component]
pub(super) fn BlockList(props: &BlockListProps) -> Html {
    let bench = use_workbench();
    let asked = use_state(|| None::<Asked>);
    let filter = use_state(String::new);
    let open = use_callback((), |id: DeckId, ()| route::go(Route::Block(id)));
    let on_new = use_callback((bench.clone(), open.clone()), |_: MouseEvent, (bench, open)| {
        let name = tr!("list.new_name").to_string();
        open.emit(bench.add(MsgCipGeneric { name, ..MsgCipGeneric::product_name("0,0") }));
    });
    let on_duplicate =
        use_callback((bench.clone(), open.clone(), props.chosen), |_: MouseEvent, (bench, open, chosen)| {
            if let Some(draft) = chosen.and_then(|id| bench.draft(id)) {
                open.emit(bench.add(draft.config));
            }
        });
    let ask = |question: fn(DeckId) -> Asked| {
        let (asked, chosen) = (asked.clone(), props.chosen);
        Callback::from(move |_: MouseEvent| asked.set(chosen.map(question)))
    };
    let on_paste = {
        let asked = asked.clone();
        Callback::from(move |_: MouseEvent| asked.set(Some(Asked::Paste)))
    };
    let on_answered = use_callback((asked.clone(), open), |added: Option<DeckId>, (asked, open)| {
        asked.set(None);
        if let Some(id) = added {
            open.emit(id);
        }
    });
    let oninput = use_callback(filter.clone(), |event: InputEvent, filter| {
        filter.set(event.target_unchecked_into::<HtmlInputElement>().value());
    });
    use_session();
    let obstacle = (!session::may(Role::may_edit)).then_some(tr!("may.not_edit"));
    let (locked, none) = (obstacle.is_some(), obstacle.is_some() || props.chosen.is_none());
    let no_copy = props.chosen.is_none();
    let action = |test: &'static str, words: AttrValue, onclick: Callback<MouseEvent>, disabled: bool| {
        let title = obstacle.clone().filter(|_| disabled);
        html! {
            <button type="button" class="tool" data-test={test} {onclick} {disabled} {title}>{ words }</button>
        }
    };
    html! {
        <aside class="list" aria-label={tr!("list.label")}>
            <button type="button" class="button wide" data-test="new-block" disabled={locked} title={obstacle.clone()} onclick={on_new}>{ tr!("list.new") }</button>
            <div class="tools">
                { action("duplicate", tr!("list.duplicate"), on_duplicate, none) }
                { action("rename", tr!("list.rename"), ask(Asked::Rename), none) }
                { action("copy", tr!("list.copy"), ask(Asked::Copy), no_copy) }
                { action("paste", tr!("list.paste"), on_paste, locked) }
                { action("delete", tr!("list.delete"), ask(Asked::Delete), none) }
            </div>
            <input
                class="input filter" type="search" placeholder={tr!("list.filter")} aria-label={tr!("list.filter")}
                value={(*filter).clone()} {oninput} data-test="filter"
            />
            <ul class="entries">
                { for props.ids.iter().map(|id| html! {
                    <Entry key={id.to_string()} id={*id} chosen={props.chosen == Some(*id)} filter={AttrValue::from((*filter).clone())} />
                }) }
            </ul>
            if let Some(asked) = *asked {
                <Question {asked} {on_answered} />
            }
        </aside>
    }
}

#[derive(Clone, PartialEq, Properties)]
struct EntryProps {
    id: DeckId,
    chosen: bool,
    filter: AttrValue,
}

/// One block: its state, its name, and whether it holds something that is not stored.
#[component]
fn Entry(props: &EntryProps) -> Html {
    let bench = use_workbench();
    let (row, draft) = (use_row(props.id), use_draft(props.id));
    let Some(row) = row else { return html! {} };
    let texts = draft.as_ref().map_or([row.config.name(), row.config.target_text()], |draft| {
        [&draft.config.name, &draft.config.target_cfg.path]
    });
    if !browser::is_found(&props.filter, texts) {
        return html! {};
    }
    html! {
        <li class={classes!("entry", props.chosen.then_some("chosen"))} data-test="entry">
            { route::block_link(&row, html! { <>
                { state_mark(row.status.phase, true) }
                <span class="entry-name">{ texts[0] }</span>
                if bench.is_unsaved(props.id) {
                    <span class="entry-draft">{ tr!("list.unsaved") }</span>
                }
            </> }) }
        </li>
    }
}
