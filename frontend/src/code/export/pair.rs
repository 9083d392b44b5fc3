//! Two blocks beside each other: what each sends, where to, how long it waits.

use cipdeck_shared::{code::Kind, config::BlockConfig, plan::MessagePlan, wire::Epath};
use yew::prelude::*;

use super::super::{facts, i18n::tr};

/// What of two blocks differs in what a device gets.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub(super) struct Differences {
    /// The bytes of the request.
    pub(super) bytes: bool,
    /// The device, or the way to it.
    pub(super) target: bool,
}

impl Differences {
    /// Looks at what would be sent, not at what a conversion says of itself. A block that sends nothing differs in nothing.
    pub(super) fn of(before: Option<&MessagePlan>, after: Option<&MessagePlan>) -> Self {
        let Some((before, after)) = before.zip(after) else { return Self::default() };
        Self {
            bytes: before.bytes() != after.bytes(),
            target: before.target() != after.target() || route(before) != route(after),
        }
    }
}

fn route(plan: &MessagePlan) -> &Epath {
    plan.routed(plan.profile()).route()
}

/// A block and its plan.
pub(super) type Side<'a> = (&'a BlockConfig, Option<&'a MessagePlan>);

/// Both in two columns; bytes that differ are marked.
pub(super) fn pair(before: Side<'_>, after: Side<'_>) -> Html {
    let differences = Differences::of(before.1, after.1);
    let is_known = before.1.is_some() && after.1.is_some();
    html! { <>
        <div class="code-pair" data-test="pair">
            { side(tr!("another.before", kind = Kind::of(before.0)), before, after, "before") }
            { side(tr!("another.after", kind = Kind::of(after.0)), after, before, "after") }
        </div>
        if is_known && differences.bytes {
            <p class="finding error" data-test="bytes-differ">{ tr!("another.differ") }</p>
        } else if is_known {
            <p class="code-all" data-test="bytes-equal">{ tr!("another.equal") }</p>
        }
    </> }
}

fn side(title: AttrValue, (config, plan): Side<'_>, (_, other): Side<'_>, test: &'static str) -> Html {
    html! {
        <section class="code-side" data-test={test}>
            <h3>{ title }</h3>
            <dl class="facts">
                <dt>{ tr!("another.target") }</dt><dd class="mono">{ config.target_text().to_owned() }</dd>
                if let Some(plan) = plan {
                    <dt>{ tr!("another.timeout") }</dt><dd>{ timeout(plan) }</dd>
                    <dt>{ tr!("found.request") }</dt><dd>{ facts::in_words(plan) }</dd>
                    <dt>{ tr!("another.request") }</dt>
                    <dd data-test="bytes">{ facts::marked(plan.bytes(), other.map(|other| &**other.bytes()).unwrap_or_default()) }</dd>
                    if let BlockConfig::SendReq(block) = config {
                        <dt>{ tr!("another.words") }</dt><dd class="mono" data-test="words">{ &block.data_to_send }</dd>
                    }
                } else {
                    <dt>{ tr!("another.request") }</dt><dd class="finding error">{ tr!("another.unknown") }</dd>
                }
            </dl>
        </section>
    }
}

fn timeout(plan: &MessagePlan) -> AttrValue {
    match (plan.words(), plan.connection()) {
        (Some(words), _) => match words.timeout_ms {
            Some(ms) => tr!("another.timeout_ms", ms = ms),
            None => tr!("another.for_ever"),
        },
        (None, Some(connection)) => tr!("another.timeout_ms", ms = connection.timeout_ms),
        (None, None) => tr!("another.timeout_ms", ms = plan.ucmm_timeout_ms()),
    }
}
