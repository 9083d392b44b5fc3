//! REST under `/api/v1`, and the page under everything else. docs/REST.md describes the interface.

mod access;
mod allow;
mod assets;
mod audit;
mod blocks;
mod browse;
mod caller;
mod commands;
mod describe;
mod devices;
mod discovery;
mod extract;
mod groups;
mod guard;
mod health;
mod history;
mod metrics;
mod need;
mod observe;
mod project;
mod targets;
mod variables;
mod write;

use axum::Router;
use axum::extract::{DefaultBodyLimit, State};
use axum::http::{HeaderName, HeaderValue, Method, Uri, header};
use axum::middleware;
use axum::response::Response;
use axum::routing::get;
use utoipa::OpenApi;
use utoipa_axum::router::OpenApiRouter;
use utoipa_axum::routes;

use self::access::{passes, session, users, view};
use crate::app::App;
use crate::error::ApiError;
use crate::{live, ws};

pub(crate) use self::caller::Caller;
pub(crate) use self::guard::AllowedHosts;
#[cfg(test)]
pub(crate) use self::need::{NEEDS, Need};

/// Everything that the relay serves.
pub(crate) fn router(app: App) -> Router {
    Router::from(routes())
        .method_not_allowed_fallback(unknown)
        .route("/api", get(unknown))
        .route("/api/{*rest}", get(unknown))
        .fallback(assets::show)
        // Bodies are bounded where they are read.
        .layer(DefaultBodyLimit::disable())
        .layer(middleware::from_fn_with_state(app.clone(), need::check))
        .layer(middleware::from_fn_with_state(app.clone(), guard::check))
        .layer(middleware::map_response_with_state(app.clone(), secure))
        .layer(middleware::from_fn_with_state(app.clone(), observe::observe))
        .with_state(app)
}

/// All that is described: every route takes the description that stands at its handler.
fn routes() -> OpenApiRouter<App> {
    let api = OpenApiRouter::new()
        .routes(routes!(health::show))
        .routes(routes!(health::ready))
        .routes(routes!(describe::show))
        .routes(routes!(session::show, session::sign_in, session::sign_out))
        .routes(routes!(session::active))
        .routes(routes!(session::change_password))
        .routes(routes!(session::set_up))
        .routes(routes!(users::list, users::add))
        .routes(routes!(users::change, users::remove))
        .routes(routes!(users::sessions))
        .routes(routes!(users::end_session))
        .routes(routes!(passes::tokens, passes::make_token))
        .routes(routes!(passes::revoke_token))
        .routes(routes!(passes::links, passes::make_link))
        .routes(routes!(passes::revoke_link))
        .routes(routes!(ws::upgrade))
        .routes(routes!(commands::check))
        .routes(routes!(discovery::discover))
        .routes(routes!(audit::list))
        .routes(routes!(audit::state))
        .routes(routes!(audit::export))
        .routes(routes!(history::list))
        .routes(routes!(history::csv))
        .routes(routes!(history::trend))
        .routes(routes!(history::state))
        .routes(routes!(targets::list))
        .routes(routes!(write::show, write::open, write::close))
        .routes(routes!(write::read_only, write::set_read_only))
        .routes(routes!(allow::targets, allow::add_target))
        .routes(routes!(allow::remove_target))
        .routes(routes!(allow::writes, allow::add_write))
        .routes(routes!(allow::remove_write))
        .routes(routes!(project::export, project::import))
        .routes(routes!(project::folder, project::reread))
        .routes(routes!(live::upgrade))
        .routes(routes!(devices::list, devices::create))
        .routes(routes!(devices::show, devices::replace, devices::delete))
        .routes(routes!(devices::copy))
        .routes(routes!(devices::status))
        .routes(routes!(devices::writes))
        .routes(routes!(browse::show, browse::begin, browse::end))
        .routes(routes!(browse::structure))
        .routes(routes!(groups::create))
        .routes(routes!(groups::replace, groups::delete))
        .routes(routes!(groups::values))
        .routes(routes!(groups::variables, groups::add))
        .routes(routes!(groups::csv, groups::add_csv))
        .routes(routes!(variables::replace, variables::delete))
        .routes(routes!(variables::offer))
        .routes(routes!(variables::write))
        .routes(routes!(blocks::list, blocks::create))
        .routes(routes!(blocks::show, blocks::replace, blocks::delete))
        .routes(routes!(blocks::status))
        .routes(routes!(blocks::exchange))
        .routes(routes!(blocks::capture))
        .routes(routes!(commands::set_in))
        .routes(routes!(commands::run))
        .routes(routes!(write::offer))
        .routes(routes!(commands::cancel))
        .fallback(unknown);
    let described = describe::Relay::openapi();
    OpenApiRouter::with_openapi(described)
        .nest("/api/v1", api)
        .routes(routes!(view::open))
        .routes(routes!(metrics::show))
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
