//! Who did what: the records, newest first.

mod record;
mod state;

use cipdeck_shared::api::AuditPage as Records;
use yew::prelude::*;

use self::{record::record, state::ChainState};
use super::{
    fetch::use_fetched,
    i18n::tr,
    kit::{Entry, choice, note, waiting},
    query::query,
};
use crate::{
    hooks::use_title,
    i18n::{EVENT, find},
    net::rest,
};

/// What is asked for. Typing changes it; the button, or a choice, asks.
#[derive(Clone, Debug, Default, PartialEq)]
struct Filter {
    event: String,
    actor: String,
    block: String,
    from: String,
    to: String,
    before: String,
}

impl Filter {
    fn resource(&self) -> String {
        let pairs = [
            ("event", self.event.as_str()),
            ("actor", self.actor.trim()),
            ("block", self.block.trim()),
            ("from", self.from.trim()),
            ("to", self.to.trim()),
            ("before", self.before.as_str()),
        ];
        format!("audit{}", query(&pairs))
    }
}

/// Filter, state of the chain, records, export.
#[component]
pub(super) fn AuditPage() -> Html {
    use_title(&tr!("audit.title"));
    let wanted = use_state(Filter::default);
    let records = use_fetched::<Records>(wanted.resource());
    let event = use_state(String::new);
    let (actor, block) = (use_state(String::new), use_state(String::new));
    let (from, to) = (use_state(String::new), use_state(String::new));
    let typed = Filter {
        event: (*event).clone(),
        actor: (*actor).clone(),
        block: (*block).clone(),
        from: (*from).clone(),
        to: (*to).clone(),
        before: String::new(),
    };
    let onsubmit = {
        let (wanted, reload) = (wanted.clone(), records.reload.clone());
        move |submit: SubmitEvent| {
            submit.prevent_default();
            if *wanted == typed {
                reload.emit(());
            } else {
                wanted.set(typed.clone());
            }
        }
    };
    let on_event = {
        let event = event.clone();
        Callback::from(move |word: String| event.set(word))
    };
    let older = records.data.as_ref().and_then(|page| page.more).map(|before| {
        let wanted = wanted.clone();
        let onclick = move |_: MouseEvent| wanted.set(Filter { before: before.to_string(), ..(*wanted).clone() });
        html! { <button type="button" class="button" {onclick} data-test="older">{ tr!("audit.older") }</button> }
    });
    html! { <>
        <h1>{ tr!("audit.title") }</h1>
        <ChainState />
        <form class="inline-form filters" {onsubmit}>
            { choice("audit-event", tr!("audit.event"), &event, &events(), on_event) }
            { Entry::text("audit-actor", tr!("audit.actor"), &actor).draw() }
            { Entry::text("audit-block", tr!("audit.block"), &block).draw() }
            { Entry::text("audit-from", tr!("audit.from"), &from).draw() }
            { Entry::text("audit-to", tr!("audit.to"), &to).draw() }
            <button type="submit" class="button primary" data-test="audit-filter">{ tr!("audit.show") }</button>
            <a class="export" href={rest::address("audit.jsonl")} download="">{ tr!("audit.export") }</a>
        </form>
        { note(tr!("audit.time_hint")) }
        { waiting(&records) }
        if let Some(page) = &records.data {
            if page.records.is_empty() {
                { note(tr!("audit.none")) }
            } else {
                <div class="scroll"><table class="listing" aria-label={tr!("audit.title")}>
                    <thead><tr>
                        <th scope="col">{ tr!("audit.at") }</th><th scope="col">{ tr!("audit.event") }</th>
                        <th scope="col">{ tr!("audit.actor") }</th><th scope="col">{ tr!("audit.what") }</th>
                    </tr></thead>
                    <tbody>{ for page.records.iter().map(record) }</tbody>
                </table></div>
            }
        }
        <div class="choices">
            if !wanted.before.is_empty() {
                <button type="button" class="button" onclick={move |_: MouseEvent| wanted.set(Filter { before: String::new(), ..(*wanted).clone() })}>
                    { tr!("audit.newest") }
                </button>
            }
            { older }
        </div>
    </> }
}

/// All events, for a choice; nothing chosen means all.
fn events() -> Vec<(AttrValue, AttrValue)> {
    let words = EVENTS.iter().map(|word| ((*word).into(), event_words(word)));
    std::iter::once(("".into(), tr!("audit.all"))).chain(words).collect()
}

/// An event in words; one of a newer relay by its own word.
fn event_words(word: &str) -> AttrValue {
    find(EVENT, word).map_or_else(|| word.to_owned().into(), AttrValue::Static)
}

/// As docs/AUDIT.md has them.
const EVENTS: [&str; 32] = [
    "write_requested",
    "write_permitted",
    "write_ended",
    "write_read_back",
    "write_denied",
    "window_opened",
    "window_closed",
    "read_only_on",
    "read_only_off",
    "sign_in",
    "sign_in_failed",
    "sign_out",
    "session_ended",
    "setup",
    "user_created",
    "user_changed",
    "user_deleted",
    "password_changed",
    "token_created",
    "token_revoked",
    "list_added",
    "list_removed",
    "block_created",
    "block_changed",
    "block_deleted",
    "plant_changed",
    "certificate_reloaded",
    "start",
    "stop",
    "chain_broken",
    "chain_accepted",
    "audit_resumed",
];

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn every_event_has_words() {
        for word in EVENTS {
            assert_ne!(event_words(word), word);
        }
        assert_eq!(event_words("of_tomorrow"), "of_tomorrow");
    }
}
