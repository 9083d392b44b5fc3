//! The data of a block, field by field: what its bytes are, what will be sent, what came back.

mod layout;
mod request;

use std::rc::Rc;

use cipdeck_shared::{
    api::{BlockStatus, Role},
    config::{Block, BlockId, MsgCipGeneric, space_hex},
    dissect::Decoded,
};
use yew::prelude::*;

use self::{layout::layout_entry, request::RequestFields};
use super::{
    api,
    fetch::{use_action, use_fetched},
    i18n::tr,
    kit::{note, problem_note, waiting},
};
use crate::{hooks::use_title, net::session};

#[derive(Clone, PartialEq, Properties)]
pub(super) struct DataProps {
    pub(super) block: BlockId,
}

/// Loads the block; a change that was stored loads it again.
#[component]
pub(super) fn DataPage(props: &DataProps) -> Html {
    use_title(&tr!("data.title"));
    let block = use_fetched::<Block>(format!("blocks/{}", props.block));
    let status = use_fetched::<BlockStatus>(format!("blocks/{}/status", props.block));
    let on_stored = {
        let (block, status) = (block.reload.clone(), status.reload.clone());
        Callback::from(move |()| {
            block.emit(());
            status.emit(());
        })
    };
    html! { <>
        <h1>{ tr!("data.title") }</h1>
        { waiting(&block) }
        if let Some(found) = &block.data {
            <p>
                <a href={way_back(found)} data-test="to-block">{ found.config.name() }</a>
                <span class="mono hint">{ format!(" {}", found.config.target_text()) }</span>
            </p>
            if let Some(stored) = found.config.as_msg().cloned() {
                <Fields key={found.revision.to_string()} block={found.clone()} {stored} status={status.data.clone()} on_stored={on_stored} on_again={status.reload} />
            }
        }
    </> }
}

/// Where the block itself is edited. One of words has its fields there, too.
fn way_back(block: &Block) -> String {
    let document = if block.config.as_msg().is_some() { "deck" } else { "words" };
    format!("/{document}/{}", block.id)
}

#[derive(Clone, PartialEq, Properties)]
struct FieldsProps {
    block: Rc<Block>,
    stored: MsgCipGeneric,
    status: Option<Rc<BlockStatus>>,
    on_stored: Callback<()>,
    on_again: Callback<()>,
}

/// The form, and the newest reply.
#[component]
fn Fields(props: &FieldsProps) -> Html {
    let action = use_action();
    let stored = &props.stored;
    let req_layout = use_state(|| stored.req_layout.clone());
    let res_layout = use_state(|| stored.res_layout.clone());
    let req_data = use_state(|| stored.req_data.clone());
    let config = MsgCipGeneric {
        req_layout: req_layout.trim().to_owned(),
        res_layout: res_layout.trim().to_owned(),
        req_data: (*req_data).clone(),
        // All of what is entered here is sent.
        req_length: if *req_data == stored.req_data { stored.req_length } else { None },
        ..stored.clone()
    };
    let is_changed = config != *stored;
    let readable = layout::is_readable(&req_layout) && layout::is_readable(&res_layout);
    let onsubmit = {
        let (action, block, done) = (action.clone(), (*props.block).clone(), props.on_stored.clone());
        move |event: SubmitEvent| {
            event.prevent_default();
            if is_changed && readable {
                let (block, done) = (Block { config: config.clone().into(), ..block.clone() }, done.clone());
                action.go(api::replace_block(block), move |_| done.emit(()));
            }
        }
    };
    let may = session::may(Role::may_edit);
    let on_data = req_data.setter();
    html! {
        <form class="data-form" {onsubmit} data-test="data-form">
            <section class="panel">
                <h2>{ "ReqData" }</h2>
                { layout_entry("req-layout", "ReqLayout".into(), &req_layout) }
                <RequestFields layout={(*req_layout).clone()} data={(*req_data).clone()} on_data={Callback::from(move |data| on_data.set(data))} />
                <p class="mono" data-test="req-data">{ space_hex(&req_data) }</p>
            </section>
            <section class="panel">
                <h2>{ "ResData" }</h2>
                { layout_entry("res-layout", "ResLayout".into(), &res_layout) }
                { reply(props.status.as_deref()) }
                <button type="button" class="button" onclick={props.on_again.reform(|_: MouseEvent| ())}>{ tr!("data.again") }</button>
            </section>
            { problem_note(action.problem().as_ref()) }
            <div class="choices">
                <button type="submit" class="button primary" disabled={!is_changed || !readable || !may || action.is_busy()} data-test="store">
                    { tr!("data.store") }
                </button>
                if is_changed {
                    <span class="hint" data-test="unsaved">{ tr!("data.unsaved") }</span>
                }
            </div>
        </form>
    }
}

/// The last good value, as the stored layout reads it.
fn reply(status: Option<&BlockStatus>) -> Html {
    let Some(last) = status.and_then(|status| status.last.as_ref()) else {
        return note(tr!("data.no_reply"));
    };
    if last.decoded.is_empty() {
        return html! { <><p class="mono">{ space_hex(&last.res_data) }</p>{ note(tr!("data.no_layout")) }</> };
    }
    let row = |value: &Decoded| {
        html! {
            <tr class={classes!(value.guess.then_some("hint"))}>
                <td>{ value.name.to_string() }</td>
                <td class="num mono" data-test="reply-value">{ &value.text }</td>
                <td class="hint">{ if value.guess { tr!("data.guess") } else { value.type_name.to_string().into() } }</td>
                <td class="num mono hint">{ format!("{}..{}", value.from, value.to) }</td>
            </tr>
        }
    };
    html! {
        <div class="scroll"><table class="listing" aria-label="ResData">
            <thead><tr>
                <th scope="col">{ tr!("data.field") }</th><th scope="col" class="num">{ tr!("data.value") }</th>
                <th scope="col">{ tr!("data.type") }</th><th scope="col" class="num">{ tr!("data.bytes") }</th>
            </tr></thead>
            <tbody>{ for last.decoded.iter().map(row) }</tbody>
        </table></div>
    }
}
