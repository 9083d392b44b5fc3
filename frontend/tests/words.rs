//! Words in cells in a real browser: which byte is which, what it says, and how the keys walk.
#![cfg(target_arch = "wasm32")]
#![allow(clippy::unwrap_used, reason = "a test may fail")]

mod page;

use std::rc::Rc;

use cipdeck_frontend::words::grid::{WordGrid, WordGridProps};
use cipdeck_shared::{config::bytes_of, dissect};
use page::{find, render, text};
use wasm_bindgen_test::{wasm_bindgen_test, wasm_bindgen_test_configure};
use web_sys::{Element, KeyboardEvent, KeyboardEventInit};

wasm_bindgen_test_configure!(run_in_browser);

/// Get_Attribute_Single of Identity 1/1/7, of which so many bytes are sent.
async fn grid(bytes: usize) -> Element {
    let words = [0x030E, 0x0120, 0x0124, 0x0730];
    let tree = Rc::new(dissect::request(&bytes_of(&words)));
    let words = Rc::<[u16]>::from(words);
    render::<WordGrid>(WordGridProps { label: "Data_to_Send".into(), words, tree, bytes, test: None }).await
}

async fn focus(root: &Element, byte: usize) {
    find(root, &format!("[data-byte='{byte}']")).focus().unwrap();
    yew::scheduler::flush().await;
}

async fn press(root: &Element, key: &str) {
    let active = root.owner_document().unwrap().active_element().unwrap();
    let options = KeyboardEventInit::new();
    options.set_key(key);
    options.set_bubbles(true);
    let event = KeyboardEvent::new_with_keyboard_event_init_dict("keydown", &options).unwrap();
    active.dispatch_event(&event).unwrap();
    yew::scheduler::flush().await;
}

#[wasm_bindgen_test]
async fn a_word_shows_its_high_byte_first_and_numbers_count_words() {
    let root = grid(8).await;
    let first = find(&root, ".word");
    let halves: Vec<_> = first.text_content().unwrap().split_whitespace().map(str::to_owned).collect();
    assert_eq!(halves.concat(), "0030E", "number 0, then 03, then 0E");
    let high = find(&first, "button");
    assert_eq!(high.get_attribute("data-byte").as_deref(), Some("1"), "on the wire it is second");
}

#[wasm_bindgen_test]
async fn each_byte_says_what_it_is_together_with_those_that_belong_to_it() {
    let root = grid(8).await;
    focus(&root, 0).await;
    let said = text(&root, ".explanation");
    assert!(said.contains("word 0, low byte") && said.contains("Get_Attribute_Single"), "{said}");
    assert!(said.contains("16#030E = 782"), "{said}");
    focus(&root, 2).await;
    let together = root.query_selector_all(".together").unwrap().length();
    assert_eq!(together, 2, "the class is two bytes: its segment and its number");
}

#[wasm_bindgen_test]
async fn the_keys_walk_as_the_words_are_read() {
    let root = grid(8).await;
    focus(&root, 1).await;
    let at = |root: &Element| {
        let active = root.owner_document().unwrap().active_element().unwrap();
        active.get_attribute("data-byte").unwrap_or_default()
    };
    for (key, byte) in
        [("ArrowRight", "0"), ("ArrowRight", "3"), ("End", "6"), ("ArrowLeft", "7"), ("Home", "1")]
    {
        press(&root, key).await;
        assert_eq!(at(&root), byte, "{key}");
    }
}

#[wasm_bindgen_test]
async fn one_byte_takes_the_tab_key_and_bytes_that_stay_behind_are_marked() {
    let root = grid(7).await;
    assert_eq!(root.query_selector_all("[tabindex='0']").unwrap().length(), 1);
    let last = find(&root, ".unsent");
    assert_eq!(last.get_attribute("data-byte").as_deref(), Some("7"));
}
