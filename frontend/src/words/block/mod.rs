//! One block: edited on the left, drawn on the right with its live words.

mod activity;
mod address;
mod data;
mod drawing;
mod fields;
mod form;
mod head;
mod live_words;
mod management;
mod outcome;
mod subject;
mod word_text;

use std::rc::Rc;

use cipdeck_shared::api::BlockStatus;
use yew::prelude::*;

use self::{
    activity::activity, drawing::drawing, form::Form, head::Head, live_words::live_words, outcome::Outcome,
    subject::Subject,
};
use super::{
    desk::Desk,
    edit::Draft,
    hooks::{use_desk, use_draft, use_link, use_row},
    i18n::tr,
    route::{self, Page, link, redirect},
    verdict::Verdict,
};
use crate::{
    desk::Gone,
    hooks::use_title,
    kit::state_mark,
    net::{rest, session},
    pages::{block::NoticeBar, connection::stale_note},
    store::{DeckId, Row},
};

/// Which block.
#[derive(Clone, Debug, PartialEq, Properties)]
pub(super) struct BlockPageProps {
    pub(super) id: DeckId,
}

/// The block, where it has gone, or that it is none of this document.
#[component]
pub(super) fn BlockPage(props: &BlockPageProps) -> Html {
    let desk = use_desk();
    let id = props.id;
    use_link();
    match use_row(id) {
        Some(row) if row.config.as_send_req().is_some() => html! { <Block key={id.to_string()} {id} /> },
        Some(_) => html! {
            <div class="empty">
                <h1>{ tr!("block.other_kind") }</h1>
                <p><a href={format!("/deck/{id}")}>{ tr!("block.in_deck") }</a></p>
            </div>
        },
        None => match desk.gone(id) {
            Some(Gone::Stored(to)) => redirect(Page::Block(to)),
            Some(Gone::Deleted) => redirect(Page::All),
            None if desk.relay().is_undecided() => {
                html! { <p class="empty" role="status">{ tr!("deck.connecting") }</p> }
            }
            None => missing(&desk, id),
        },
    }
}

/// An entry that is not there; what was changed in it can be kept.
fn missing(desk: &Desk, id: DeckId) -> Html {
    let has_draft = desk.drafts().draft(id).is_some();
    let desk = desk.clone();
    let on_rescue = move |_: MouseEvent| {
        if let Some(id) = desk.rescue(id) {
            route::go(Page::Block(id));
        }
    };
    html! {
        <div class="empty" data-test="missing">
            <h1>{ tr!("deck.gone_title") }</h1>
            <p>{ tr!("deck.gone") }</p>
            if has_draft {
                <button type="button" class="button" onclick={on_rescue}>{ tr!("deck.rescue") }</button>
            }
            <p>{ link(Page::All, "", html! { tr!("block.back") }) }</p>
        </div>
    }
}

/// Everything about one block.
#[component]
fn Block(props: &BlockPageProps) -> Html {
    let id = props.id;
    let desk = use_desk();
    let (row, draft) = (use_row(id), use_draft(id));
    use_link();
    let online = desk.relay().is_online();
    let config = row.as_ref().map(|row| (row.config.clone(), row.revision));
    let subject = use_memo((id, config, draft, online, session::view()), {
        let desk = desk.clone();
        move |_| Subject::of(&desk, id)
    });
    let edit = use_callback((desk.clone(), id), |edit, (desk, id)| desk.edit(*id, edit));
    use_title((*subject).as_ref().map_or("", |subject| &subject.draft.config.name));
    let Some((row, subject)) = row.zip((*subject).clone()) else { return html! {} };
    let subject = Rc::new(subject);
    html! {
        <article class="block words-block" aria-label={subject.draft.config.name.clone()}>
            <h1 class="unseen">{ &subject.draft.config.name }</h1>
            <Head subject={subject.clone()} status={row.status.clone()} edit={edit.clone()} />
            <NoticeBar<Draft, ()> {id} />
            <Form subject={subject.clone()} {edit} />
            { live(&desk, &subject, &row) }
        </article>
    }
}

/// The right side: what the program sees.
fn live(desk: &Desk, subject: &Subject, row: &Rc<Row>) -> Html {
    let status = &row.status;
    let words = status.words.as_ref();
    let form = subject.draft.config.form();
    let sent =
        row.config.as_send_req().and_then(|it| it.management_param.get(3)).copied().unwrap_or_default();
    let is_stale = subject.id.stored().is_some() && !subject.online;
    html! {
        <section class={classes!("live", is_stale.then_some("stale"))}>
            <div class="live-state">
                { state_mark(status.phase, false) }
                { links(subject, status) }
            </div>
            if status.position > 0 {
                <p class="hint" data-test="position">{ tr!("run.position", position = status.position) }</p>
            }
            if subject.id.stored().is_some() {
                { stale_note(&desk.relay().link()) }
            }
            { drawing(subject, status.input, words) }
            { activity(if status.input && subject.is_cyclic() { row.trace.steady() } else { row.trace.newest() }) }
            if let Some(words) = words {
                <h2>{ "Management_Param" }</h2>
                { live_words(form, words, Verdict::of(status), sent) }
            }
            <Outcome {form} row={row.clone()} />
        </section>
    }
}

/// What only a relay has: the frames and the history of a block that has run.
fn links(subject: &Subject, status: &BlockStatus) -> Html {
    let Some(id) = subject.id.stored().filter(|_| subject.online && status.runs > 0) else { return html! {} };
    html! {
        <span class="live-links">
            <a class="download" href={format!("/office/history/{id}")} data-test="history">{ tr!("bytes.history") }</a>
            <a class="download" href={rest::capture(id)} download="" title={tr!("bytes.download_title")} data-test="pcapng">{ tr!("bytes.download") }</a>
        </span>
    }
}
