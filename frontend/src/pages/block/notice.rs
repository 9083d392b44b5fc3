//! What went wrong with the last command, and the choice when two people changed one block.

use std::rc::Rc;

use cipdeck_shared::{
    api::{Problem, ProblemCode},
    config::Block,
};
use serde::Serialize;
use yew::prelude::*;

use crate::{
    desk::{Desk, Local},
    editor::{Editable, Kind},
    hooks::use_notice_of,
    i18n::{PROBLEM, find, tr},
    notice::Notice,
    store::DeckId,
};

#[derive(Clone, PartialEq, Properties)]
pub(crate) struct NoticeBarProps {
    pub(crate) id: DeckId,
}

/// Nothing, a problem, or a conflict.
#[component]
pub(crate) fn NoticeBar<D: Editable, L: Local>(props: &NoticeBarProps) -> Html {
    let desk = use_context::<Desk<D, L>>().expect("the document provides its desk");
    let id = props.id;
    match use_notice_of(&desk, id) {
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
        Some(Notice::Conflict(current)) => conflict(&desk, id, &current),
    }
}

/// A problem for people.
pub(crate) fn words(problem: &Problem) -> String {
    let code = problem.code.word();
    // The detail of a relay is for people, too; ours is the one that the page translates.
    match (find(PROBLEM, &format!("code_{code}")), &problem.code) {
        (Some(words), ProblemCode::Findings | ProblemCode::NotFound) => words.to_owned(),
        (Some(words), _) if problem.detail.is_empty() => words.to_owned(),
        (Some(words), _) => format!("{}: {}", words.trim_end_matches('.'), problem.detail),
        (None, _) => format!("{}: {}", problem.title, problem.detail),
    }
}

/// Both versions, member by member where they differ.
fn conflict<D: Editable, L: Local>(desk: &Desk<D, L>, id: DeckId, current: &Rc<Block>) -> Html {
    let on_mine = {
        let (desk, current) = (desk.clone(), current.clone());
        move |_: MouseEvent| desk.save_over(id, &current)
    };
    let on_theirs = {
        let (desk, current) = (desk.clone(), current.clone());
        move |_: MouseEvent| {
            desk.rows().put_stored((*current).clone());
            desk.revert(id);
        }
    };
    let both = desk.draft(id).zip(D::Config::of_block(&current.config));
    let rows = both.map(|(mine, theirs)| differences(mine.config(), theirs)).unwrap_or_default();
    choice(current.revision, &rows, on_mine.into(), on_theirs.into())
}

/// What differs, and whose shall stay.
fn choice(
    revision: u64,
    rows: &[Difference],
    on_mine: Callback<MouseEvent>,
    on_theirs: Callback<MouseEvent>,
) -> Html {
    html! {
        <div class="notice conflict" role="alert" data-test="conflict">
            <p>{ tr!("conflict.text", revision = revision) }</p>
            <table class="differences">
                <thead><tr><th>{ tr!("conflict.member") }</th><th>{ tr!("conflict.mine") }</th><th>{ tr!("conflict.theirs") }</th></tr></thead>
                <tbody>{ for rows.iter().map(|(member, mine, theirs)| html! {
                    <tr><th scope="row">{ member }</th><td>{ mine }</td><td>{ theirs }</td></tr>
                }) }</tbody>
            </table>
            <div class="choices">
                <button type="button" class="button" onclick={on_mine} data-test="keep-mine">{ tr!("conflict.keep_mine") }</button>
                <button type="button" class="button" onclick={on_theirs} data-test="take-theirs">{ tr!("conflict.take_theirs") }</button>
            </div>
        </div>
    }
}

/// A member, and both values.
type Difference = (String, String, String);

/// Members that differ, with both values as JSON has them.
fn differences<C: Serialize>(mine: &C, theirs: &C) -> Vec<Difference> {
    // Through text: a second way to write JSON would cost more of the page than this costs of the time.
    let value = |config: &C| {
        let text = serde_json::to_string(config).unwrap_or_default();
        serde_json::from_str::<serde_json::Value>(&text).unwrap_or_default()
    };
    let mut found = Vec::new();
    compare("", &value(mine), &value(theirs), &mut found);
    found
}

fn compare(path: &str, mine: &serde_json::Value, theirs: &serde_json::Value, found: &mut Vec<Difference>) {
    if let (Some(mine), Some(theirs)) = (mine.as_object(), theirs.as_object()) {
        let nothing = serde_json::Value::Null;
        let members = mine.keys().chain(theirs.keys().filter(|member| !mine.contains_key(*member)));
        for member in members {
            let path = if path.is_empty() { member.clone() } else { format!("{path}.{member}") };
            let (mine, theirs) =
                (mine.get(member).unwrap_or(&nothing), theirs.get(member).unwrap_or(&nothing));
            compare(&path, mine, theirs, found);
        }
    } else if mine != theirs {
        found.push((path.to_owned(), mine.to_string(), theirs.to_string()));
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use cipdeck_shared::config::MsgCipGeneric;

    #[test]
    fn only_members_that_differ_are_shown() {
        let mine = MsgCipGeneric::product_name("0,0");
        let mut theirs = mine.clone();
        theirs.app_cfg.attribute = 6;
        theirs.req_length = Some(0);
        let expected = [("AppCfg.Attribute", "7", "6"), ("ReqLength", "null", "0")];
        let found = differences(&mine, &theirs);
        let found: Vec<_> = found.iter().map(|(a, b, c)| (a.as_str(), b.as_str(), c.as_str())).collect();
        assert_eq!(found, expected);
    }
}
