//! A native modal dialog.

use web_sys::HtmlDialogElement;
use yew::prelude::*;

/// A dialog that is open as long as it is rendered.
#[derive(Clone, Debug, PartialEq, Properties)]
pub struct DialogProps {
    /// What it is about.
    pub title: AttrValue,
    /// For tests of the product.
    #[prop_or_default]
    pub test: Option<AttrValue>,
    /// Escape, or closed in another way.
    pub on_close: Callback<()>,
    /// Text and buttons.
    pub children: Html,
}

/// Rendering it opens it; the native element keeps the focus inside.
#[component]
pub fn Dialog(props: &DialogProps) -> Html {
    let node = use_node_ref();
    use_effect_with(node.clone(), |node| {
        let dialog = node.cast::<HtmlDialogElement>();
        if let Some(dialog) = &dialog {
            // Refused only for a dialog that is open already.
            let _ = dialog.show_modal();
        }
        move || {
            if let Some(dialog) = dialog {
                dialog.close();
            }
        }
    });
    let oncancel = use_callback(props.on_close.clone(), |event: Event, on_close| {
        // The owner decides: it stops rendering the dialog.
        event.prevent_default();
        on_close.emit(());
    });
    html! {
        <dialog ref={node} class="dialog" aria-labelledby="dialog-title" data-test={props.test.clone()} {oncancel}>
            <h2 id="dialog-title">{ &props.title }</h2>
            { props.children.clone() }
        </dialog>
    }
}
