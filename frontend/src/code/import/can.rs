//! What stands beside an empty field: what can be read.

use yew::prelude::*;

use super::super::i18n::tr;

/// By vendor.
pub(super) fn can_be_read() -> Html {
    html! {
        <section class="panel code-can" data-test="can">
            <h2>{ tr!("intake.can") }</h2>
            <dl>
                <dt>{ tr!("vendor.rockwell") }</dt><dd>{ tr!("intake.can_rockwell") }</dd>
                <dt>{ tr!("vendor.schneider") }</dt><dd>{ tr!("intake.can_schneider") }</dd>
                <dt>{ tr!("vendor.omron") }</dt><dd>{ tr!("intake.can_omron") }</dd>
                <dt>{ tr!("vendor.programs") }</dt><dd>{ tr!("intake.can_programs") }</dd>
                <dt>{ tr!("vendor.data") }</dt><dd>{ tr!("intake.can_data") }</dd>
            </dl>
            <p class="hint">{ tr!("intake.can_all") }</p>
        </section>
    }
}
