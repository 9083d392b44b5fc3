//! Oneself, the write window, and the relay's certificate.

use cipdeck_shared::api::{ActorKind, Caller, Role, SessionView};
use yew::prelude::*;

use super::{i18n::tr, password::PasswordForm, when, writing::WritingCard};
use crate::{
    access::role_word,
    hooks::{use_session, use_title},
    net::Writing,
};

/// What the relay says about writing.
#[derive(Clone, Debug, PartialEq, Properties)]
pub(super) struct OverviewProps {
    /// As it was heard last.
    pub(super) writing: std::rc::Rc<Writing>,
    /// Asks again.
    pub(super) on_changed: Callback<()>,
}

/// Three cards.
#[component]
pub(super) fn OverviewPage(props: &OverviewProps) -> Html {
    use_title(&tr!("overview.title"));
    let Some(view) = use_session() else { return html! {} };
    let Some(caller) = &view.caller else { return html! {} };
    html! { <>
        <h1>{ tr!("overview.title") }</h1>
        <div class="cards">
            { oneself(caller) }
            <WritingCard writing={props.writing.clone()} on_changed={props.on_changed.clone()} />
            { certificate(&view) }
            if caller.kind == ActorKind::Person {
                <PasswordForm />
            }
        </div>
    </> }
}

fn oneself(caller: &Caller) -> Html {
    let kind = match caller.kind {
        ActorKind::Person => tr!("overview.person"),
        ActorKind::Token => tr!("overview.token"),
        ActorKind::ViewLink => tr!("overview.view_link"),
        ActorKind::Local => tr!("overview.local"),
        ActorKind::Relay => tr!("overview.relay"),
    };
    html! {
        <section class="panel">
            <h2>{ tr!("overview.you") }</h2>
            <dl class="facts">
                <dt>{ tr!("overview.name") }</dt><dd>{ &caller.name }</dd>
                <dt>{ tr!("overview.role") }</dt><dd>{ role_word(caller.role) }</dd>
                <dt>{ tr!("overview.kind") }</dt><dd>{ kind }</dd>
                if let Some(ends_at) = &caller.ends_at {
                    <dt>{ tr!("overview.ends") }</dt>
                    <dd>
                        { when(ends_at) }
                        if let Some(minutes) = caller.idle_minutes {
                            { tr!("overview.idle", minutes = minutes) }
                        }
                    </dd>
                }
            </dl>
            <p class="hint">{ may(caller.role) }</p>
        </section>
    }
}

/// What a role may do, in a sentence.
pub(super) fn may(role: Role) -> AttrValue {
    match role {
        Role::Viewer => tr!("role_may.viewer"),
        Role::Operator => tr!("role_may.operator"),
        Role::Engineer => tr!("role_may.engineer"),
        Role::Admin => tr!("role_may.admin"),
    }
}

fn certificate(view: &SessionView) -> Html {
    html! {
        <section class="panel">
            <h2>{ tr!("certificate.title") }</h2>
            if view.fingerprint.is_some() {
                { fingerprint(view.fingerprint.as_deref()) }
                <p class="hint">{ tr!("certificate.hint") }</p>
            } else {
                <p class="hint">{ tr!("certificate.none") }</p>
            }
        </section>
    }
}

/// The SHA-256 of the certificate, as browsers show it.
pub(super) fn fingerprint(hex: Option<&str>) -> Html {
    let Some(hex) = hex else { return html! {} };
    // With or without colons.
    let digits: Vec<_> = hex.chars().filter(char::is_ascii_hexdigit).collect();
    let pairs: Vec<String> =
        digits.chunks(2).map(|pair| pair.iter().collect::<String>().to_ascii_uppercase()).collect();
    html! {
        <p class="fingerprint">
            <span>{ tr!("certificate.fingerprint") }</span>
            <code class="mono" data-test="fingerprint">{ pairs.join(":") }</code>
        </p>
    }
}
