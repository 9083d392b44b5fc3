//! SEND_REQ and DATA_EXCH: blocks in Control Expert's terms, in a document of their own.
//!
//! | module | job |
//! | --- | --- |
//! | [`edit`] | typed text → draft → words → findings; no browser in it |
//! | [`desk`] | rows, drafts and commands of these blocks |
//! | [`route`] | the addresses of its pages |
//! | `list`, `new`, `block` | the pages |
//! | [`grid`] | words in cells, each byte explained |
//! | `verdict` | whether the exchange was correct, and whether the device agreed |

mod block;
pub mod desk;
pub mod edit;
mod explain;
mod frame;
pub mod grid;
mod hooks;
mod i18n;
mod list;
mod new;
pub mod route;
mod verdict;

use yew::prelude::*;

use self::{desk::Desk, frame::Frame};

/// Where drafts are kept in the browser's local storage.
const DRAFTS: &str = "cipdeck.words";

/// The whole document.
#[component]
pub fn Words() -> Html {
    let desk = use_memo((), |()| Desk::open(DRAFTS));
    html! {
        <ContextProvider<Desk> context={(*desk).clone()}>
            <Frame />
        </ContextProvider<Desk>>
    }
}
