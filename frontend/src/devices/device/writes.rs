//! What was written to a device, the newest first.

use cipdeck_shared::{api::WriteEntry, config::DeviceId};
use yew::prelude::*;

use crate::{
    browser,
    devices::i18n::tr,
    kit::Shape,
    office::{
        fetch::use_fetched,
        kit::{note, waiting},
    },
};

#[derive(Clone, PartialEq, Properties)]
pub(super) struct WritesProps {
    pub(super) device: DeviceId,
}

/// A table; asked for when the page is opened, and again with a button.
#[component]
pub(super) fn Writes(props: &WritesProps) -> Html {
    let writes = use_fetched::<Vec<WriteEntry>>(format!("devices/{}/writes", props.device));
    let again = writes.reload.reform(|_: MouseEvent| ());
    html! {
        <section class="panel" data-test="writes">
            <div class="panel-head">
                <h2>{ tr!("writes.title") }</h2>
                <button type="button" class="tool" onclick={again}>{ tr!("fetch.again") }</button>
            </div>
            { waiting(&writes) }
            if let Some(all) = &writes.data {
                if all.is_empty() {
                    { note(tr!("writes.none")) }
                } else {
                    <div class="scroll"><table class="listing" aria-label={tr!("writes.title")}>
                        <thead><tr>
                            <th scope="col">{ tr!("writes.at") }</th><th scope="col">{ tr!("writes.who") }</th>
                            <th scope="col">{ tr!("writes.variable") }</th><th scope="col" class="num">{ tr!("writes.old") }</th>
                            <th scope="col" class="num">{ tr!("writes.new") }</th><th scope="col" class="num">{ tr!("writes.read_back") }</th>
                            <th scope="col">{ tr!("writes.result") }</th>
                        </tr></thead>
                        <tbody>{ for all.iter().map(line) }</tbody>
                    </table></div>
                }
            }
        </section>
    }
}

fn line(entry: &WriteEntry) -> Html {
    let value = |text: &Option<String>| text.clone().unwrap_or_else(|| "–".to_owned());
    html! {
        <tr data-test="write-line">
            <td class="number-time">{ browser::date_and_time(&entry.at) }</td>
            <td>{ &entry.actor }</td>
            <th scope="row">{ &entry.name }<br /><span class="quiet mono">{ &entry.address }</span></th>
            <td class="num">{ value(&entry.old) }</td>
            <td class="num">{ value(&entry.new) }</td>
            <td class="num">{ value(&entry.read_back) }</td>
            <td>{ result(entry) }</td>
        </tr>
    }
}

fn result(entry: &WriteEntry) -> Html {
    let (shape, class, words) = match (entry.is_done, entry.is_equal) {
        (false, _) => {
            (Shape::Cross, "cross", entry.reason.clone().map_or(tr!("writes.refused"), AttrValue::from))
        }
        (true, Some(true)) => (Shape::Tick, "tick", tr!("writes.equal")),
        (true, Some(false)) => (Shape::Half, "half", tr!("writes.different")),
        (true, None) => (Shape::Half, "half", tr!("writes.unread")),
    };
    html! { <span class={classes!("state", class)}>{ shape.draw() }<span>{ words }</span></span> }
}
