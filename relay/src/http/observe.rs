//! Every request is counted, and every refused one is one record of the log: who, from where, what, why.

use axum::extract::{MatchedPath, Request, State};
use axum::http::{Method, StatusCode};
use axum::middleware::Next;
use axum::response::Response;

use super::need::peer;
use crate::actor::Actor;
use crate::app::App;
use crate::error::Refusal;

/// Where what is not in the table of routes is counted: files of the page, and addresses that nothing is at.
const PAGE: &str = "page";

/// Runs around everything else.
pub(super) async fn observe(State(app): State<App>, request: Request, next: Next) -> Response {
    let route = request.extensions().get::<MatchedPath>().cloned();
    let (method, peer) = (request.method().clone(), peer(&request));
    let response = next.run(request).await;
    let status = response.status();
    // The template, never the address: that of a view link is a secret.
    let route = route.as_ref().map_or(PAGE, MatchedPath::as_str);
    app.policy.metrics.request(word(&method), route, status.as_u16());
    if let Some(Refusal { code, why }) = response.extensions().get() {
        let user = response.extensions().get::<Actor>().map_or("", Actor::name);
        // The level of a record is fixed where it is written.
        macro_rules! log {
            ($level:ident, $message:literal) => {
                tracing::$level!(
                    client.address = %peer, user.name = user, http.method = word(&method), http.route = route,
                    status = status.as_u16(), code = code.word(), why, $message
                )
            };
        }
        match status {
            status if status.is_server_error() => log!(error, "a request failed"),
            StatusCode::UNAUTHORIZED | StatusCode::FORBIDDEN | StatusCode::TOO_MANY_REQUESTS => {
                log!(warn, "refused");
            }
            _ => log!(info, "refused"),
        }
    }
    response
}

/// One of few words: a client may send any.
fn word(method: &Method) -> &'static str {
    match *method {
        Method::GET => "GET",
        Method::HEAD => "HEAD",
        Method::POST => "POST",
        Method::PUT => "PUT",
        Method::PATCH => "PATCH",
        Method::DELETE => "DELETE",
        _ => "other",
    }
}
