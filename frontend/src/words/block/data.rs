//! `Data_to_Send`: as fields and as words, each showing the other.

use std::rc::Rc;

use cipdeck_shared::{config::bytes_of, plan::Field};
use yew::prelude::*;

use super::{fields::fields, subject::Subject, word_text::WordText};
use crate::{
    invisible,
    words::{
        edit::{Edit, Fields},
        explain,
        grid::WordGrid,
        i18n::tr,
    },
};

#[derive(Clone, PartialEq, Properties)]
pub(super) struct DataFormProps {
    pub(super) subject: Rc<Subject>,
    pub(super) edit: Callback<Edit>,
}

/// Words above, each byte explained; the same as fields below.
#[component]
pub(super) fn DataForm(props: &DataFormProps) -> Html {
    let DataFormProps { subject, edit } = props;
    let draft = &subject.draft;
    let read = draft.fields();
    let why = match &read {
        Fields::Of(_) | Fields::Empty => None,
        Fields::Unreadable => Some(tr!("data.unreadable")),
        Fields::NoRequest(error) => Some(tr!("data.no_request", why = error)),
    };
    html! { <>
        <div class="part-head"><h3>{ tr!("data.words") }</h3></div>
        { waiting(subject, edit) }
        <WordText text={draft.config.data_to_send.clone()} remarks={Rc::new(subject.remarks_of("Data_to_Send"))} edit={edit.clone()} />
        { grid(subject) }
        <fieldset class="plain" disabled={why.is_some()}>
            <div class="part-head">
                <h3>{ tr!("data.fields") }</h3>
                { path_choice(subject, edit) }
            </div>
            if let Some(why) = why {
                <p class="warning-text" role="status" data-test="fields-locked">{ why }</p>
            }
            { fields(subject, edit) }
        </fieldset>
    </> }
}

/// A path of numbers, or bytes.
fn path_choice(subject: &Subject, edit: &Callback<Edit>) -> Html {
    let draft = &subject.draft;
    let needs_bytes = draft.needs_raw_path();
    let choice = |raw: bool, words: AttrValue| {
        let onchange = edit.reform(move |_: Event| Edit::RawPath(raw));
        html! {
            <label title={(needs_bytes && !raw).then_some(tr!("data.only_bytes"))}>
                <input type="radio" name="path-as" checked={draft.raw_path == raw} disabled={needs_bytes && !raw} {onchange} data-test={if raw { "path-bytes" } else { "path-numbers" }} />
                { words }
            </label>
        }
    };
    html! {
        <span class="path-choice" role="radiogroup" aria-label={tr!("data.path_as")}>
            <span class="quiet">{ tr!("data.path_as") }</span>
            { choice(false, tr!("data.path_numbers")) }
            { choice(true, tr!("data.path_bytes")) }
        </span>
    }
}

/// What is in the fields, and cannot be in the words yet.
fn waiting(subject: &Subject, edit: &Callback<Edit>) -> Html {
    let waiting = subject.draft.waiting_parts();
    if waiting.is_empty() {
        return html! {};
    }
    let texts: Vec<_> =
        waiting.iter().map(|(part, text)| format!("{} “{}”", part.word(), invisible::shown(text))).collect();
    let onclick = edit.reform(|_: MouseEvent| Edit::ForgetParts);
    html! {
        <p class="warning-text" role="status" data-test="waiting-parts">
            { tr!("data.waiting", texts = texts.join(", ")) }{ " " }
            <button type="button" class="tool" {onclick} data-test="forget-parts">{ tr!("data.forget") }</button>
        </p>
    }
}

/// The words with their explanation, as far as they can be read.
fn grid(subject: &Subject) -> Html {
    let draft = &subject.draft;
    let Some(words) = draft.words().filter(|words| !words.is_empty()) else { return html! {} };
    let bytes = bytes_of(&words);
    let readable = subject
        .remarks_of(&Field::ManagementParam(3).to_string())
        .iter()
        .all(|it| it.rule != "unreadable_number");
    let sent = usize::try_from(draft.length()).ok().filter(|sent| readable && *sent <= bytes.len());
    let sent = sent.unwrap_or(bytes.len());
    let tree = Rc::new(explain::data_to_send(draft.config.form(), &bytes, sent));
    let drawn: Rc<[u16]> = words.iter().copied().take(MOST_DRAWN).collect();
    let left = words.len() - drawn.len();
    html! { <>
        <WordGrid label="Data_to_Send" words={drawn} {tree} bytes={sent} test="sent-words" />
        if left > 0 {
            <p class="hint" data-test="words-left">{ tr!("data.left", count = left) }</p>
        }
    </> }
}

/// Words with a cell each. More are sent all the same.
const MOST_DRAWN: usize = 512;
