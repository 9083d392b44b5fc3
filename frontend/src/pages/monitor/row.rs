//! One block on one line. It knows its id; everything else comes from the store.

use std::rc::Rc;

use cipdeck_shared::{config::MsgCipGeneric, plan::MessagePlan};
use yew::prelude::*;
use yew_router::prelude::Link;

use crate::{
    browser,
    hooks::{use_row, use_second},
    kit::StateMark,
    pages::block::{age_words, decode, duration, error_words},
    route::Route,
    store::{DeckId, Row},
};

#[derive(Clone, PartialEq, Properties)]
pub(super) struct MonitorRowProps {
    /// `aria-rowindex`
    pub(super) index: usize,
    pub(super) id: DeckId,
}

/// State, name, target, value, age, runs, reply time, error.
#[component]
pub(super) fn MonitorRow(props: &MonitorRowProps) -> Html {
    let row = use_row(props.id);
    use_second(row.as_ref().is_some_and(|row| row.status.last.is_some()));
    let config = row.as_ref().map(|row| row.config.clone());
    // The request changes with the configuration only; values change all the time.
    let request = use_memo(ByAddress(config), |config| {
        let (plan, _) = MessagePlan::parse(config.0.as_deref()?);
        Some(plan?.request().bytes())
    });
    let Some(row) = row else { return html! {} };
    let status = &row.status;
    let reply = status.reply_us.map(duration).unwrap_or_default();
    let error = if status.status.error { error_words(&status.status) } else { String::new() };
    let age = status.last.as_ref().and_then(|last| browser::age_s(&last.at)).map(age_words);
    html! {
        <tr aria-rowindex={props.index.to_string()} data-test="monitor-row" data-block={props.id.to_string()}>
            <td class="col-state"><StateMark phase={status.phase} /></td>
            <th scope="row" class="col-name">
                <Link<Route> to={Route::Block { id: props.id.to_string() }}>{ &row.config.name }</Link<Route>>
            </th>
            <td class="col-target mono">{ &row.config.target_cfg.path }</td>
            <td class={classes!("col-value", (!status.q).then_some("stale"))}>{ value(&row, request.as_deref()) }</td>
            <td class="col-age">{ age.unwrap_or_default() }</td>
            <td class="col-runs">{ status.runs }</td>
            <td class="col-reply">{ reply }</td>
            <td class="col-error" title={error.clone()}>{ error }</td>
        </tr>
    }
}

/// The newest good value on one line.
fn value(row: &Row, request: Option<&[u8]>) -> String {
    let status = &row.status;
    let data = if status.q {
        Some(status.res_data.as_str())
    } else {
        status.last.as_ref().map(|last| last.res_data.as_str())
    };
    let values = decode(request, data);
    // Bytes are a fact; a guess needs more room than a line has.
    if values.iter().any(|value| value.guess) {
        return data.unwrap_or_default().to_owned();
    }
    values.iter().map(|value| value.text.as_str()).collect::<Vec<_>>().join(" · ")
}

/// Equal only if it is the same configuration in memory: cheap to compare in every frame.
#[derive(Clone)]
struct ByAddress(Option<Rc<MsgCipGeneric>>);

impl PartialEq for ByAddress {
    fn eq(&self, other: &Self) -> bool {
        match (&self.0, &other.0) {
            (Some(one), Some(other)) => Rc::ptr_eq(one, other),
            (one, other) => one.is_none() && other.is_none(),
        }
    }
}
