//! What became of a write: what was there, what was written, and what is there now.

use cipdeck_shared::api::{ReadValue, Written};
use yew::prelude::*;

use super::write_dialog::value;
use crate::{i18n::tr, kit::Shape};

/// Old, new, read back, and whether they are the same. That they are not must not be missed.
pub(crate) fn written(written: &Written) -> Html {
    let (class, shape, verdict) = match written.is_equal {
        Some(true) => ("written tick", Shape::Tick, tr!("written.equal")),
        Some(false) => ("written cross", Shape::Cross, tr!("written.different")),
        None => ("written half", Shape::Half, tr!("written.unknown")),
    };
    let row = |words: AttrValue, test: &'static str, it: &Option<ReadValue>| {
        html! { <><dt>{ words }</dt><dd data-test={test}>{ it.as_ref().map_or_else(|| tr!("written.none").into(), value) }</dd></> }
    };
    html! {
        <div class={class} data-test="written" role={(written.is_equal == Some(false)).then_some("alert")}>
            <p class="written-verdict">{ shape.draw() }<b>{ verdict }</b></p>
            <dl class="facts">
                { row(tr!("written.old"), "written-old", &written.old) }
                { row(tr!("written.new"), "written-new", &written.new) }
                { row(tr!("written.read_back"), "written-read-back", &written.read_back) }
            </dl>
        </div>
    }
}
