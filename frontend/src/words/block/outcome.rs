//! What became of the exchange, with what it means and what to try; and what the device has answered.

use std::rc::Rc;

use cipdeck_shared::{
    api::{BlockStatus, WordsStatus},
    config::{SendReqForm, read_hex, words_of},
    table::{self, Entry},
};
use yew::prelude::*;

use crate::{
    browser,
    hooks::use_second,
    i18n::{CAUSE, TRY, find},
    pages::block::{acted, age_words, decode, decoded, duration, explain, written},
    store::Row,
    words::{
        explain,
        grid::WordGrid,
        i18n::tr,
        verdict::{Verdict, line, received, reports},
    },
};

#[derive(Clone, PartialEq, Properties)]
pub(super) struct OutcomeProps {
    pub(super) form: SendReqForm,
    pub(super) row: Rc<Row>,
}

/// The verdict in words, then the words that were received.
#[component]
pub(super) fn Outcome(props: &OutcomeProps) -> Html {
    let status = &props.row.status;
    let verdict = Verdict::of(status);
    use_second(status.last.is_some());
    let Some(words) = &status.words else {
        return html! { <p class="quiet" data-test="verdict" data-verdict="never">{ tr!("verdict.never") }</p> };
    };
    html! { <>
        <div class={classes!("verdict", format!("is-{}", verdict.word()))} data-test="verdict" data-verdict={verdict.word()} role={matches!(verdict, Verdict::Refused(..) | Verdict::Failed).then_some("alert")}>
            <p class="verdict-line">
                { verdict.shape().draw() }
                <b>{ line(props.form, status) }</b>
            </p>
            if let (Verdict::Good | Verdict::Refused(..), Some(us)) = (verdict, status.reply_us) {
                <p class="quiet">{ tr!("outcome.reply_time", time = duration(us)) }</p>
            }
            { why(props.form, status, words, verdict) }
        </div>
        if let Some((_, it)) = props.row.written.as_ref().filter(|(runs, _)| *runs == status.runs) {
            { written(it) }
        }
        <Received words={words.clone()} request={AttrValue::from(status.request.clone())} />
        if let (Verdict::Good, Some(last)) = (verdict, &status.last) {
            { decoded(&decode(last)) }
        }
        { last(status, verdict) }
    </> }
}

/// What the codes mean, how well that is known, and what to try.
fn why(form: SendReqForm, status: &BlockStatus, words: &WordsStatus, verdict: Verdict) -> Html {
    let cause = status.cause.as_ref();
    let (entries, cause_words): (Vec<Entry>, Option<&str>) = match verdict {
        Verdict::Refused(general, extended) => {
            let extended = extended.filter(|it| *it != 0).and_then(|it| table::extended_status(general, it));
            ([extended, table::general_status(general)].into_iter().flatten().collect(), None)
        }
        Verdict::Failed => {
            let (communication, operation) = reports(form, words);
            let of_cause = cause.and_then(|cause| find(CAUSE, cause.what.word()));
            ([operation, communication].into_iter().flatten().collect(), of_cause)
        }
        _ => return html! {},
    };
    let tries = cause.and_then(|cause| find(TRY, cause.what.word())).filter(|_| verdict == Verdict::Failed);
    let hints: Vec<_> = entries.iter().map(|entry| entry.hint).filter(|hint| !hint.is_empty()).collect();
    html! { <>
        if matches!(verdict, Verdict::Refused(..)) {
            <p>{ tr!("verdict.two_things") }</p>
        }
        if let Some(words) = cause_words {
            <p data-test="cause">{ words }{ " " }{ cause.and_then(|cause| cause.detail.clone()).unwrap_or_default() }</p>
        }
        if verdict == Verdict::Failed {
            { acted(cause) }
        }
        <ul class="entries-of-error">{ for entries.iter().map(explain) }</ul>
        if tries.is_some() || !hints.is_empty() {
            <h3>{ tr!("error.try") }</h3>
            <ul class="tries">
                { for hints.iter().map(|hint| html! { <li>{ *hint }</li> }) }
                { for tries.iter().map(|words| html! { <li>{ words }</li> }) }
            </ul>
        }
    </> }
}

#[derive(Clone, PartialEq, Properties)]
struct ReceivedProps {
    words: WordsStatus,
    request: AttrValue,
}

/// `Received_Data`: as words, and as what they say.
#[component]
fn Received(props: &ReceivedProps) -> Html {
    let bytes = received(&props.words);
    let request = read_hex(&props.request).unwrap_or_default();
    html! {
        <section class="received">
            <h2>{ "Received_Data" }<span class="count">{ tr!("received.count", words = words_of(&bytes).len(), bytes = bytes.len()) }</span></h2>
            if bytes.is_empty() {
                <p class="quiet">{ tr!("received.nothing") }</p>
            } else {
                <WordGrid
                    label="Received_Data" words={Rc::<[u16]>::from(words_of(&bytes))}
                    tree={Rc::new(explain::received(&bytes, &request))} bytes={bytes.len()} test="received-words"
                />
            }
        </section>
    }
}

/// The last good value, while the newest exchange has none.
fn last(status: &BlockStatus, verdict: Verdict) -> Html {
    let Some(last) = status.last.as_ref().filter(|_| verdict != Verdict::Good) else { return html! {} };
    let age = browser::age_s(&last.at).map_or_else(AttrValue::default, age_words);
    html! {
        <div class="good stale">
            <h3>{ tr!("outcome.last") }<span class="age" data-test="last-age">{ age }</span></h3>
            { decoded(&decode(last)) }
        </div>
    }
}
