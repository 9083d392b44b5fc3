//! Whether the chain holds, and can be written.

use cipdeck_shared::api::AuditState;
use yew::prelude::*;

use crate::office::{fetch::use_fetched, i18n::tr, kit::waiting};

/// One sentence, and the newest hash.
#[component]
pub(super) fn ChainState() -> Html {
    let state = use_fetched::<AuditState>("audit/state".to_owned());
    let Some(chain) = &state.data else { return waiting(&state) };
    html! {
        <section class="panel" data-test="chain">
            if let Some(trouble) = &chain.trouble {
                <p class="warning-text" role="alert">{ trouble }</p>
            }
            <p>
                { tr!("audit.records", count = chain.records) }{ " " }
                { if chain.verified { tr!("audit.verified") } else { tr!("audit.verifying") } }{ " " }
                { if chain.writable { tr!("audit.writable") } else { tr!("audit.not_writable") } }
            </p>
            <p class="hint">{ tr!("audit.head", seq = chain.head.seq) }{ " " }<code class="mono hash">{ &chain.head.hash }</code></p>
        </section>
    }
}
