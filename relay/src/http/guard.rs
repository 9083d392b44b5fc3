//! Who may call: only pages that this relay has served itself, and programs that know its name.
//!
//! A foreign web page in the user's browser can send requests here. `Host` is checked against DNS rebinding, `Origin`
//! against cross-site requests and foreign WebSockets. Programs send no `Origin`.

use std::net::SocketAddr;

use axum::extract::{Request, State};
use axum::http::header;
use axum::middleware::Next;
use axum::response::{IntoResponse, Response};

use crate::app::App;
use crate::error::ApiError;
use crate::listen::{in_url, own_names};
use crate::settings::HostName;

/// The names under which the relay may be called; none by default.
#[derive(Clone, Debug, Default)]
pub(crate) struct AllowedHosts {
    /// This machine's, with the port that the relay listens on.
    own: Vec<String>,
    /// Those that were configured, for tunnels and containers.
    more: Vec<String>,
    /// Pages that the relay has served itself came by HTTPS.
    is_tls: bool,
}

impl AllowedHosts {
    /// For who calls this address, or one of the names in `more`.
    pub(crate) fn new(address: SocketAddr, is_tls: bool, more: &[HostName]) -> Self {
        let names: Vec<String> = own_names(address.ip()).iter().map(|name| in_url(name)).collect();
        let mut own: Vec<String> = names.iter().map(|name| format!("{name}:{}", address.port())).collect();
        if address.port() == if is_tls { 443 } else { 80 } {
            // A browser leaves out the port that it would take anyway.
            own.extend(names);
        }
        Self { own, more: more.iter().flat_map(|name| name.hosts(address.port())).collect(), is_tls }
    }

    fn has_host(&self, host: &str) -> bool {
        is_in(&self.own, host) || is_in(&self.more, host)
    }

    fn has_origin(&self, origin: &str) -> bool {
        match origin.split_once("://") {
            Some(("https", host)) => self.is_tls && is_in(&self.own, host) || is_in(&self.more, host),
            Some(("http", host)) => !self.is_tls && self.has_host(host),
            _ => false,
        }
    }
}

fn is_in(hosts: &[String], host: &str) -> bool {
    hosts.iter().any(|allowed| allowed.eq_ignore_ascii_case(host))
}

/// Runs before everything that has an effect.
pub(crate) async fn check(State(app): State<App>, request: Request, next: Next) -> Response {
    match permitted(&app.hosts, &request) {
        Ok(()) => next.run(request).await,
        Err(error) => error.into_response(),
    }
}

fn permitted(hosts: &AllowedHosts, request: &Request) -> Result<(), ApiError> {
    let foreign =
        |what: &str| Err(ApiError::NotPermitted(format!("the relay does not answer to this {what}")));
    let mut given = request.headers().get_all(header::HOST).iter();
    let host = given.next().and_then(|host| host.to_str().ok());
    if !host.is_some_and(|host| hosts.has_host(host)) || given.next().is_some() {
        return foreign("Host");
    }
    for origin in request.headers().get_all(header::ORIGIN) {
        if !origin.to_str().is_ok_and(|origin| hosts.has_origin(origin)) {
            return foreign("Origin");
        }
    }
    Ok(())
}

#[cfg(test)]
mod tests {
    use axum::body::Body;

    use super::*;

    fn verdict(headers: &[(&str, &str)]) -> bool {
        verdict_of(&AllowedHosts::new("127.0.0.1:8818".parse().unwrap(), false, &[]), headers)
    }

    fn verdict_of(hosts: &AllowedHosts, headers: &[(&str, &str)]) -> bool {
        let mut request = Request::builder();
        for (name, value) in headers {
            request = request.header(*name, *value);
        }
        permitted(hosts, &request.body(Body::empty()).unwrap()).is_ok()
    }

    #[test]
    fn programs_and_our_own_page_may_call() {
        for host in ["127.0.0.1:8818", "localhost:8818", "LOCALHOST:8818", "[::1]:8818"] {
            assert!(verdict(&[("host", host)]), "{host}");
            assert!(verdict(&[("host", host), ("origin", "http://localhost:8818")]), "{host}");
        }
    }

    #[test]
    fn nobody_else_may() {
        for headers in [
            &[][..],
            &[("host", "evil.example")],
            &[("host", "evil.example:8818")],
            &[("host", "127.0.0.1")],
            &[("host", "127.0.0.1:8819")],
            &[("host", "127.0.0.1:8818"), ("host", "127.0.0.1:8818")],
            &[("host", "127.0.0.1:8818"), ("origin", "http://evil.example")],
            &[("host", "127.0.0.1:8818"), ("origin", "https://127.0.0.1:8818")],
            &[("host", "127.0.0.1:8818"), ("origin", "null")],
            &[
                ("host", "127.0.0.1:8818"),
                ("origin", "http://localhost:8818"),
                ("origin", "http://evil.example"),
            ],
        ] {
            assert!(!verdict(headers), "{headers:?}");
        }
    }

    #[test]
    fn behind_tls_only_https_pages_of_this_machine_may_call() {
        let hosts = AllowedHosts::new("192.0.2.17:8818".parse().unwrap(), true, &[]);
        let own = ("host", "192.0.2.17:8818");
        assert!(verdict_of(&hosts, &[own, ("origin", "https://192.0.2.17:8818")]));
        assert!(!verdict_of(&hosts, &[own, ("origin", "http://192.0.2.17:8818")]));
        assert!(!verdict_of(&hosts, &[("host", "192.0.2.18:8818")]));
        let hosts = AllowedHosts::new("192.0.2.17:443".parse().unwrap(), true, &[]);
        assert!(verdict_of(&hosts, &[("host", "192.0.2.17"), ("origin", "https://192.0.2.17")]));
    }

    #[test]
    fn a_tunnel_may_bring_its_name_and_its_own_tls() {
        let more = ["deck.example.net".parse().unwrap(), "gateway:9000".parse().unwrap()];
        let hosts = AllowedHosts::new("127.0.0.1:8818".parse().unwrap(), false, &more);
        for host in ["deck.example.net", "deck.example.net:8818", "gateway:9000"] {
            for scheme in ["http", "https"] {
                assert!(
                    verdict_of(&hosts, &[("host", host), ("origin", &format!("{scheme}://{host}"))]),
                    "{host}"
                );
            }
        }
        for host in ["gateway", "gateway:8818", "deck.example.net:9000", "deck.example.net.evil.example"] {
            assert!(!verdict_of(&hosts, &[("host", host)]), "{host}");
        }
        assert!(!verdict_of(&hosts, &[("host", "gateway:9000"), ("origin", "https://127.0.0.1:8818")]));
    }
}
