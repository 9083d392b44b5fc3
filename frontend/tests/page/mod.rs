//! What the component tests share: a place on the page, and eyes and hands.
#![allow(dead_code, unreachable_pub, reason = "each file of tests uses a part")]
#![allow(clippy::unwrap_used, reason = "a test may fail")]

use cipdeck_shared::config::MsgCipGeneric;
use wasm_bindgen::JsCast;
use web_sys::{Element, Event, EventInit, HtmlElement, HtmlInputElement};
use yew::BaseComponent;

/// Renders a component into an element of its own.
pub async fn render<C: BaseComponent>(props: C::Properties) -> Element {
    let document = web_sys::window().unwrap().document().unwrap();
    let root = document.create_element("div").unwrap();
    document.body().unwrap().append_child(&root).unwrap();
    yew::Renderer::<C>::with_root_and_props(root.clone(), props).render();
    yew::scheduler::flush().await;
    root
}

/// The element of a selector; there has to be one.
pub fn find(root: &Element, selector: &str) -> HtmlElement {
    try_find(root, selector).unwrap_or_else(|| panic!("no {selector} in {}", root.inner_html()))
}

/// The element of a selector, if there is one.
pub fn try_find(root: &Element, selector: &str) -> Option<HtmlElement> {
    root.query_selector(selector).unwrap().map(JsCast::unchecked_into)
}

/// The text that people see.
pub fn text(root: &Element, selector: &str) -> String {
    find(root, selector).text_content().unwrap_or_default()
}

/// Replaces the text of an input, as typing does.
pub async fn type_into(root: &Element, selector: &str, text: &str) {
    let input: HtmlInputElement = find(root, selector).unchecked_into();
    input.set_value(text);
    let bubbles = EventInit::new();
    bubbles.set_bubbles(true);
    input.dispatch_event(&Event::new_with_event_init_dict("input", &bubbles).unwrap()).unwrap();
    yew::scheduler::flush().await;
}

/// Clicks, and lets the page render.
pub async fn click(root: &Element, selector: &str) {
    find(root, selector).click();
    yew::scheduler::flush().await;
}

/// Set_Attribute_Single to the output assembly of the demo device.
pub fn a_write() -> MsgCipGeneric {
    let mut config = MsgCipGeneric::product_name("0,0");
    config.app_cfg.service = 16;
    (config.app_cfg.class, config.app_cfg.instance, config.app_cfg.attribute) = (4, 150, 3);
    config.req_data = "01".repeat(32);
    config
}
