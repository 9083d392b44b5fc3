//! What became of a write.

use cipdeck_shared::api::ReadValue;
use yew::prelude::*;

use crate::{
    devices::{api::Done, i18n::tr},
    kit::Shape,
};

/// The verdict first, then old, new and what was read afterwards.
pub(super) fn outcome(done: &Done, on_close: Callback<MouseEvent>) -> Html {
    let written = &done.written;
    let (shape, class, verdict) = match (done.is_done, done.may_have_acted, written.is_equal) {
        (false, true, _) => (Shape::Half, "half", tr!("write_value.perhaps")),
        (false, false, _) => (Shape::Cross, "cross", tr!("writes.refused")),
        (true, _, Some(true)) => (Shape::Tick, "tick", tr!("writes.equal")),
        (true, _, Some(false)) => (Shape::Half, "half", tr!("writes.different")),
        (true, _, None) => (Shape::Half, "half", tr!("writes.unread")),
    };
    let value =
        |value: &Option<ReadValue>| value.as_ref().map_or_else(|| "–".to_owned(), |it| it.text.clone());
    html! { <>
        <div class={classes!("written", class)} role="status" data-test="written">
            <p class="written-verdict">{ shape.draw() }<b>{ verdict }</b></p>
            if let Some(reason) = &done.reason {
                <p data-test="write-reason">{ reason }</p>
            }
        </div>
        <dl class="facts">
            <dt>{ tr!("writes.old") }</dt><dd>{ value(&written.old) }</dd>
            <dt>{ tr!("writes.new") }</dt><dd>{ value(&written.new) }</dd>
            <dt>{ tr!("writes.read_back") }</dt><dd data-test="read-back">{ value(&written.read_back) }</dd>
        </dl>
        <div class="dialog-buttons">
            <button type="button" class="button primary" autofocus=true onclick={on_close} data-test="close">{ tr!("dialog.close") }</button>
        </div>
    </> }
}
