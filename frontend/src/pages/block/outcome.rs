//! What the device said: the decoded value, the last good one with its age, or the trouble in words.

use std::rc::Rc;

use cipdeck_shared::{
    api::LastSuccess,
    config::read_hex,
    dissect::{self, Decoded},
    engine::Phase,
    wire::{MessageRouterReply, MessageRouterRequest},
};
use yew::prelude::*;

use super::{axis::duration, trouble::trouble, written::written};
use crate::{browser, hooks::use_second, i18n::tr, store::Row};

#[derive(Clone, PartialEq, Properties)]
pub(super) struct OutcomeProps {
    pub(super) row: Rc<Row>,
}

/// The result of the newest run.
#[component]
pub(super) fn Outcome(props: &OutcomeProps) -> Html {
    let row = &props.row;
    let status = &row.status;
    use_second(status.last.is_some());
    let values = use_memo(status.last.clone(), |last| last.as_ref().map_or_else(Vec::new, decode));
    html! {
        <div class="outcome">
            <h2>
                { tr!("outcome.title") }
                <span class="count">
                    { match (status.phase.is_busy(), status.reply_us) {
                        (true, _) => tr!("outcome.busy"),
                        (false, Some(us)) => tr!("outcome.reply_time", time = duration(us)),
                        (false, None) => AttrValue::default(),
                    } }
                </span>
            </h2>
            if status.phase == Phase::Failed {
                { trouble(status, row.config.target_text()) }
            }
            if let Some((_, it)) = row.written.as_ref().filter(|(runs, _)| *runs == status.runs) {
                { written(it) }
            }
            if let Some(last) = &status.last {
                <div class={classes!("good", (!status.q).then_some("stale"))}>
                    <h3>
                        { if status.q { tr!("outcome.value") } else { tr!("outcome.last") } }
                        <span class="age" data-test="last-age">{ age(last) }</span>
                    </h3>
                    { decoded(&values) }
                </div>
            } else if status.phase == Phase::Idle {
                <p class="quiet">{ tr!("outcome.never") }</p>
            }
        </div>
    }
}

/// What `ResData` means: what the relay has read by the block's layout, otherwise that follows from the request that it
/// answers. It exists only after a success, so the reply around it is known.
pub(crate) fn decode(last: &LastSuccess) -> Vec<Decoded> {
    if !last.decoded.is_empty() {
        return last.decoded.clone();
    }
    let (Ok(request), Ok(data)) = (read_hex(&last.request), read_hex(&last.res_data)) else {
        return Vec::new();
    };
    let Ok(service) = MessageRouterRequest::decode(&request).map(|request| request.service()) else {
        return Vec::new();
    };
    let mut reply = Vec::new();
    MessageRouterReply::success(service, &data).encode(&mut reply);
    dissect::decode(&request, &reply)
}

/// Values with their names and types.
pub(crate) fn decoded(values: &[Decoded]) -> Html {
    if values.is_empty() {
        return html! { <p class="quiet" data-test="decoded-empty">{ tr!("outcome.no_data") }</p> };
    }
    let guessed = values.iter().any(|value| value.guess);
    html! { <>
        if guessed {
            <p class="guess-note">{ tr!("outcome.guess") }</p>
        }
        <ul class={classes!("values", (values.len() == 1 && !guessed).then_some("single"))} data-test="decoded">
            { for values.iter().map(value) }
        </ul>
    </> }
}

fn value(value: &Decoded) -> Html {
    html! {
        <li class={classes!("value", value.guess.then_some("guess"))}>
            <span class="value-name">{ value.name.to_string() }</span>
            <span class="value-text" data-test="decoded-value">{ &value.text }</span>
            <span class="value-type">
                { value.type_name.to_string() }
                if value.guess {
                    <span class="guess-word">{ tr!("outcome.guess_word") }</span>
                }
            </span>
        </li>
    }
}

fn age(last: &LastSuccess) -> AttrValue {
    browser::age_s(&last.at).map_or_else(AttrValue::default, age_words)
}

/// `3 s ago`
pub(crate) fn age_words(seconds: f64) -> AttrValue {
    match seconds {
        ..1.5 => tr!("age.now"),
        ..90.0 => tr!("age.seconds", count = whole(seconds)),
        ..5_400.0 => tr!("age.minutes", count = whole(seconds / 60.0)),
        ..129_600.0 => tr!("age.hours", count = whole(seconds / 3_600.0)),
        _ => tr!("age.days", count = whole(seconds / 86_400.0)),
    }
}

/// Rounded. Rust's floating point in decimal would be 2 kB of the page.
#[expect(clippy::cast_possible_truncation, clippy::cast_sign_loss, reason = "an age, saturating")]
pub(crate) fn whole(value: f64) -> u64 {
    value.round() as u64
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_data_of_a_success_is_decoded_by_its_request() {
        let last = |request: &str, data: &str| LastSuccess {
            request: request.to_owned(),
            res_data: data.to_owned(),
            res_length: 0,
            at: String::new(),
            decoded: Vec::new(),
        };
        let values = decode(&last("0e03200124013007", "0443504831"));
        assert_eq!((values[0].text.as_str(), values[0].guess), ("CPH1", false));
        assert!(decode(&last("0e03200124013007", "")).is_empty());
        assert!(decode(&last("", "00")).is_empty());
        let told = dissect::decode(&[0x0E, 0], &[0x8E, 0, 0, 0, 7]);
        assert_eq!(decode(&LastSuccess { decoded: told.clone(), ..last("0e03200124013007", "00") }), told);
    }

    #[test]
    fn ages_have_the_unit_that_fits() {
        for (seconds, words) in [
            (0.3, "now"),
            (3.0, "3 s ago"),
            (120.0, "2 min ago"),
            (7_200.0, "2 h ago"),
            (200_000.0, "2 d ago"),
        ] {
            assert_eq!(age_words(seconds), words);
        }
    }
}
