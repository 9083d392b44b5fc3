//! What each entry point asks of its caller, in one table. What is not in the table is refused.
//!
//! This decides who may ask at all; whether a message may be sent is decided by [`crate::permit`] again.

use std::net::{IpAddr, Ipv4Addr, SocketAddr};

use axum::body::HttpBody;
use axum::extract::{ConnectInfo, MatchedPath, Request, State};
use axum::http::{Method, header};
use axum::middleware::Next;
use axum::response::{IntoResponse, Response};
use cipdeck_shared::api::{ActorKind, Role};
use subtle::ConstantTimeEq;

use crate::access::{CSRF_HEADER, Known};
use crate::app::App;
use crate::error::ApiError;

/// What an entry point asks of its caller.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Need {
    /// Nothing.
    Anyone,
    /// Whoever is known.
    Look,
    /// A person: no token, no view link.
    Person,
    /// Sends messages.
    Send,
    /// Changes blocks and devices.
    Edit,
    /// Opens the write window: a person.
    Window,
    /// Stops all writing: a person.
    Stop,
    /// Reads the audit.
    Trail,
    /// Keeps users, tokens and lists: a person.
    Manage,
}

use Need::{Anyone, Edit, Look, Manage, Person, Send, Stop, Trail, Window};

/// Method, route, need.
pub(crate) const NEEDS: &[(&str, &str, Need)] = &[
    ("GET", "/view/{secret}", Anyone),
    ("GET", "/api", Anyone),
    ("GET", "/api/{*rest}", Anyone),
    ("GET", "/metrics", Look),
    ("GET", "/api/v1/health", Anyone),
    ("GET", "/api/v1/ready", Anyone),
    ("GET", "/api/v1/openapi.json", Look),
    ("GET", "/api/v1/session", Anyone),
    ("POST", "/api/v1/session", Anyone),
    ("DELETE", "/api/v1/session", Anyone),
    ("POST", "/api/v1/session/active", Look),
    ("POST", "/api/v1/session/password", Person),
    ("POST", "/api/v1/setup", Anyone),
    ("GET", "/api/v1/users", Manage),
    ("POST", "/api/v1/users", Manage),
    ("PATCH", "/api/v1/users/{name}", Manage),
    ("DELETE", "/api/v1/users/{name}", Manage),
    ("GET", "/api/v1/sessions", Manage),
    ("DELETE", "/api/v1/sessions/{id}", Manage),
    ("GET", "/api/v1/tokens", Manage),
    ("POST", "/api/v1/tokens", Manage),
    ("DELETE", "/api/v1/tokens/{id}", Manage),
    ("GET", "/api/v1/view-links", Manage),
    ("POST", "/api/v1/view-links", Manage),
    ("DELETE", "/api/v1/view-links/{id}", Manage),
    ("GET", "/api/v1/ws", Look),
    ("POST", "/api/v1/check", Look),
    ("POST", "/api/v1/discover", Send),
    ("GET", "/api/v1/targets", Look),
    ("GET", "/api/v1/window", Look),
    ("POST", "/api/v1/window", Window),
    ("DELETE", "/api/v1/window", Person),
    ("GET", "/api/v1/read-only", Look),
    ("PUT", "/api/v1/read-only", Stop),
    ("GET", "/api/v1/allow/targets", Look),
    ("POST", "/api/v1/allow/targets", Manage),
    ("DELETE", "/api/v1/allow/targets/{id}", Manage),
    ("GET", "/api/v1/allow/writes", Look),
    ("POST", "/api/v1/allow/writes", Manage),
    ("DELETE", "/api/v1/allow/writes/{id}", Manage),
    ("GET", "/api/v1/audit", Trail),
    ("GET", "/api/v1/audit/state", Trail),
    ("GET", "/api/v1/audit.jsonl", Trail),
    ("GET", "/api/v1/history", Look),
    ("GET", "/api/v1/history.csv", Look),
    ("GET", "/api/v1/history/trend", Look),
    ("GET", "/api/v1/history/state", Look),
    ("GET", "/api/v1/live", Look),
    ("GET", "/api/v1/project", Look),
    ("POST", "/api/v1/project", Edit),
    ("GET", "/api/v1/project/folder", Look),
    ("POST", "/api/v1/project/folder", Edit),
    ("GET", "/api/v1/devices", Look),
    ("POST", "/api/v1/devices", Edit),
    ("GET", "/api/v1/devices/{id}", Look),
    ("PUT", "/api/v1/devices/{id}", Edit),
    ("DELETE", "/api/v1/devices/{id}", Edit),
    ("POST", "/api/v1/devices/{id}/copy", Edit),
    ("GET", "/api/v1/devices/{id}/status", Look),
    ("GET", "/api/v1/devices/{id}/writes", Look),
    ("GET", "/api/v1/devices/{id}/browse", Look),
    ("POST", "/api/v1/devices/{id}/browse", Send),
    ("DELETE", "/api/v1/devices/{id}/browse", Send),
    ("GET", "/api/v1/devices/{id}/browse/type", Send),
    ("POST", "/api/v1/groups", Edit),
    ("PUT", "/api/v1/groups/{id}", Edit),
    ("DELETE", "/api/v1/groups/{id}", Edit),
    ("GET", "/api/v1/groups/{id}/values", Look),
    ("GET", "/api/v1/groups/{id}/variables", Look),
    ("POST", "/api/v1/groups/{id}/variables", Edit),
    ("GET", "/api/v1/groups/{id}/variables.csv", Look),
    ("POST", "/api/v1/groups/{id}/variables.csv", Edit),
    ("PUT", "/api/v1/variables/{id}", Edit),
    ("DELETE", "/api/v1/variables/{id}", Edit),
    ("POST", "/api/v1/variables/{id}/offer", Send),
    ("POST", "/api/v1/variables/{id}/write", Send),
    ("GET", "/api/v1/blocks", Look),
    ("POST", "/api/v1/blocks", Edit),
    ("GET", "/api/v1/blocks/{id}", Look),
    ("PUT", "/api/v1/blocks/{id}", Edit),
    ("DELETE", "/api/v1/blocks/{id}", Edit),
    ("GET", "/api/v1/blocks/{id}/status", Look),
    ("GET", "/api/v1/blocks/{id}/exchange", Look),
    ("GET", "/api/v1/blocks/{id}/exchange.pcapng", Look),
    ("POST", "/api/v1/blocks/{id}/in", Send),
    ("POST", "/api/v1/blocks/{id}/run", Send),
    ("POST", "/api/v1/blocks/{id}/write", Send),
    ("POST", "/api/v1/blocks/{id}/cancel", Send),
];

impl Need {
    /// The word in the description of the interface.
    pub(super) const fn word(self) -> &'static str {
        match self {
            Anyone => "anyone",
            Look => "look",
            Person => "person",
            Send => "send",
            Edit => "edit",
            Window => "window",
            Stop => "stop",
            Trail => "trail",
            Manage => "manage",
        }
    }

    /// What this entry point asks; `None` for one that is not in the table.
    pub(crate) fn of(method: &str, route: &str) -> Option<Self> {
        // A HEAD is a GET without its body.
        let method = if method == "HEAD" { "GET" } else { method };
        NEEDS.iter().find(|(of, at, _)| *of == method && *at == route).map(|(.., need)| *need)
    }

    /// Whether somebody of this kind with this role may, or why not.
    pub(crate) fn check(self, kind: ActorKind, role: Role) -> Result<(), &'static str> {
        let is_person = matches!(kind, ActorKind::Person | ActorKind::Local);
        let (may, why) = match self {
            Anyone | Look => (true, ""),
            Person => (is_person, "this takes a person who has signed in, not a token or a view link"),
            Send => {
                (role.may_send(), "a viewer looks and sends nothing: ask an administrator for another role")
            }
            Edit => (
                role.may_edit(),
                "blocks and devices are changed by engineers: ask an administrator for the role",
            ),
            Window => (
                role.may_write() && is_person,
                "a write window is opened by an operator or an engineer who has signed in",
            ),
            Stop => (
                role.may_send() && is_person,
                "writing is stopped by an operator, an engineer or an administrator who has signed in",
            ),
            Trail => (role.may_audit(), "the audit is read by engineers and administrators"),
            Manage => (role.may_manage() && is_person, "this is done by an administrator who has signed in"),
        };
        if may { Ok(()) } else { Err(why) }
    }
}

/// Finds out who calls, and refuses whom the entry point is not for.
pub(super) async fn check(State(app): State<App>, mut request: Request, next: Next) -> Response {
    let Some(route) = request.extensions().get::<MatchedPath>().cloned() else {
        // Files of the page, which need nothing, and addresses that nothing is at.
        return next.run(request).await;
    };
    let (need, known) = match known(&app, &request, route.as_str()) {
        Ok(known) => known,
        Err(error) => return error.into_response(),
    };
    let permitted = permitted(&app, &request, need, known.as_ref());
    let actor = known.as_ref().map(|known| known.actor.clone());
    if let Some(known) = known {
        request.extensions_mut().insert(known.actor.clone());
        request.extensions_mut().insert(known);
    }
    let mut response = match permitted {
        Ok(()) => next.run(request).await,
        Err(error) => error.into_response(),
    };
    // For the log.
    if let Some(actor) = actor {
        response.extensions_mut().insert(actor);
    }
    response
}

/// What this entry point asks, and who calls.
fn known(app: &App, request: &Request, route: &str) -> Result<(Need, Option<Known>), ApiError> {
    let (method, path) = (request.method(), request.uri().path());
    let need = Need::of(method.as_str(), route)
        .ok_or_else(|| ApiError::NotFound(format!("nothing takes {method} at {path}")))?;
    Ok((need, app.access.known(request.headers(), peer(request))?))
}

fn permitted(app: &App, request: &Request, need: Need, known: Option<&Known>) -> Result<(), ApiError> {
    if need != Anyone {
        let actor = known.map(|known| &known.actor).ok_or_else(|| signed_out(app))?;
        let role = actor.role().ok_or_else(|| signed_out(app))?;
        need.check(actor.kind(), role).map_err(|why| ApiError::NotPermitted(why.to_owned()))?;
    }
    if !matches!(*request.method(), Method::GET | Method::HEAD) {
        from_our_page(request, known, body_type(request))?;
        if let Some(known) = known {
            known.actor.touch();
        }
    }
    Ok(())
}

/// Where the request comes from.
pub(super) fn peer(request: &Request) -> IpAddr {
    let peer = request.extensions().get::<ConnectInfo<SocketAddr>>();
    // Not known means: not this machine.
    peer.map_or(IpAddr::V4(Ipv4Addr::UNSPECIFIED), |peer| peer.ip())
}

/// What the body of a request has to be.
fn body_type(request: &Request) -> (&'static str, &'static str) {
    let route = request.extensions().get::<MatchedPath>().map(MatchedPath::as_str);
    if route == Some(super::project::ROUTE) {
        ("a zip archive", "application/zip")
    } else {
        ("JSON", "application/json")
    }
}

/// A foreign page can make a browser send its cookies, and forms. It cannot read our token, and no form is JSON or an
/// archive. `Origin` has been checked already.
fn from_our_page(
    request: &Request,
    known: Option<&Known>,
    (what, body_type): (&str, &str),
) -> Result<(), ApiError> {
    let headers = request.headers();
    if known.is_some_and(|known| known.actor.kind() == ActorKind::Token) {
        return Ok(());
    }
    if let Some(csrf) = known.and_then(|known| known.csrf.as_ref()) {
        let given = headers.get(CSRF_HEADER).map_or(&[][..], axum::http::HeaderValue::as_bytes);
        if !bool::from(given.ct_eq(csrf.as_bytes())) {
            return Err(ApiError::NotPermitted(
                "X-CSRF-Token is not that of the session: load the page again; GET /api/v1/session tells it"
                    .to_owned(),
            ));
        }
    }
    let content_type = headers.get(header::CONTENT_TYPE).and_then(|value| value.to_str().ok());
    let essence = content_type.and_then(|text| text.split(';').next()).unwrap_or_default().trim();
    if !request.body().is_end_stream() && !essence.eq_ignore_ascii_case(body_type) {
        return Err(ApiError::Unreadable(format!(
            "the body has to be {what}: send Content-Type: {body_type}"
        )));
    }
    Ok(())
}

fn signed_out(app: &App) -> ApiError {
    ApiError::SignedOut(if *app.access.is_set_up().borrow() {
        "sign in first".to_owned()
    } else {
        "there is no administrator yet: open the page on the relay's machine and give the set-up code that the relay \
         has printed"
            .to_owned()
    })
}

#[cfg(test)]
mod tests {
    use super::*;

    /// What the router serves, and so describes.
    fn routes() -> Vec<(String, String)> {
        let document = super::super::describe::document();
        let paths = document["paths"].as_object().unwrap();
        let methods = |(path, methods): (&String, &serde_json::Value)| {
            let methods = methods.as_object().unwrap().keys();
            methods.map(|method| (method.to_uppercase(), path.clone())).collect::<Vec<_>>()
        };
        paths.iter().flat_map(methods).collect()
    }

    #[test]
    fn the_table_and_the_router_have_the_same_entries() {
        let routes = routes();
        assert!(routes.len() > 40, "{routes:?}");
        for (method, route) in &routes {
            assert!(Need::of(method, route).is_some(), "{method} {route} is not in the table");
        }
        // These two answer that nothing is there.
        let described = NEEDS.iter().filter(|(_, route, _)| !matches!(*route, "/api" | "/api/{*rest}"));
        for (method, route, _) in described {
            let is_there = routes.iter().any(|(of, at)| of == method && at == route);
            assert!(is_there, "{method} {route} is in the table, and nowhere else");
        }
    }

    #[test]
    fn what_is_not_in_the_table_is_asked_for_nothing_and_refused() {
        for (method, route) in [("PUT", "/api/v1/health"), ("GET", "/api/v1/nothing"), ("", "")] {
            assert_eq!(Need::of(method, route), None);
        }
        assert_eq!(Need::of("HEAD", "/api/v1/audit"), Some(Trail));
    }

    #[test]
    fn roles_may_what_the_design_says() {
        use ActorKind::{Local, Person as Signed, Token, ViewLink};
        use Role::{Admin, Engineer, Operator};
        let may = |need: Need, kind, roles: &[Role]| {
            for role in Role::ALL {
                let expected = roles.contains(&role);
                assert_eq!(need.check(kind, role).is_ok(), expected, "{need:?} {kind:?} {role:?}");
            }
        };
        for kind in [Signed, Local] {
            may(Person, kind, &Role::ALL);
            may(Window, kind, &[Operator, Engineer]);
            may(Stop, kind, &[Operator, Engineer, Admin]);
            may(Manage, kind, &[Admin]);
        }
        for kind in [Token, ViewLink] {
            may(Person, kind, &[]);
            may(Window, kind, &[]);
            may(Stop, kind, &[]);
            may(Manage, kind, &[]);
        }
        for kind in [Signed, Local, Token, ViewLink] {
            may(Look, kind, &Role::ALL);
            may(Send, kind, &[Operator, Engineer, Admin]);
            may(Edit, kind, &[Engineer]);
            may(Trail, kind, &[Engineer, Admin]);
        }
    }
}
