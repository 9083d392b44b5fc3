//! Signing in.

use cipdeck_shared::api::{SessionState, SignIn};
use gloo_net::http::Method;
use yew::{platform::spawn_local, prelude::*};

use super::{
    check,
    i18n::tr,
    kit::Entry,
    route::{Page, link, next},
};
use crate::{
    address, browser,
    hooks::{use_second, use_session, use_title},
    net::{rest, session},
    pages::block::words,
};

/// Why it has not worked.
#[derive(Clone, Debug, PartialEq)]
enum Refused {
    /// In words.
    For(String),
    /// In words, and from when on it makes sense to try again, in ms of [`browser::now_ms`].
    Until(f64),
}

/// Name and password; goes back to where somebody came from.
#[component]
pub(super) fn SignInPage() -> Html {
    use_title(&tr!("sign_in.title"));
    let view = use_session();
    let (name, password) = (use_state(String::new), use_state(String::new));
    let refused = use_state(|| None::<Refused>);
    let (busy, tried) = (use_state(|| false), use_state(|| false));
    let wait = match *refused {
        Some(Refused::Until(until)) => seconds_until(until),
        _ => 0,
    };
    use_second(wait > 0);
    let onsubmit = {
        let (name, password, refused, busy, tried) =
            (name.clone(), password.clone(), refused.clone(), busy.clone(), tried.clone());
        move |event: SubmitEvent| {
            event.prevent_default();
            tried.set(true);
            let form = SignIn { name: name.trim().to_owned(), password: (*password).clone() };
            if *busy || wait > 0 || form.name.is_empty() || form.password.is_empty() {
                return;
            }
            busy.set(true);
            let (refused, busy, password) = (refused.clone(), busy.clone(), password.clone());
            spawn_local(async move {
                let answer = sign_in(form).await;
                busy.set(false);
                match answer {
                    Ok(()) => address::load(&next(&address::query())),
                    Err(why) => {
                        password.set(String::new());
                        refused.set(Some(why));
                    }
                }
            });
        }
    };
    let missing = |text: &str| tried.then(|| check::needed(text)).flatten();
    let needs_set_up = view.as_ref().is_some_and(|view| view.state == SessionState::SetUp);
    let present = view.as_ref().and_then(|view| view.caller.as_ref());
    html! {
        <section class="card">
            <h1>{ tr!("sign_in.title") }</h1>
            if needs_set_up {
                <p>{ tr!("sign_in.set_up") }{ " " }{ link(Page::SetUp, "", html! { tr!("sign_in.to_set_up") }) }</p>
            }
            if let Some(caller) = present {
                <p class="hint">{ tr!("sign_in.already", name = caller.name) }</p>
            }
            <form {onsubmit}>
                { Entry { autocomplete: "username", ..Entry::text("name", tr!("sign_in.name"), &name).problem(missing(&name)) }.draw() }
                { Entry::password("password", tr!("sign_in.password"), &password, "current-password").problem(missing(&password).filter(|_| refused.is_none())).draw() }
                { why(refused.as_ref(), wait) }
                <button type="submit" class="button primary wide" disabled={*busy || wait > 0} data-test="sign-in">{ tr!("who.sign_in") }</button>
            </form>
            <p class="hint">{ tr!("sign_in.forgotten") }</p>
        </section>
    }
}

fn why(refused: Option<&Refused>, wait: u64) -> Html {
    let words: AttrValue = match refused {
        None => return html! {},
        Some(Refused::For(words)) => words.clone().into(),
        Some(Refused::Until(_)) if wait > 0 => tr!("sign_in.wait", seconds = wait),
        Some(Refused::Until(_)) => {
            return html! { <p class="hint" role="status">{ tr!("sign_in.again") }</p> };
        }
    };
    html! { <p class="finding error" role="alert" data-test="refused">{ words }</p> }
}

async fn sign_in(form: SignIn) -> Result<(), Refused> {
    let body = rest::json(&form).map_err(|problem| Refused::For(words(&problem)))?;
    let reply = rest::request(Method::POST, "session", Some(body)).await;
    let reply = reply.map_err(|problem| Refused::For(words(&problem)))?;
    match (reply.status, reply.retry_after) {
        (200..300, _) => {
            // What is signed in is asked for anew by the page that comes next.
            session::lost();
            Ok(())
        }
        (_, Some(seconds)) => Err(Refused::Until(browser::now_ms() + f64::from(seconds) * 1_000.0)),
        (401, None) => Err(Refused::For(detail(&reply))),
        _ => Err(Refused::For(words(&reply.problem()))),
    }
}

/// What the relay says, without that one is signed out: that is why one is here.
fn detail(reply: &rest::Reply) -> String {
    let detail = reply.problem().detail;
    if detail.is_empty() { tr!("sign_in.wrong").to_string() } else { detail }
}

/// Whole seconds, at least 1 while there is something to wait for.
#[expect(clippy::cast_possible_truncation, clippy::cast_sign_loss, reason = "not negative, saturating")]
fn seconds_until(until_ms: f64) -> u64 {
    ((until_ms - browser::now_ms()).max(0.0) / 1_000.0).ceil() as u64
}
