//! A switch: acts at once, unlike a check box of a form.

use yew::prelude::*;

/// A switch.
#[derive(Clone, Debug, PartialEq, Properties)]
pub struct SwitchProps {
    /// Visible name.
    pub label: AttrValue,
    /// On?
    pub on: bool,
    /// Cannot be used now.
    #[prop_or_default]
    pub disabled: bool,
    /// What it does.
    #[prop_or_default]
    pub title: Option<AttrValue>,
    /// Hears the state that is asked for.
    pub on_switch: Callback<bool>,
}

/// A button with the role of a switch.
#[component]
pub fn Switch(props: &SwitchProps) -> Html {
    let onclick = use_callback((props.on_switch.clone(), props.on), |_: MouseEvent, (on_switch, on)| {
        on_switch.emit(!on);
    });
    html! {
        <button
            type="button"
            class="switch"
            role="switch"
            aria-checked={if props.on { "true" } else { "false" }}
            disabled={props.disabled}
            title={props.title.clone()}
            data-test="in-switch"
            {onclick}
        >
            <span class="switch-label">{ &props.label }</span>
            <span class="switch-track" aria-hidden="true"><span class="switch-knob" /></span>
        </button>
    }
}
