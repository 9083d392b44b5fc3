//! The four live words of `Management_Param`, byte by byte.

use cipdeck_shared::{
    api::WordsStatus,
    config::SendReqForm,
    table::{Entry, MESSAGE_REFUSED},
};
use yew::prelude::*;

use crate::{
    kit::Shape,
    words::{
        i18n::tr,
        verdict::{Verdict, reports},
    },
};

/// `sent`: bytes that the program asks to send.
pub(super) fn live_words(form: SendReqForm, words: &WordsStatus, verdict: Verdict, sent: i64) -> Html {
    let [activity, report, timeout, length] = words.management_param;
    let (communication, operation) = reports(form, words);
    let (code, operation_code) = (words.communication_report(), words.operation_report());
    let is_over = !matches!(verdict, Verdict::Never | Verdict::Busy);
    let lamp = words.is_active();
    let time = match timeout {
        0 => tr!("management.for_ever"),
        tenths => tr!("live.timeout", tenths = tenths, ms = u32::from(tenths) * 100),
    };
    let bytes = if is_over {
        tr!("live.length_after", sent = sent, received = length)
    } else {
        tr!("live.length", bytes = length)
    };
    html! {
        <table class="live-words" data-test="management-words">
            <caption class="unseen">{ "Management_Param" }</caption>
            <tbody>
                { row(0, activity, html! { <>
                    { byte(activity >> 8, html! { { tr!("live.exchange", number = words.exchange()) } }) }
                    { byte(activity & 0xFF, html! {
                        <span class={classes!("lamp", lamp.then_some("on"))} data-test="activity-bit" data-on={lamp.to_string()}>
                            { if lamp { Shape::Dot.draw() } else { Shape::Ring.draw() } }
                            { if lamp { tr!("live.active") } else { tr!("live.inactive") } }
                        </span>
                    }) }
                </> }) }
                { row(1, report, html! { <>
                    { byte(report >> 8, named(tr!("live.operation"), is_over.then_some(operation).flatten(), operation_code, is_over && operation_code != 0, "operation-report")) }
                    { byte(report & 0xFF, named(tr!("live.communication"), is_over.then_some(communication).flatten(), code, is_over && code != 0, "communication-report")) }
                </> }) }
                { row(2, timeout, html! { <span class={classes!((timeout == 0).then_some("loud-text"))}>{ time }</span> }) }
                { row(3, length, html! { <span data-test="live-length">{ bytes }</span> }) }
            </tbody>
        </table>
    }
}

fn row(number: u8, word: u16, meaning: Html) -> Html {
    html! {
        <tr>
            <th scope="row">{ format!("[{number}]") }</th>
            <td class="mono" data-test={format!("word-{number}")}>{ format!("{word:04X}") }</td>
            <td>{ meaning }</td>
        </tr>
    }
}

fn byte(value: u16, meaning: Html) -> Html {
    html! { <div class="byte-of"><span class="mono">{ format!("{value:02X}") }</span><span>{ meaning }</span></div> }
}

/// A report with its name.
fn named(what: AttrValue, entry: Option<Entry>, code: u8, bad: bool, test: &'static str) -> Html {
    let name = match (&entry, code) {
        (Some(entry), _) => AttrValue::from(entry.name),
        (None, 0) => tr!("live.nothing"),
        (None, MESSAGE_REFUSED) => AttrValue::default(),
        (None, _) => tr!("live.not_in_tables"),
    };
    html! { <>{ what }{ " " }<b class={classes!(bad.then_some("bad-text"))} data-test={test}>{ name }</b></> }
}
