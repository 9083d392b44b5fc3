//! A text that is shown once: a secret, an address.

use yew::prelude::*;

use crate::{browser, office::i18n::tr};

/// The text and a button that copies it.
#[derive(Clone, Debug, PartialEq, Properties)]
pub struct CopyOnceProps {
    /// What it is.
    pub label: AttrValue,
    /// The text.
    pub text: AttrValue,
    /// For tests of the product.
    pub test: &'static str,
}

/// Selectable, too: a browser may not allow the button.
#[component]
pub fn CopyOnce(props: &CopyOnceProps) -> Html {
    let said = use_state(|| None::<AttrValue>);
    let onclick = {
        let (said, text) = (said.clone(), props.text.clone());
        move |_: MouseEvent| {
            let said = said.clone();
            browser::copy(&text, move |done| {
                said.set(Some(if done { tr!("copy.done") } else { tr!("copy.refused") }));
            });
        }
    };
    html! {
        <div class="copy-once">
            <span class="copy-label">{ &props.label }</span>
            <code class="mono" data-test={props.test}>{ &props.text }</code>
            <button type="button" class="button" {onclick}>{ tr!("copy.do") }</button>
            <span role="status" class="hint">{ (*said).clone().unwrap_or_default() }</span>
        </div>
    }
}
