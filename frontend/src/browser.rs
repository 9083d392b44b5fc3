//! The few things that the page asks the browser for. Every one has an answer where the browser has none.

use js_sys::Date;
use wasm_bindgen::{JsCast, JsValue, closure::Closure};
use web_sys::{Document, Element, Storage};
use yew::platform::spawn_local;

/// Milliseconds since the page was opened. Never goes back.
pub fn now_ms() -> f64 {
    web_sys::window().and_then(|window| window.performance()).map_or(0.0, |performance| performance.now())
}

/// Whether one of some texts contains another one, in upper or lower case.
pub fn is_found(wanted: &str, texts: [&str; 2]) -> bool {
    // The browser's own: Rust's tables of cases would be 5 kB of the page.
    let lower = |text: &str| js_sys::JsString::from(text).to_lower_case();
    let wanted = String::from(lower(wanted.trim()));
    texts.iter().any(|text| lower(text).includes(&wanted, 0))
}

/// Whether a text contains another one, in upper or lower case.
pub fn contains(text: &str, wanted: &str) -> bool {
    let lower = |text: &str| js_sys::JsString::from(text).to_lower_case();
    lower(text).includes(&String::from(lower(wanted.trim())), 0)
}

/// The wall clock as RFC 3339.
pub fn wall_clock() -> String {
    Date::new_0().to_iso_string().into()
}

/// Seconds since a time in RFC 3339; never negative, `None` for what is no time.
pub fn age_s(at: &str) -> Option<f64> {
    let then = Date::parse(at);
    (!then.is_nan()).then(|| ((Date::now() - then) / 1_000.0).max(0.0))
}

/// `07:36:12`: the time of day here of a time in RFC 3339.
pub fn time_of_day(at: &str) -> String {
    Date::new(&at.into()).to_locale_time_string("en-GB").into()
}

/// `2026-11-22 07:36:12`: date and time of day here of a time in RFC 3339.
pub fn date_and_time(at: &str) -> String {
    local(ms_of(at))
}

/// The same of a time in ms since 1970.
pub fn local(ms: f64) -> String {
    // Sweden writes dates as the standard does.
    Date::new(&ms.into()).to_locale_string("sv-SE", &JsValue::UNDEFINED).into()
}

/// ms since 1970 of a time in RFC 3339; no number for what is no time.
pub fn ms_of(at: &str) -> f64 {
    Date::parse(at)
}

/// `07:36:12`: the time of day here of a time of [`now_ms`].
pub fn clock(at_ms: f64) -> String {
    let at = Date::now() - (now_ms() - at_ms);
    Date::new(&at.into()).to_locale_time_string("en-GB").into()
}

/// So many ms from now as RFC 3339.
pub fn utc(from_now_ms: f64) -> String {
    Date::new(&(Date::now() + from_now_ms).into()).to_iso_string().into()
}

/// Calls once before the next picture is drawn.
pub fn before_next_frame(call: Box<dyn FnOnce()>) {
    let closure = Closure::once_into_js(call);
    if let Some(window) = web_sys::window() {
        // Refused only by a window that is gone, which draws no picture.
        let _ = window.request_animation_frame(closure.unchecked_ref());
    }
}

/// The address of a WebSocket of the server that this page came from.
pub fn websocket_url(path: &str) -> Option<String> {
    let location = web_sys::window()?.location();
    let scheme = if location.protocol().ok()? == "https:" { "wss" } else { "ws" };
    Some(format!("{scheme}://{}{path}", location.host().ok()?))
}

/// What this browser has kept under a name.
pub fn kept(name: &str) -> Option<String> {
    storage()?.get_item(name).ok()?
}

/// Keeps a text over a reload. A full or forbidden storage costs only that.
pub fn keep(name: &str, text: &str) {
    if let Some(storage) = storage() {
        let _ = storage.set_item(name, text);
    }
}

/// Names the page in the browser's tab.
pub fn set_title(title: &str) {
    if let Some(document) = document() {
        document.set_title(title);
    }
}

/// Says on the page that it has stopped working: after a panic nothing answers any more.
pub fn show_crash(what: &str) {
    let note = document().and_then(|document| {
        let note = document.create_element("p").ok()?;
        document.body()?.prepend_with_node_1(&note).ok()?;
        Some(note)
    });
    if let Some(note) = note {
        note.set_class_name("crash");
        // The name is a valid attribute name.
        let _ = note.set_attribute("role", "alert");
        note.set_text_content(Some(what));
    }
}

/// The `html` element.
pub fn root() -> Option<Element> {
    document()?.document_element()
}

/// Whether the system asks for dark colours.
pub fn prefers_dark() -> bool {
    let query =
        web_sys::window().and_then(|window| window.match_media("(prefers-color-scheme: dark)").ok()?);
    query.is_some_and(|query| query.matches())
}

/// Puts a text on the clipboard; says whether the browser allowed it.
pub fn copy(text: &str, done: impl FnOnce(bool) + 'static) {
    let clipboard = web_sys::window()
        .map(|window| window.navigator())
        .filter(|navigator| {
            js_sys::Reflect::get(navigator, &"clipboard".into()).is_ok_and(|it| it.is_object())
        })
        .map(|navigator| navigator.clipboard().write_text(text));
    spawn_local(async move {
        let copied = match clipboard {
            Some(promise) => js_sys::futures::JsFuture::from(promise).await.is_ok(),
            None => false,
        };
        done(copied);
    });
}

/// The text of the file that somebody has chosen.
pub async fn read_file(input: &web_sys::HtmlInputElement) -> Option<String> {
    let file = input.files()?.get(0)?;
    let text = js_sys::futures::JsFuture::from(file.text()).await.ok()?;
    text.as_string()
}

/// The bytes of a file.
pub async fn bytes_of(file: &web_sys::File) -> Option<Vec<u8>> {
    let buffer = js_sys::futures::JsFuture::from(file.array_buffer()).await.ok()?;
    Some(js_sys::Uint8Array::new(&buffer).to_vec())
}

/// Offers a function to scripts of this page, such as a test's.
pub fn offer(name: &str, function: impl Fn() -> JsValue + 'static) {
    let closure = Closure::<dyn Fn() -> JsValue>::new(function);
    if let Some(window) = web_sys::window() {
        let _ = js_sys::Reflect::set(&window, &name.into(), closure.as_ref());
    }
    // Lives as long as the page.
    closure.forget();
}

/// Calls a function at every such event of the document.
pub fn on_document(event: &str, function: &js_sys::Function) {
    if let Some(document) = document() {
        // Refused only for a listener that is there already.
        let _ = document.add_event_listener_with_callback(event, function);
    }
}

fn document() -> Option<Document> {
    web_sys::window()?.document()
}

fn storage() -> Option<Storage> {
    web_sys::window()?.local_storage().ok()?
}
