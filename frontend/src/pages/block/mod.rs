//! One block: edited on the left, drawn on the right, its bytes and their meaning below.

mod axis;
mod codes;
mod commands;
mod drawing;
mod exchange;
mod fields;
mod form;
mod head;
mod notice;
mod outcome;
mod subject;
mod trouble;
mod write_dialog;

use std::rc::Rc;

use yew::prelude::*;

use self::{
    axis::Axis, drawing::Drawing, exchange::Exchange, form::Form, head::Head, notice::NoticeBar,
    outcome::Outcome, subject::Subject,
};
use crate::{
    hooks::{use_draft, use_link, use_row, use_workbench},
    kit::{Bits, StateMark},
    store::DeckId,
};

pub(crate) use self::{
    axis::duration,
    codes::error_words,
    outcome::{age_words, decode},
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
    let subject = use_memo((id, config, draft, online), {
        let bench = bench.clone();
        move |_| Subject::of(&bench, id)
    });
    let Some((row, subject)) = row.zip((*subject).clone()) else { return html! {} };
    let subject = Rc::new(subject);
    let edit = Callback::from(move |edit| bench.edit(id, edit));
    html! {
        <article class="block" aria-label={subject.draft.config.name.clone()}>
            <Head subject={subject.clone()} status={row.status.clone()} edit={edit.clone()} />
            <NoticeBar {id} subject={subject.clone()} />
            <Form subject={subject.clone()} {edit} />
            <section class="live">
                <div class="live-state">
                    <StateMark phase={row.status.phase} />
                    <Bits bits={row.status.status.status_bits} />
                </div>
                <Drawing subject={subject.clone()} status={row.status.clone()} />
                <Axis trace={row.trace.clone()} />
            </section>
            <section class="message">
                <Exchange subject={subject.clone()} exchange={row.exchange.clone()} />
                <Outcome row={row.clone()} />
            </section>
        </article>
    }
}
