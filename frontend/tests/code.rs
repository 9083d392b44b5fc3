//! The field for code and the sheet, in a real browser.
#![cfg(target_arch = "wasm32")]
#![allow(clippy::unwrap_used, reason = "a test may fail")]

mod page;

use std::rc::Rc;

use cipdeck_frontend::code::{
    import::editor::{CodeEditor, CodeEditorProps, Mark, Wish},
    lines::Lines,
    sheet::{CodeSheet, CodeSheetProps},
};
use cipdeck_shared::{code::Dialect, plan::Severity};
use page::{find, render, text, try_find};
use wasm_bindgen::JsCast;
use wasm_bindgen_test::{wasm_bindgen_test, wasm_bindgen_test_configure};
use web_sys::HtmlTextAreaElement;
use yew::Callback;

wasm_bindgen_test_configure!(run_in_browser);

fn editor(text: &str, marks: Vec<Mark>, wish: Wish, on_text: Callback<String>) -> CodeEditorProps {
    let text: Rc<str> = text.into();
    let lines = Rc::new(Lines::in_one(&text, Dialect::CcwSt));
    CodeEditorProps { text, lines, marks: marks.into(), wish, on_text }
}

#[wasm_bindgen_test]
async fn a_sheet_is_its_code_and_nothing_else() {
    let code = "a := 16#0E; (* 14 *)\n\n<b c=\"&amp;\"/>";
    let lines = Rc::new(Lines::in_one(&code.into(), Dialect::CcwSt));
    let root = render::<CodeSheet>(CodeSheetProps { label: "Code".into(), lines }).await;
    assert_eq!(text(&root, "pre").trim_end(), code);
    assert_eq!(root.query_selector_all(".code-line").unwrap().length(), 3);
}

#[wasm_bindgen_test]
async fn a_line_that_is_not_understood_is_marked() {
    let mark = Mark { line: 2, severity: Severity::Error };
    let root = render::<CodeEditor>(editor("a\nb\nc", vec![mark], Wish::default(), Callback::noop())).await;
    assert_eq!(text(&root, ".code-number.error"), "2");
    assert_eq!(text(&root, ".code-drawn.error"), "b");
}

#[wasm_bindgen_test]
async fn a_wish_selects_its_line_in_whatever_letters() {
    let wish = Wish { line: 2, number: 1 };
    let root = render::<CodeEditor>(editor("é𝄞\nhere\nc", vec![], wish, Callback::noop())).await;
    let field: HtmlTextAreaElement = find(&root, "textarea").unchecked_into();
    let selected = (field.selection_start().unwrap(), field.selection_end().unwrap());
    assert_eq!(selected, (Some(4), Some(8)), "in UTF-16");
}

#[wasm_bindgen_test]
async fn ten_thousand_lines_are_a_few_in_the_document() {
    let long = "x := 1;\n".repeat(10_000);
    let root = render::<CodeEditor>(editor(&long, vec![], Wish::default(), Callback::noop())).await;
    let drawn = root.query_selector_all(".code-drawn").unwrap().length();
    assert!(drawn > 0 && drawn < 120, "{drawn} lines in the document");
}

#[wasm_bindgen_test]
async fn a_line_that_is_too_long_to_draw_is_still_shown() {
    let root =
        render::<CodeEditor>(editor(&"ab ".repeat(9_000), vec![], Wish::default(), Callback::noop())).await;
    assert!(try_find(&root, ".code-layer").is_none());
    assert!(try_find(&root, ".code-editor.plain textarea").is_some());
}

#[wasm_bindgen_test]
async fn what_is_typed_is_told() {
    let heard = Rc::new(std::cell::RefCell::new(String::new()));
    let hear = heard.clone();
    let on_text = Callback::from(move |text| *hear.borrow_mut() = text);
    let root = render::<CodeEditor>(editor("", vec![], Wish::default(), on_text)).await;
    let field: HtmlTextAreaElement = find(&root, "textarea").unchecked_into();
    field.set_value("a\nb");
    let bubbles = web_sys::EventInit::new();
    bubbles.set_bubbles(true);
    field.dispatch_event(&web_sys::Event::new_with_event_init_dict("input", &bubbles).unwrap()).unwrap();
    yew::scheduler::flush().await;
    assert_eq!(*heard.borrow(), "a\nb");
}
