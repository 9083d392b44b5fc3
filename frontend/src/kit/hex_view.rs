//! Bytes in cells. Each part says what it is when it is pointed at or focused; arrow keys walk through the parts.

use std::rc::Rc;

use cipdeck_shared::dissect::Node;
use wasm_bindgen::JsCast;
use web_sys::HtmlElement;
use yew::prelude::*;

use crate::i18n::tr;

/// Bytes and what they mean.
#[derive(Clone, Debug, PartialEq, Properties)]
pub struct HexViewProps {
    /// What these bytes are.
    pub label: AttrValue,
    /// The bytes.
    pub bytes: Rc<[u8]>,
    /// Their parts, from `dissect`.
    pub tree: Rc<Node>,
    /// Says how to see what a byte is, while none is chosen.
    #[prop_or_default]
    pub hint: bool,
    /// For tests of the product.
    #[prop_or_default]
    pub test: Option<AttrValue>,
}

/// Cells in groups, and the explanation of the one that is pointed at.
#[component]
pub fn HexView(props: &HexViewProps) -> Html {
    let leaves = use_memo(props.tree.clone(), |tree| leaves(tree, ""));
    let chosen = use_state_eq(|| None::<usize>);
    let shown = chosen.and_then(|index| leaves.get(index));
    let choose = use_callback((), {
        let chosen = chosen.clone();
        move |index: usize, ()| chosen.set(Some(index))
    });
    let parts = leaves.iter().enumerate().map(|(index, leaf)| {
        let bytes = props.bytes.get(leaf.from..leaf.to).unwrap_or_default();
        // One stop for the tab key: the chosen part, or the first.
        let tabindex = if index == chosen.unwrap_or(0) { "0" } else { "-1" };
        let (over, focus) = (choose.reform(move |_: MouseEvent| index), choose.reform(move |_: FocusEvent| index));
        let class = classes!("part", leaf.error.then_some("broken"), (*chosen == Some(index)).then_some("chosen"));
        html! {
            <li key={index}>
                <button type="button" {class} {tabindex} aria-label={leaf.spoken(bytes)} onmouseover={over} onfocus={focus} onkeydown={walk}>
                    { for bytes.iter().map(|byte| html! { <span class="byte">{ format!("{byte:02X}") }</span> }) }
                </button>
            </li>
        }
    });
    html! {
        <div class="hex-view" data-test={props.test.clone()}>
            <ol class="parts" aria-label={props.label.clone()}>{ for parts }</ol>
            <p class="explanation" aria-hidden="true">
                if let Some(leaf) = shown {
                    <span class="explanation-at">{ leaf.place() }</span>
                    <b>{ &leaf.name }</b>
                    <span>{ &leaf.text }</span>
                } else if props.hint {
                    <span class="quiet">{ tr!("bytes.point") }</span>
                }
            </p>
        </div>
    }
}

/// A part without parts, with the names above it.
#[derive(Clone, Debug, PartialEq)]
pub(crate) struct Leaf {
    pub(crate) from: usize,
    pub(crate) to: usize,
    pub(crate) name: String,
    pub(crate) text: String,
    pub(crate) error: bool,
}

impl Leaf {
    fn place(&self) -> String {
        match self.to - self.from {
            1 => format!("{}", self.from),
            _ => format!("{}–{}", self.from, self.to.saturating_sub(1)),
        }
    }

    fn spoken(&self, bytes: &[u8]) -> String {
        let bytes: Vec<_> = bytes.iter().map(|byte| format!("{byte:02X}")).collect();
        format!("{}: {} {}", bytes.join(" "), self.name, self.text)
    }
}

/// The parts without parts, in the order of their bytes.
pub(crate) fn leaves(node: &Node, above: &str) -> Vec<Leaf> {
    if node.children.is_empty() {
        let name =
            if above.is_empty() { node.name.to_string() } else { format!("{above} › {}", node.name) };
        let (text, error) = (node.text.clone(), node.error);
        return vec![Leaf { from: node.from, to: node.to, name, text, error }];
    }
    // The root is named by the heading already.
    let above = if node.from == 0 && above.is_empty() { String::new() } else { node.name.to_string() };
    node.children.iter().flat_map(|child| leaves(child, &above)).collect()
}

/// Left and right move to the neighbouring part, home and end to the first and last.
#[expect(clippy::needless_pass_by_value, reason = "the signature of an event handler")]
fn walk(event: KeyboardEvent) {
    let Some(item) = event.target_unchecked_into::<HtmlElement>().parent_element() else { return };
    let to = match event.key().as_str() {
        "ArrowRight" => item.next_element_sibling(),
        "ArrowLeft" => item.previous_element_sibling(),
        "Home" => item.parent_element().and_then(|list| list.first_element_child()),
        "End" => item.parent_element().and_then(|list| list.last_element_child()),
        _ => return,
    };
    event.prevent_default();
    if let Some(button) =
        to.and_then(|item| item.first_element_child()).and_then(|it| it.dyn_into::<HtmlElement>().ok())
    {
        // Nothing to say about an element that cannot take the focus.
        let _ = button.focus();
    }
}
