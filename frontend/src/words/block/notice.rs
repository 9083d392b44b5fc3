//! What went wrong with the last command, and the choice when two people changed one block.

use std::rc::Rc;

use yew::prelude::*;

use super::subject::Subject;
use crate::{
    notice::Notice,
    pages::block::{choice, differences, words},
    store::DeckId,
    words::{
        hooks::{use_desk, use_notice},
        i18n::tr,
    },
};

#[derive(Clone, PartialEq, Properties)]
pub(super) struct NoticeBarProps {
    pub(super) id: DeckId,
    pub(super) subject: Rc<Subject>,
}

/// Nothing, a problem, or a conflict.
#[component]
pub(super) fn NoticeBar(props: &NoticeBarProps) -> Html {
    let desk = use_desk();
    let id = props.id;
    match use_notice(id) {
        None => html! {},
        Some(Notice::Problem(problem)) => {
            let on_dismiss = move |_: MouseEvent| desk.notices().clear(id);
            html! {
                <div class="notice" role="alert" data-test="problem" data-code={problem.code.word().to_owned()}>
                    <p>{ words(&problem) }</p>
                    <button type="button" class="quiet-button" onclick={on_dismiss}>{ tr!("notice.dismiss") }</button>
                </div>
            }
        }
        Some(Notice::Conflict(current)) => {
            let mine = &props.subject.draft.config;
            let theirs = current.config.as_send_req();
            let rows = theirs.map(|theirs| differences(mine, theirs)).unwrap_or_default();
            let on_mine = {
                let (desk, current) = (desk.clone(), current.clone());
                Callback::from(move |_: MouseEvent| desk.save_over(id, &current))
            };
            let revision = current.revision;
            let on_theirs = Callback::from(move |_: MouseEvent| {
                desk.rows().put_stored((*current).clone());
                desk.revert(id);
            });
            choice(revision, &rows, on_mine, on_theirs)
        }
    }
}
