//! One block on one line. It knows its id; everything else comes from the store.

use std::rc::Rc;

use cipdeck_shared::config::space_hex;
use yew::prelude::*;

use crate::{
    browser,
    hooks::{use_row, use_second},
    i18n::tr,
    kit::state_mark,
    pages::block::{age_words, decode, duration, error_words},
    route,
    store::{DeckId, Row, target_of},
};

#[derive(Clone, PartialEq, Properties)]
pub(super) struct MonitorRowProps {
    /// `aria-rowindex`
    pub(super) index: usize,
    pub(super) id: DeckId,
    /// Targets that do not answer: a message above the table says why.
    pub(super) down: Rc<[AttrValue]>,
}

/// State, name, target, value, age, runs, reply time, error.
#[component]
pub(super) fn MonitorRow(props: &MonitorRowProps) -> Html {
    let row = use_row(props.id);
    use_second(row.as_ref().is_some_and(|row| row.status.last.is_some()));
    let Some(row) = row else { return html! {} };
    let status = &row.status;
    let reply = status.reply_us.map(duration).unwrap_or_default();
    let target = target_of(row.config.target_text()).unwrap_or_default();
    let told_above = status.status.error_id != REFUSED && props.down.iter().any(|down| **down == *target);
    let error = match (status.status.error, told_above) {
        (false, _) => String::new(),
        (true, true) => tr!("monitor.down", code = status.status.error_id).to_string(),
        (true, false) => error_words(&status.status),
    };
    let age = status.last.as_ref().and_then(|last| browser::age_s(&last.at)).map(age_words);
    html! {
        <tr aria-rowindex={props.index.to_string()} data-test="monitor-row" data-block={props.id.to_string()}>
            <td class="col-state">{ state_mark(status.phase, false) }</td>
            <th scope="row" class="col-name">
                { route::block_link(&row, html! { row.config.name() }) }
            </th>
            <td class="col-target mono">{ row.config.target_text() }</td>
            <td class={classes!("col-value", (!status.q).then_some("stale"))}>{ value(&row) }</td>
            <td class="col-age">{ age.unwrap_or_default() }</td>
            <td class="col-runs">{ status.runs }</td>
            <td class="col-reply">{ reply }</td>
            <td class={classes!("col-error", told_above.then_some("quiet"))} title={error.clone()}>{ error }</td>
        </tr>
    }
}

/// `ErrorID` of a message that a device has answered.
const REFUSED: u16 = 224;

/// The newest good value on one line.
fn value(row: &Row) -> String {
    let Some(last) = &row.status.last else { return String::new() };
    let values = decode(last);
    // Bytes are a fact; a guess needs more room than a line has.
    if values.iter().any(|value| value.guess) {
        return space_hex(&last.res_data);
    }
    values.iter().map(|value| value.text.as_str()).collect::<Vec<_>>().join(" · ")
}
