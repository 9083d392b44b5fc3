//! One run on one line.

use cipdeck_shared::{
    api::HistoryRun,
    config::{Block, space_hex},
};
use yew::prelude::*;

use crate::{
    i18n,
    kit::Shape,
    office::{
        i18n::tr,
        route::{Page, link},
        when,
    },
    pages::block::duration,
};

/// When, of which block, how it ended, and what it said. The block may be gone: then it has its id only.
pub(super) fn run(run: &HistoryRun, blocks: &[Block]) -> Html {
    let name = blocks
        .iter()
        .find(|block| block.id == run.block)
        .map_or_else(|| run.block.to_string(), |block| block.config.name().to_owned());
    let (class, shape, words) = if run.q {
        ("state tick", Shape::Tick, tr!("phase.done").to_string())
    } else {
        ("state cross", Shape::Cross, failure(run))
    };
    html! {
        <tr key={run.id.clone()} data-test="run" data-ok={run.q.to_string()}>
            <td class="number-time" title={run.at.clone()}>{ when(&run.at) }</td>
            <th scope="row">{ link(Page::History(Some(run.block)), "", html! { name }) }</th>
            <td><span class={class}>{ shape.draw() }<span>{ words }</span></span></td>
            <td class="num">{ run.reply_us.map(duration).unwrap_or_default() }</td>
            <td>{ value(run) }</td>
        </tr>
    }
}

/// `224/5: The device answered and refused the request.`
fn failure(run: &HistoryRun) -> String {
    let cause = run.cause.as_deref().unwrap_or_default();
    let words = i18n::find(i18n::CAUSE, cause).unwrap_or(cause);
    let acted = match (run.has_acted, run.may_have_acted) {
        (true, _) => tr!("error.has_acted"),
        (false, true) => tr!("error.may_have_acted"),
        (false, false) => AttrValue::default(),
    };
    format!("{}/{} {words} {acted}", run.error_id, run.sub_error_id)
}

/// Known values in words; otherwise the bytes, which are a fact where a guess is none.
fn value(run: &HistoryRun) -> Html {
    if run.values.iter().any(|value| value.guess) || run.values.is_empty() {
        // Behind service, reserved byte, status and size of the additional status.
        let data =
            run.response.as_deref().filter(|_| run.q).and_then(|reply| reply.get(8..)).unwrap_or_default();
        return html! { <span class="mono">{ space_hex(data).to_ascii_uppercase() }</span> };
    }
    let words: Vec<_> = run.values.iter().map(|value| value.text.as_str()).collect();
    html! { { words.join(" · ") } }
}
