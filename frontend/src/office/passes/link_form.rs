//! One more view link. It is shown this once, as a QR code, too.

use cipdeck_shared::api::{NewViewLink, ViewLinkCreated};
use yew::prelude::*;

use crate::office::{
    api, check,
    fetch::use_action,
    i18n::tr,
    kit::{CopyOnce, Entry, problem_note},
};

#[derive(Clone, PartialEq, Properties)]
pub(super) struct LinkFormProps {
    pub(super) on_made: Callback<()>,
}

/// Where the tablet hangs, and for how long.
#[component]
pub(super) fn LinkForm(props: &LinkFormProps) -> Html {
    let action = use_action();
    let (name, hours) = (use_state(String::new), use_state(|| "24".to_owned()));
    let (tried, made) = (use_state(|| false), use_state(|| None::<ViewLinkCreated>));
    let name_problem = check::needed(&name);
    let wanted_hours = check::number(&hours, 1, 8_784);
    let onsubmit = {
        let (action, on_made, tried, made) =
            (action.clone(), props.on_made.clone(), tried.clone(), made.clone());
        let (name, is_named, wanted_hours) = (name.clone(), name_problem.is_none(), wanted_hours.clone());
        move |event: SubmitEvent| {
            event.prevent_default();
            tried.set(true);
            made.set(None);
            let (Ok(hours), true) = (wanted_hours.clone(), is_named) else { return };
            let link = NewViewLink { name: name.trim().to_owned(), hours };
            let (on_made, tried, made, name) = (on_made.clone(), tried.clone(), made.clone(), name.clone());
            action.go(api::add_view_link(link), move |link| {
                made.set(Some(link));
                name.set(String::new());
                tried.set(false);
                on_made.emit(());
            });
        }
    };
    html! {
        <section class="panel narrow">
            <h2>{ tr!("view_links.make_title") }</h2>
            <form {onsubmit}>
                { Entry::text("link-name", tr!("view_links.name"), &name).hint(tr!("view_links.name_hint")).problem(name_problem.filter(|_| *tried)).draw() }
                { Entry::text("link-hours", tr!("view_links.hours"), &hours).problem(wanted_hours.err()).draw() }
                { problem_note(action.problem().as_ref()) }
                <button type="submit" class="button primary" disabled={action.is_busy()} data-test="make-link">{ tr!("view_links.make") }</button>
            </form>
            if let Some(made) = &*made {
                <div class="made" role="status">
                    <p><b>{ tr!("view_links.made", name = made.link.name) }</b></p>
                    <img class="qr" src={image(&made.qr_svg)} alt={tr!("view_links.qr")} data-test="qr" />
                    <CopyOnce label={tr!("view_links.address")} text={made.url.clone()} test="link-url" />
                </div>
            }
        </section>
    }
}

/// As an image, not as a part of the document: nothing in it can act.
fn image(svg: &str) -> String {
    format!("data:image/svg+xml,{}", String::from(js_sys::encode_uri_component(svg)))
}
