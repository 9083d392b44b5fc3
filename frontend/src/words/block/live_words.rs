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
                    { byte(report >> 8, named(tr!("live.operation"), operation, operation_code, is_over, "operation-report")) }
                    { byte(report & 0xFF, named(tr!("live.communication"), communication, code, is_over, "communication-report")) }
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
fn named(what: AttrValue, entry: Option<Entry>, code: u8, is_over: bool, test: &'static str) -> Html {
    let name = match (&entry, code) {
        // Before the end a 0 is no report.
        _ if !is_over => AttrValue::default(),
        (Some(entry), _) => AttrValue::from(entry.name),
        (None, 0) => tr!("live.nothing"),
        (None, MESSAGE_REFUSED) => AttrValue::default(),
        (None, _) => tr!("live.not_in_tables"),
    };
    html! { <>{ what }{ " " }<b class={classes!((is_over && code != 0).then_some("bad-text"))} data-test={test}>{ name }</b></> }
}
