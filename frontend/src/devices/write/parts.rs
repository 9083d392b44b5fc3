//! What is said while a value is typed, and before it is written.

use cipdeck_shared::{
    api::WriteTicket,
    config::{Variable, space_hex},
};
use yew::prelude::*;

use super::WriteDialogProps;
use crate::devices::i18n::tr;

/// What may be typed.
pub(super) fn range(variable: &Variable) -> AttrValue {
    let config = &variable.config;
    match (config.min, config.max) {
        (Some(min), Some(max)) => tr!("write_value.between", min = min, max = max),
        (Some(min), None) => tr!("write_value.at_least", min = min),
        (None, Some(max)) => tr!("write_value.at_most", max = max),
        (None, None) => tr!("write_value.hint"),
    }
}

/// The words for numbers, to be clicked.
pub(super) fn choices(variable: &Variable, typed: &UseStateHandle<String>) -> Html {
    let button = |text: &String| {
        let (set, text) = (typed.setter(), text.clone());
        let words = text.clone();
        html! { <button type="button" class="button" onclick={move |_: MouseEvent| set.set(text.clone())}>{ words }</button> }
    };
    let choices = &variable.config.choices;
    html! {
        if !choices.is_empty() {
            <div class="choices">{ for choices.iter().map(|choice| button(&choice.text)) }</div>
        }
    }
}

/// Old and new, in units, and the bytes that go out.
pub(super) fn change(props: &WriteDialogProps, ticket: &WriteTicket) -> Html {
    let old = ticket.old.as_ref().map_or_else(
        || html! { <span class="quiet">{ tr!("write.no_old", why = ticket.no_old.as_deref().unwrap_or_default()) }</span> },
        |old| html! { &old.text },
    );
    html! { <>
        <p class="old-new">
            <span class="old" data-test="write-old">{ old }</span>
            <span aria-hidden="true">{ "→" }</span><span class="unseen">{ tr!("write_value.becomes") }</span>
            <b class="new" data-test="write-new">{ ticket.new.as_ref().map(|new| new.text.clone()).unwrap_or_default() }</b>
        </p>
        <dl class="facts">
            <dt>{ tr!("write_value.where") }</dt><dd class="mono">{ &props.address }{ " @ " }{ &props.device.config.path }</dd>
            <dt>{ tr!("write.bytes") }</dt><dd class="mono" data-test="write-bytes">{ space_hex(&ticket.request).to_ascii_uppercase() }</dd>
        </dl>
    </> }
}
