//! A switch: acts at once, unlike a check box of a form.

use yew::prelude::*;

/// A switch.
#[derive(Clone, Debug)]
pub struct Switch {
    /// Visible name.
    pub label: &'static str,
    /// On?
    pub on: bool,
    /// Cannot be used now.
    pub disabled: bool,
    /// What it does.
    pub title: AttrValue,
    /// Hears the state that is asked for.
    pub on_switch: Callback<bool>,
}

impl Switch {
    /// A button with the role of a switch.
    pub fn draw(self) -> Html {
        let Self { label, on, disabled, title, on_switch } = self;
        let onclick = move |_: MouseEvent| on_switch.emit(!on);
        html! {
            <button
                type="button" class="switch" role="switch" aria-checked={if on { "true" } else { "false" }}
                {disabled} {title} data-test="in-switch" {onclick}
            >
                <span class="switch-label">{ label }</span>
                <span class="switch-track" aria-hidden="true"><span class="switch-knob" /></span>
            </button>
        }
    }
}
