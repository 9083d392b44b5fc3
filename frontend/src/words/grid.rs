//! Words in cells, high byte first as Control Expert shows them. Each byte says what it is when it is pointed at or focused;
//! arrow keys walk from byte to byte.

use std::rc::Rc;

use cipdeck_shared::dissect::Node;
use wasm_bindgen::JsCast;
use web_sys::HtmlElement;
use yew::prelude::*;

use super::i18n::tr;
use crate::kit::{Leaf, leaves};

/// Words and what they mean.
#[derive(Clone, Debug, PartialEq, Properties)]
pub struct WordGridProps {
    /// What these words are.
    pub label: AttrValue,
    /// The words.
    pub words: Rc<[u16]>,
    /// The parts of their bytes, low byte first.
    pub tree: Rc<Node>,
    /// Bytes that are sent, or were received; the others are there, but quiet.
    pub bytes: usize,
    /// For tests of the product.
    #[prop_or_default]
    pub test: Option<AttrValue>,
}

/// Numbered cells, and the explanation of the byte that is pointed at.
#[component]
pub fn WordGrid(props: &WordGridProps) -> Html {
    let leaves = use_memo(props.tree.clone(), |tree| leaves(tree, ""));
    let chosen = use_state_eq(|| None::<usize>);
    let choose = use_callback(chosen.clone(), |byte: usize, chosen| chosen.set(Some(byte)));
    let leaf_of = |byte: usize| leaves.iter().find(|leaf| (leaf.from..leaf.to).contains(&byte));
    let shown = chosen.and_then(|byte| Some((byte, *props.words.get(byte / 2)?, leaf_of(byte)?)));
    let half = |byte: usize, word: u16| {
        let leaf = leaf_of(byte);
        let value = word.to_le_bytes().get(byte % 2).copied().unwrap_or_default();
        let class = classes!(
            "half",
            leaf.is_some_and(|leaf| leaf.error).then_some("broken"),
            (byte >= props.bytes).then_some("unsent"),
            (*chosen == Some(byte)).then_some("chosen"),
            shown.is_some_and(|(_, _, it)| leaf == Some(it)).then_some("together"),
        );
        // One stop for the tab key: the chosen byte, or the first.
        let tabindex = if byte == chosen.unwrap_or(1) { "0" } else { "-1" };
        let (over, focus) =
            (choose.reform(move |_: MouseEvent| byte), choose.reform(move |_: FocusEvent| byte));
        html! {
            <button
                type="button" {class} {tabindex} data-byte={byte.to_string()} onmouseover={over} onfocus={focus} onkeydown={walk}
                aria-label={format!("{} {value:02X}: {}", place(byte), leaf.map(spoken).unwrap_or_default())}
            >
                { format!("{value:02X}") }
            </button>
        }
    };
    let cell = |(number, word): (usize, &u16)| {
        html! {
            <li key={number} class="word">
                <span class="word-number" aria-hidden="true">{ number }</span>
                { half(2 * number + 1, *word) }
                { half(2 * number, *word) }
            </li>
        }
    };
    html! {
        <div class="word-grid" data-test={props.test.clone()}>
            <ol class="words" aria-label={props.label.clone()}>{ for props.words.iter().enumerate().map(cell) }</ol>
            <p class="explanation" aria-hidden="true">
                if let Some((byte, word, leaf)) = shown {
                    <span class="explanation-at">{ place(byte) }</span>
                    <b>{ &leaf.name }</b>
                    <span class={classes!(leaf.error.then_some("broken-text"))}>{ &leaf.text }</span>
                    <span class="quiet">{ format!("16#{word:04X} = {word}") }</span>
                } else {
                    <span class="quiet">{ tr!("grid.point") }</span>
                }
            </p>
        </div>
    }
}

/// `word 1, low`
fn place(byte: usize) -> AttrValue {
    let word = byte / 2;
    if byte.is_multiple_of(2) { tr!("grid.low", word = word) } else { tr!("grid.high", word = word) }
}

fn spoken(leaf: &Leaf) -> String {
    format!("{} {}", leaf.name, leaf.text)
}

/// Left and right move to the neighbouring byte as it is written, home and end to the first and last.
#[expect(clippy::needless_pass_by_value, reason = "the signature of an event handler")]
fn walk(event: KeyboardEvent) {
    let button: HtmlElement = event.target_unchecked_into();
    let Ok(Some(list)) = button.closest("ol") else { return };
    let Ok(buttons) = list.query_selector_all("button") else { return };
    let here = (0..buttons.length())
        .find(|at| buttons.get(*at).is_some_and(|it| it.is_same_node(Some(&button))))
        .unwrap_or_default();
    let to = match event.key().as_str() {
        "ArrowRight" => here + 1,
        "ArrowLeft" => here.saturating_sub(1),
        "Home" => 0,
        "End" => buttons.length().saturating_sub(1),
        _ => return,
    };
    event.prevent_default();
    if let Some(button) = buttons.get(to).and_then(|it| it.dyn_into::<HtmlElement>().ok()) {
        // Nothing to say about an element that cannot take the focus.
        let _ = button.focus();
    }
}
