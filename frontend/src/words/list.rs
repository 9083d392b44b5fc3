//! All blocks of words: state, name, target, and what became of the newest exchange.

use cipdeck_shared::api::Role;
use web_sys::HtmlInputElement;
use yew::prelude::*;

use super::{
    hooks::{use_desk, use_draft, use_ids, use_link, use_row},
    i18n::tr,
    route::{Page, link},
    verdict::{Verdict, line},
};
use crate::{
    browser,
    hooks::{use_session, use_title},
    kit::state_mark,
    net::{Link, session},
    pages::{block::age_words, connection::stale_note},
    store::DeckId,
};

/// Filter, a button for one more, and the table.
#[component]
pub(super) fn ListPage() -> Html {
    let desk = use_desk();
    let state = use_link();
    let ids = use_ids();
    use_session();
    use_title(&tr!("list.title"));
    let filter = use_state(String::new);
    let oninput = use_callback(filter.clone(), |event: InputEvent, filter| {
        filter.set(event.target_unchecked_into::<HtmlInputElement>().value());
    });
    if ids.is_empty() && desk.relay().is_undecided() {
        return html! { <p class="waiting" role="status">{ tr!("deck.connecting") }</p> };
    }
    let may_edit = session::may(Role::may_edit);
    html! {
        <div class="words-list">
            <header class="words-list-head">
                <h1>{ tr!("list.title") }</h1>
                if !ids.is_empty() {
                    <input
                        class="input filter" type="search" placeholder={tr!("list.filter")} aria-label={tr!("list.filter")}
                        value={(*filter).clone()} {oninput} data-test="filter"
                    />
                }
                if may_edit {
                    { link(Page::New, "button primary link", html! { tr!("list.new") }) }
                }
            </header>
            { stale_note(&state) }
            if ids.is_empty() {
                <div class="empty" data-test="no-blocks">
                    <h2>{ tr!("list.empty") }</h2>
                    <p>{ if may_edit { tr!("list.empty_text") } else { tr!("deck.none_for_you") } }</p>
                    if let Link::None { .. } = state {
                        <p class="quiet">{ tr!("list.no_relay") }</p>
                    }
                </div>
            } else {
                <table class="table words-table">
                    <thead><tr>
                        <th class="col-state">{ tr!("list.state") }</th>
                        <th class="col-name">{ tr!("field.name") }</th>
                        <th class="col-kind">{ tr!("list.kind") }</th>
                        <th class="col-target">{ "Address" }</th>
                        <th class="col-report">{ tr!("list.report") }</th>
                        <th class="col-age">{ tr!("list.when") }</th>
                    </tr></thead>
                    <tbody>
                        { for ids.iter().map(|id| html! { <Entry key={id.to_string()} id={*id} filter={AttrValue::from((*filter).clone())} /> }) }
                    </tbody>
                </table>
            }
        </div>
    }
}

#[derive(Clone, PartialEq, Properties)]
struct EntryProps {
    id: DeckId,
    filter: AttrValue,
}

/// One block.
#[component]
fn Entry(props: &EntryProps) -> Html {
    let desk = use_desk();
    let (row, draft) = (use_row(props.id), use_draft(props.id));
    let Some(row) = row else { return html! {} };
    let Some(config) = draft.as_ref().map(|draft| &draft.config).or_else(|| row.config.as_send_req()) else {
        return html! {};
    };
    if ![&config.name, &config.address].iter().any(|text| browser::contains(text, &props.filter)) {
        return html! {};
    }
    let status = &row.status;
    let form = config.form();
    let verdict = Verdict::of(status);
    let age = status.at.as_deref().filter(|_| verdict != Verdict::Never).and_then(browser::age_s);
    html! {
        <tr data-test="entry">
            <td class="col-state">{ state_mark(status.phase, false) }</td>
            <td>
                { link(Page::Block(props.id), "entry-link", html! { &config.name }) }
                if desk.is_unsaved(props.id) {
                    <span class="entry-draft">{ " " }{ tr!("list.unsaved") }</span>
                }
            </td>
            <td class="col-kind">{ form.to_string() }</td>
            <td class="col-target mono">{ &config.address }</td>
            <td class={classes!("col-report", format!("is-{}", verdict.word()))}>{ line(form, status) }</td>
            <td class="col-age">{ age.map_or_else(AttrValue::default, age_words) }</td>
        </tr>
    }
}
