//! From a request to who has sent it.

use std::net::IpAddr;

use axum::http::{HeaderMap, header};
use cipdeck_shared::api::ActorKind;
use cookie::{Cookie, SameSite};

use super::{Access, secret};
use crate::actor::Actor;
use crate::error::ApiError;
use crate::runner::lock;

/// The header that a page has to send beside its cookie.
pub(crate) const CSRF_HEADER: &str = "x-csrf-token";

/// The cookie of a person's session. Browsers take a `__Host-` cookie over TLS, and from loopback, and never from or
/// for another host.
pub(crate) const SESSION: &str = "__Host-cipdeck";

/// The cookie of a view link. One of its own, so that opening a link signs nobody out.
pub(crate) const VIEW: &str = "__Host-cipdeck-view";

/// What tunnels and proxies add to what they pass on.
const PASSED_ON: [&str; 5] = ["forwarded", "via", "x-forwarded-for", "x-forwarded-host", "x-real-ip"];

/// Somebody who is known.
#[derive(Clone, Debug)]
pub(crate) struct Known {
    /// Who.
    pub(crate) actor: Actor,
    /// What a page has to send beside its cookie; none for programs and local access.
    pub(crate) csrf: Option<String>,
}

impl Access {
    /// Who has sent these headers. A token that is not good is an error; without anything good nobody is known.
    pub(crate) fn known(&self, headers: &HeaderMap, peer: IpAddr) -> Result<Option<Known>, ApiError> {
        let peer = peer.to_canonical();
        if let Some(value) = headers.get(header::AUTHORIZATION) {
            let text = value.to_str().unwrap_or_default();
            let Some(token) =
                text.split_once(' ').filter(|(scheme, _)| scheme.eq_ignore_ascii_case("bearer"))
            else {
                return Err(ApiError::SignedOut(
                    "the relay takes Authorization: Bearer TOKEN only".to_owned(),
                ));
            };
            return self.with_token(token.1.trim(), peer).map(|actor| Some(Known { actor, csrf: None }));
        }
        let known = |secret: &str, actor: Actor| Known { actor, csrf: Some(secret::csrf(secret)) };
        if let Some(secret) = cookie(headers, SESSION)
            && let Some(session) = lock(&self.0.sessions).get(&secret::digest(&secret))
        {
            return Ok(Some(known(&secret, session.actor(peer))));
        }
        if let Some(secret) = cookie(headers, VIEW)
            && let Some(actor) = self.with_link(&secret, peer)
        {
            return Ok(Some(known(&secret, actor)));
        }
        let local = self.0.local.filter(|_| peer.is_loopback() && is_direct(headers));
        Ok(local.map(|role| Known { actor: Actor::local(role, peer.to_string()), csrf: None }))
    }
}

/// Whether nobody passes on what somebody else has sent: a tunnel or a proxy on this machine calls from loopback, too.
fn is_direct(headers: &HeaderMap) -> bool {
    let host = headers.get(header::HOST).and_then(|host| host.to_str().ok()).unwrap_or_default();
    let name = match host.rsplit_once(':') {
        Some((name, port)) if port.bytes().all(|byte| byte.is_ascii_digit()) => name,
        _ => host,
    };
    let name = name.trim_matches(['[', ']']);
    let is_here =
        name.eq_ignore_ascii_case("localhost") || name.parse().is_ok_and(|ip: IpAddr| ip.is_loopback());
    is_here && !PASSED_ON.iter().any(|name| headers.contains_key(*name))
}

/// The cookie of a new session, as a header. The browser forgets it with its window, the relay at the latest after 12 h.
pub(crate) fn session_cookie(secret: &str) -> String {
    sealed(SESSION, secret).to_string()
}

/// The cookie of an opened view link, as a header.
pub(crate) fn view_cookie(secret: &str, lasts: std::time::Duration) -> String {
    let seconds = i64::try_from(lasts.as_secs()).unwrap_or(i64::MAX);
    let mut cookie = sealed(VIEW, secret);
    cookie.set_max_age(cookie::time::Duration::seconds(seconds));
    cookie.to_string()
}

/// The header that makes the browser forget what somebody of this kind came with. A tablet on which a person signs out
/// shows its view again.
pub(crate) fn no_cookie(kind: ActorKind) -> String {
    let mut cookie = sealed(if kind == ActorKind::ViewLink { VIEW } else { SESSION }, "");
    cookie.set_max_age(cookie::time::Duration::ZERO);
    cookie.to_string()
}

fn sealed<'a>(name: &'a str, secret: &'a str) -> Cookie<'a> {
    Cookie::build((name, secret)).path("/").secure(true).http_only(true).same_site(SameSite::Strict).build()
}

fn cookie(headers: &HeaderMap, name: &str) -> Option<String> {
    let texts = headers.get_all(header::COOKIE).iter().filter_map(|value| value.to_str().ok());
    let mut cookies = texts.flat_map(Cookie::split_parse).filter_map(Result::ok);
    cookies.find(|cookie| cookie.name() == name).map(|cookie| cookie.value().to_owned())
}
