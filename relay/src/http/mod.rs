//! REST under `/api/v1`, and the page under everything else. docs/REST.md describes the interface.

mod access;
mod allow;
mod assets;
mod audit;
mod blocks;
mod caller;
mod commands;
mod discovery;
mod extract;
mod guard;
mod health;
mod history;
mod need;
mod targets;
mod write;

use axum::Router;
use axum::extract::{DefaultBodyLimit, State};
use axum::http::{HeaderName, HeaderValue, Method, Uri, header};
use axum::middleware;
use axum::response::Response;
use axum::routing::{delete, get, patch, post};

use crate::app::App;
use crate::error::ApiError;
use crate::ws;

pub(crate) use self::caller::Caller;
pub(crate) use self::guard::AllowedHosts;
#[cfg(test)]
pub(crate) use self::need::{NEEDS, Need};

/// Everything that the relay serves.
pub(crate) fn router(app: App) -> Router {
    let api = Router::new()
        .route("/health", get(health::show))
        .route("/session", get(access::show).post(access::sign_in).delete(access::sign_out))
        .route("/session/active", post(access::active))
        .route("/session/password", post(access::change_password))
        .route("/setup", post(access::set_up))
        .route("/users", get(access::list).post(access::add))
        .route("/users/{name}", patch(access::change).delete(access::remove))
        .route("/sessions", get(access::sessions))
        .route("/sessions/{id}", delete(access::end_session))
        .route("/tokens", get(access::tokens).post(access::make_token))
        .route("/tokens/{id}", delete(access::revoke_token))
        .route("/view-links", get(access::links).post(access::make_link))
        .route("/view-links/{id}", delete(access::revoke_link))
        .route("/ws", get(ws::upgrade))
        .route("/check", post(commands::check))
        .route("/discover", post(discovery::discover))
        .route("/audit", get(audit::list))
        .route("/audit/state", get(audit::state))
        .route("/audit.jsonl", get(audit::export))
        .route("/history", get(history::list))
        .route("/history.csv", get(history::csv))
        .route("/history/trend", get(history::trend))
        .route("/history/state", get(history::state))
        .route("/targets", get(targets::list))
        .route("/window", get(write::show).post(write::open).delete(write::close))
        .route("/read-only", get(write::read_only).put(write::set_read_only))
        .route("/allow/targets", get(allow::targets).post(allow::add_target))
        .route("/allow/targets/{id}", delete(allow::remove_target))
        .route("/allow/writes", get(allow::writes).post(allow::add_write))
        .route("/allow/writes/{id}", delete(allow::remove_write))
        .route("/blocks", get(blocks::list).post(blocks::create))
        .route("/blocks/{id}", get(blocks::show).put(blocks::replace).delete(blocks::delete))
        .route("/blocks/{id}/status", get(blocks::status))
        .route("/blocks/{id}/exchange", get(blocks::exchange))
        .route("/blocks/{id}/exchange.pcapng", get(blocks::capture))
        .route("/blocks/{id}/in", post(commands::set_in))
        .route("/blocks/{id}/run", post(commands::run))
        .route("/blocks/{id}/write", post(write::offer))
        .route("/blocks/{id}/cancel", post(commands::cancel))
        .fallback(unknown)
        .method_not_allowed_fallback(unknown);
    Router::new()
        .nest("/api/v1", api)
        .route("/view/{secret}", get(access::open))
        .route("/api", get(unknown))
        .route("/api/{*rest}", get(unknown))
        .fallback(assets::show)
        // Bodies are bounded where they are read.
        .layer(DefaultBodyLimit::disable())
        .layer(middleware::from_fn_with_state(app.clone(), need::check))
        .layer(middleware::from_fn_with_state(app.clone(), guard::check))
        .layer(middleware::map_response_with_state(app.clone(), secure))
        .with_state(app)
}

async fn unknown(method: Method, uri: Uri) -> ApiError {
    ApiError::NotFound(format!("nothing takes {method} at {}", uri.path()))
}

/// Nothing is loaded from elsewhere, nothing frames the page, no address leaks.
const SECURITY_HEADERS: [(HeaderName, &str); 5] = [
    (
        header::CONTENT_SECURITY_POLICY,
        "default-src 'none'; script-src 'self' 'wasm-unsafe-eval'; style-src 'self'; connect-src 'self'; \
         img-src 'self' data:; font-src 'self'; base-uri 'none'; form-action 'none'; frame-ancestors 'none'",
    ),
    (header::X_CONTENT_TYPE_OPTIONS, "nosniff"),
    (header::REFERRER_POLICY, "no-referrer"),
    (HeaderName::from_static("cross-origin-opener-policy"), "same-origin"),
    (HeaderName::from_static("cross-origin-resource-policy"), "same-origin"),
];

async fn secure(State(app): State<App>, mut response: Response) -> Response {
    if app.hsts {
        let year = HeaderValue::from_static("max-age=31536000");
        response.headers_mut().insert(header::STRICT_TRANSPORT_SECURITY, year);
    }
    for (name, value) in SECURITY_HEADERS {
        response.headers_mut().insert(name, HeaderValue::from_static(value));
    }
    if response.headers().get(header::CACHE_CONTROL).is_none() {
        response.headers_mut().insert(header::CACHE_CONTROL, HeaderValue::from_static("no-store"));
    }
    response
}
