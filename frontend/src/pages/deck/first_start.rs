//! The first start: an address and a button, or the demo device. A decoded reply in at most two clicks.

use cipdeck_shared::config::{MsgCipGeneric, PathError, Target, TargetPath};
use yew::prelude::*;

use crate::{
    desk::{Consent, Runs},
    hooks::{use_link, use_workbench},
    i18n::{rule_text, tr},
    pages::connections::discover::Discover,
    route::{self, Route},
    workbench::{Place, Workbench},
};

/// The path of the demo device.
const DEMO: &str = "0,0";

/// One field, two buttons.
#[component]
pub fn FirstStart() -> Html {
    let bench = use_workbench();
    use_link();
    let typed = use_state(String::new);
    let oninput = use_callback(typed.clone(), |event: InputEvent, typed| {
        typed.set(event.target_unchecked_into::<web_sys::HtmlInputElement>().value());
    });
    let path = path_of(&typed);
    let problem = finding(&bench, &typed, &path);
    let can_send = problem.is_none() && !typed.trim().is_empty();
    let go = {
        let bench = bench.clone();
        Callback::from(move |path: String| {
            let id = bench.add(MsgCipGeneric::product_name(&path));
            bench.run(id, Consent::None);
            route::go(Route::Block(id));
        })
    };
    let onsubmit = use_callback((go.clone(), path, can_send), |event: SubmitEvent, (go, path, can_send)| {
        event.prevent_default();
        if *can_send {
            go.emit(path.clone());
        }
    });
    let on_demo = go.reform(|_: MouseEvent| DEMO.to_owned());
    html! {
        <section class="first">
            <h1>{ tr!("first.title") }</h1>
            <p class="lead">{ tr!("first.lead") }</p>
            <form class="first-form" {onsubmit}>
                <label for="first-address">{ tr!("first.address") }</label>
                <div class="first-line">
                    <input
                        id="first-address" name="address" class="input" placeholder="192.168.1.100"
                        autocomplete="off" spellcheck="false" autofocus=true data-test="first-address"
                        value={(*typed).clone()} {oninput}
                        aria-describedby={if problem.is_some() { "first-address-finding" } else { "first-address-hint" }}
                        aria-invalid={problem.is_some().then_some("true")}
                    />
                    <button type="submit" class="button primary" disabled={!can_send} data-test="first-send">{ tr!("first.send") }</button>
                </div>
                if let Some(problem) = problem {
                    <p id="first-address-finding" class="finding error" role="alert">{ problem }</p>
                } else {
                    <p id="first-address-hint" class="hint">{ tr!("first.hint") }</p>
                }
            </form>
            <div class="first-or"><span>{ tr!("first.or") }</span></div>
            <button type="button" class="button" onclick={on_demo} data-test="first-demo">{ tr!("first.demo") }</button>
            <p class="hint">{ tr!("first.demo_hint") }</p>
            <div class="first-or"><span>{ tr!("first.or") }</span></div>
            <Discover />
        </section>
    }
}

/// An address becomes a path through the Ethernet port; a whole path stays as it is.
fn path_of(typed: &str) -> String {
    let typed = typed.trim();
    if typed.contains(',') { typed.to_owned() } else { format!("4,{typed}") }
}

/// Why this address cannot be sent to. Nothing typed is no fault yet.
fn finding(bench: &Workbench, typed: &str, path: &str) -> Option<AttrValue> {
    if typed.trim().is_empty() {
        return None;
    }
    match path.parse::<TargetPath>() {
        Err(PathError::SerialPort) => Some(rule_text("path_serial_port", &[]).into()),
        Err(_) => Some(rule_text("path_bad_address", &[]).into()),
        Ok(path) => nowhere(bench, &path.target),
    }
}

fn nowhere(bench: &Workbench, target: &Target) -> Option<AttrValue> {
    (bench.place(Some(target)) == Place::Nowhere).then_some(tr!("first.needs_relay"))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn an_address_is_sent_through_the_ethernet_port() {
        for (typed, path) in [
            ("192.168.1.100", "4,192.168.1.100"),
            (" 127.0.0.1:44820 ", "4,127.0.0.1:44820"),
            ("4,192.168.1.100", "4,192.168.1.100"),
            ("0,0", "0,0"),
        ] {
            assert_eq!(path_of(typed), path);
        }
    }
}
