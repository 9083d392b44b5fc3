//! What is shown while there is no answer, and where the answer is no.

use std::rc::Rc;

use cipdeck_shared::api::Problem;
use yew::prelude::*;

use crate::{
    office::{fetch::Fetched, i18n::tr},
    pages::block::words,
};

/// Why something was not done.
pub fn problem_note(problem: Option<&Rc<Problem>>) -> Html {
    problem.map_or_else(Html::default, |problem| {
        html! {
            <p class="finding error" role="alert" data-test="problem" data-code={problem.code.word().to_owned()}>
                { words(problem) }
            </p>
        }
    })
}

/// While there is no first answer: that it is asked for, or why there is none.
pub fn waiting<T>(fetched: &Fetched<T>) -> Html {
    match (&fetched.data, &fetched.problem) {
        (_, Some(problem)) => problem_note(Some(problem)),
        (None, None) => html! { <p class="hint" role="status">{ tr!("fetch.waiting") }</p> },
        (Some(_), None) => html! {},
    }
}

/// A quiet sentence.
pub fn note(words: AttrValue) -> Html {
    html! { <p class="hint">{ words }</p> }
}
