//! Offers to open the write window, to those who may.

use web_sys::HtmlInputElement;
use yew::{platform::spawn_local, prelude::*};

use super::notice::words;
use crate::{
    access::window_obstacle,
    i18n::tr,
    net::{Relay, rest},
};

/// Minutes and a button, or why not. What becomes of it comes from the relay, as everybody hears it; a refusal goes to
/// `refused`.
pub(super) fn window_form(
    relay: &Relay,
    node: &NodeRef,
    refused: &UseStateHandle<Option<String>>,
    on_cancel: Callback<MouseEvent>,
) -> Html {
    let writing = relay.writing();
    let obstacle = window_obstacle(&writing.state);
    let onsubmit = {
        let (node, refused) = (node.clone(), refused.clone());
        move |event: SubmitEvent| {
            event.prevent_default();
            let minutes = node.cast::<HtmlInputElement>().and_then(|input| input.value().parse().ok());
            let refused = refused.clone();
            spawn_local(async move {
                let opened = rest::open_window(minutes.unwrap_or(MINUTES)).await;
                refused.set(opened.err().map(|problem| words(&problem)));
            });
        }
    };
    html! {
        <form {onsubmit}>
            <p>{ tr!("window.text") }</p>
            if let Some(obstacle) = &obstacle {
                <p class="warning-text" data-test="window-obstacle">{ obstacle }</p>
            } else {
                <label for="window-minutes">{ tr!("window.minutes") }</label>
                <input id="window-minutes" class="input number" type="number" min="1" max="60" required=true value={MINUTES.to_string()} ref={node.clone()} />
            }
            if let Some(refused) = &**refused {
                <p class="finding error" role="alert">{ refused }</p>
            }
            <div class="dialog-buttons">
                <button type="button" class="button" onclick={on_cancel} data-test="window-cancel">{ tr!("dialog.cancel") }</button>
                <button type="submit" class="button danger" disabled={obstacle.is_some()} data-test="window-open">{ tr!("window.do") }</button>
            </div>
        </form>
    }
}

/// Unless somebody chooses otherwise.
const MINUTES: u32 = 15;
