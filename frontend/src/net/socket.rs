//! A WebSocket that carries text: the browser's object, and nothing of the protocol.

use std::fmt;

use wasm_bindgen::{JsCast, closure::Closure};
use web_sys::{CloseEvent, MessageEvent, WebSocket};
use yew::Callback;

/// An open or opening WebSocket. Dropping it closes it, and nothing more is heard of it.
pub struct Socket {
    inner: WebSocket,
    _on_message: Closure<dyn Fn(MessageEvent)>,
    _on_close: Closure<dyn Fn(CloseEvent)>,
}

impl Socket {
    /// Opens a WebSocket. `None` if the browser refuses the address itself. `on_close` hears the code of the close frame,
    /// 1006 where there was none.
    pub fn open(url: &str, on_text: Callback<String>, on_close: Callback<u16>) -> Option<Self> {
        let inner = WebSocket::new(url).ok()?;
        let on_message = Closure::<dyn Fn(MessageEvent)>::new(move |event: MessageEvent| {
            if let Some(text) = event.data().as_string() {
                on_text.emit(text);
            }
        });
        // An error is always followed by a close.
        let on_close =
            Closure::<dyn Fn(CloseEvent)>::new(move |event: CloseEvent| on_close.emit(event.code()));
        inner.set_onmessage(Some(on_message.as_ref().unchecked_ref()));
        inner.set_onclose(Some(on_close.as_ref().unchecked_ref()));
        Some(Self { inner, _on_message: on_message, _on_close: on_close })
    }

    /// Whether the text was handed to the browser.
    pub fn send(&self, text: &str) -> bool {
        self.inner.ready_state() == WebSocket::OPEN && self.inner.send_with_str(text).is_ok()
    }
}

impl Drop for Socket {
    fn drop(&mut self) {
        self.inner.set_onmessage(None);
        self.inner.set_onclose(None);
        // Closing twice is not an error worth a word.
        let _ = self.inner.close();
    }
}

impl fmt::Debug for Socket {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "Socket({})", self.inner.url())
    }
}
