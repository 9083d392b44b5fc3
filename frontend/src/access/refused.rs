//! What is shown instead of a page to whom the relay shows nothing.

use yew::prelude::*;

use crate::{address, i18n::tr, net::Link};

/// Why, and where to go. Drafts are in the browser, and stay there.
pub fn refused(link: &Link) -> Html {
    let (title, text) = match link {
        Link::SetUp => (tr!("refused.set_up"), tr!("refused.set_up_text")),
        Link::Denied => (tr!("refused.denied"), tr!("refused.denied_text")),
        _ => (tr!("refused.signed_out"), tr!("refused.signed_out_text")),
    };
    let to = if *link == Link::SetUp {
        html! { <a class="button primary link" href="/office/set-up">{ tr!("refused.to_set_up") }</a> }
    } else {
        sign_in_link("button primary link")
    };
    html! {
        <div class="empty refused" role="alert" data-test="refused">
            <h1>{ title }</h1>
            <p>{ text }</p>
            <p>{ to }</p>
        </div>
    }
}

/// Leads to the page for signing in, and back here afterwards.
pub fn sign_in_link(class: &'static str) -> Html {
    let here = format!("{}{}", address::path(), address::query());
    let next = String::from(js_sys::encode_uri_component(&here));
    html! { <a {class} href={format!("/office/sign-in?next={next}")} data-test="sign-in-link">{ tr!("who.sign_in") }</a> }
}
