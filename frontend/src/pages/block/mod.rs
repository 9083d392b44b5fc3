//! One block: edited on the left, drawn on the right, its bytes and their meaning below.

mod axis;
mod choices;
mod codes;
mod commands;
mod drawing;
mod exchange;
mod fields;
mod form;
mod head;
mod keys;
mod notice;
mod outcome;
mod subject;
mod trouble;
mod way;
mod window_form;
mod write_dialog;
mod written;

use std::rc::Rc;

use yew::prelude::*;

use self::{
    axis::axis,
    drawing::drawing,
    exchange::{Exchange, is_earlier},
    form::Form,
    head::Head,
    outcome::Outcome,
    subject::Subject,
};
use crate::{
    demo::Demo,
    editor::Draft,
    hooks::{use_draft, use_link, use_row, use_workbench},
    i18n::tr,
    kit::{state_mark, status_bits},
    net::session,
    pages::connection::StaleNote,
    route,
    store::{DeckId, Row},
};

pub(crate) use self::{
    axis::duration,
    choices::{channel_field, profile_field},
    codes::error_words,
    commands::{Asks, Commanded, Commands},
    notice::{NoticeBar, words},
    outcome::{age_words, decode, decoded, whole},
    trouble::{acted, explain},
    written::written,
};

/// Which block.
#[derive(Clone, Debug, PartialEq, Properties)]
pub struct BlockPaneProps {
    /// An entry that exists.
    pub id: DeckId,
}

/// Everything about one block.
#[component]
pub fn BlockPane(props: &BlockPaneProps) -> Html {
    let id = props.id;
    let bench = use_workbench();
    let (row, draft) = (use_row(id), use_draft(id));
    use_link();
    exchange::use_exchange(id, row.as_ref().map_or(0, |row| row.status.runs));
    let online = bench.relay().is_online();
    let config = row.as_ref().map(|row| (row.config.clone(), row.revision));
    let known = row.as_ref().and_then(|row| bench.relay().targets().profile(row.config.target_text()));
    let subject = use_memo((id, config, draft, online, known, session::view()), {
        let bench = bench.clone();
        move |_| Subject::of(&bench, id)
    });
    let edit = use_callback((bench, id), |edit, (bench, id)| bench.edit(*id, edit));
    let Some(row) = row else { return html! {} };
    let Some(subject) = (*subject).clone() else { return elsewhere(&row) };
    let subject = Rc::new(subject);
    let repeats = row.status.input && subject.is_cyclic();
    // The bytes of a block that repeats are always a moment old.
    let earlier = !repeats && row.exchange.as_ref().is_some_and(|exchange| is_earlier(exchange, &row.status));
    html! {
        <article class="block" aria-label={subject.draft.config.name.clone()}>
            <h1 class="unseen">{ &subject.draft.config.name }</h1>
            <Head subject={subject.clone()} status={row.status.clone()} edit={edit.clone()} />
            <NoticeBar<Draft, Demo> {id} />
            <Form subject={subject.clone()} {edit} />
            <section class="live">
                <div class="live-state">
                    { state_mark(row.status.phase, false) }
                    { status_bits(row.status.status.status_bits) }
                </div>
                if row.status.position > 0 {
                    <p class="hint" data-test="position">{ tr!("run.position", position = row.status.position) }</p>
                }
                <StaleNote stored={id.stored().is_some()} />
                { drawing(&subject, &row.status) }
                { axis(if repeats { row.trace.steady() } else { row.trace.newest() }) }
                <Outcome row={row.clone()} />
            </section>
            <section class="bytes" aria-label={tr!("bytes.label")}>
                <Exchange subject={subject.clone()} exchange={row.exchange.clone()} {earlier} has_run={row.status.runs > 0} />
            </section>
        </article>
    }
}

/// A block that this document does not edit: the way to the one that does.
fn elsewhere(row: &Row) -> Html {
    html! {
        <div class="empty">
            <h1>{ row.config.name() }</h1>
            <p>{ route::block_link(row, html! { row.config.kind() }) }</p>
        </div>
    }
}
