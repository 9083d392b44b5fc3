//! The keys of a block's page.

use wasm_bindgen::{JsCast, closure::Closure};
use yew::prelude::*;

/// What a key asks for.
#[derive(Clone, Copy, PartialEq)]
pub(super) enum Key {
    Run,
    Save,
}

/// Hears the page's two keys wherever the focus is.
#[hook]
pub(super) fn use_keys(heard: Callback<Key>) {
    use_effect(move || {
        let listener = Closure::<dyn Fn(KeyboardEvent)>::new(move |event: KeyboardEvent| {
            let key = match event.key().as_str() {
                "Enter" => Key::Run,
                "s" => Key::Save,
                _ => return,
            };
            if event.ctrl_key() || event.meta_key() {
                event.prevent_default();
                heard.emit(key);
            }
        });
        let document = web_sys::window().and_then(|window| window.document());
        let function = listener.as_ref().unchecked_ref();
        if let Some(document) = &document {
            // Refused only for a listener that is there already.
            let _ = document.add_event_listener_with_callback("keydown", function);
        }
        move || {
            if let Some(document) = document {
                let _ = document
                    .remove_event_listener_with_callback("keydown", listener.as_ref().unchecked_ref());
            }
        }
    });
}
