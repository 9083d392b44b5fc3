//! Who may call: only pages that this relay has served itself, and programs on this machine.
//!
//! A foreign web page in the user's browser can send requests here. `Host` is checked against DNS rebinding, `Origin`
//! against cross-site requests and foreign WebSockets. Programs send no `Origin`.

use std::net::{IpAddr, SocketAddr};

use axum::extract::{Request, State};
use axum::http::header;
use axum::middleware::Next;
use axum::response::{IntoResponse, Response};

use crate::app::App;
use crate::error::ApiError;

/// The names under which the relay may be called.
#[derive(Clone, Debug)]
pub(crate) struct AllowedHosts(Vec<String>);

impl AllowedHosts {
    /// The loopback names, and the address itself, with the port that the relay listens on.
    pub(crate) fn new(address: SocketAddr) -> Self {
        let own = match address.ip() {
            IpAddr::V4(ip) => ip.to_string(),
            IpAddr::V6(ip) => format!("[{ip}]"),
        };
        let names = ["127.0.0.1", "localhost", "[::1]", &own];
        let mut hosts: Vec<String> = names.iter().map(|name| format!("{name}:{}", address.port())).collect();
        if address.port() == 80 {
            // A browser leaves out the port that it would take anyway.
            hosts.extend(names.map(str::to_owned));
        }
        Self(hosts)
    }

    fn has_host(&self, host: &str) -> bool {
        self.0.iter().any(|allowed| allowed.eq_ignore_ascii_case(host))
    }

    fn has_origin(&self, origin: &str) -> bool {
        origin.strip_prefix("http://").is_some_and(|host| self.has_host(host))
    }
}

/// Runs before everything else.
pub(crate) async fn check(State(app): State<App>, request: Request, next: Next) -> Response {
    match permitted(&app.hosts, &request) {
        Ok(()) => next.run(request).await,
        Err(error) => {
            // The address of a view link is a secret.
            let path = request.uri().path();
            let path = if path.starts_with("/view/") { "/view/…" } else { path };
            tracing::warn!(url.path = path, %error, "refused a request from elsewhere");
            error.into_response()
        }
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
        let hosts = AllowedHosts::new("127.0.0.1:8818".parse().unwrap());
        let mut request = Request::builder();
        for (name, value) in headers {
            request = request.header(*name, *value);
        }
        permitted(&hosts, &request.body(Body::empty()).unwrap()).is_ok()
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
}
