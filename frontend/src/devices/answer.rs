//! Why something was not done, in the words of this document.

use std::rc::Rc;

use cipdeck_shared::api::{Problem, ProblemCode};
use yew::prelude::*;

use super::i18n::tr;
use crate::pages::block;

/// Nothing, or what the relay said.
pub(super) fn problem_note(problem: Option<&Rc<Problem>>) -> Html {
    problem.map_or_else(Html::default, |problem| {
        html! {
            <p class="finding error" role="alert" data-test="problem" data-code={problem.code.word().to_owned()}>
                { words(problem) }
            </p>
        }
    })
}

/// The workbench's words speak of blocks.
fn words(problem: &Problem) -> AttrValue {
    match problem.code {
        ProblemCode::Findings => tr!("answer.findings"),
        ProblemCode::NotFound => tr!("answer.not_found", detail = problem.detail),
        ProblemCode::StaleRevision => tr!("answer.stale"),
        _ => block::words(problem).into(),
    }
}
