//! `/view/{secret}`: a view link is opened.

use axum::Extension;
use axum::extract::State;
use axum::http::{HeaderMap, StatusCode, header};
use axum::response::{Html, IntoResponse, Response};
use cipdeck_shared::api::{ActorKind, Problem};
use qrcode::QrCode;
use qrcode::render::svg;

use super::super::extract::{Name, Peer};
use crate::access::view_cookie;
use crate::actor::Actor;
use crate::app::App;
use crate::error::ApiError;

/// Where a view link leads.
const MONITOR: &str = "/monitor";

/// Opens a view link; for people.
#[utoipa::path(
    get,
    path = "/view/{secret}",
    tag = "access",
    params(("secret" = String, Path, description = "As the link has it")),
    responses(
        (status = 303, description = "On to the Monitor, read only", headers(("set-cookie" = String, description = "The link"))),
        (status = 401, description = "The link does not open", body = String, content_type = "text/html"),
        (status = 404, description = "The link cannot be read"),
        (status = 429, description = "Too many wrong links from there", body = String, content_type = "text/html")
    )
)]
pub(in crate::http) async fn open(State(app): State<App>, Peer(peer): Peer, Name(secret): Name) -> Response {
    match app.access.open_link(&secret, peer) {
        Ok(lasts) => {
            let cookie = view_cookie(&secret, lasts);
            (StatusCode::SEE_OTHER, [(header::LOCATION, MONITOR.to_owned()), (header::SET_COOKIE, cookie)])
                .into_response()
        }
        Err(error) => refused(error),
    }
}

/// For people: whoever opens a link has no program that reads problems.
fn refused(error: ApiError) -> Response {
    let refusal = error.refusal();
    let Problem { detail, status, .. } = error.into();
    let status = StatusCode::from_u16(status).unwrap_or(StatusCode::UNAUTHORIZED);
    let page = format!(
        "<!doctype html><html lang=\"en\"><meta charset=\"utf-8\">\
         <meta name=\"viewport\" content=\"width=device-width\"><title>cipdeck</title>\
         <h1>This link does not open</h1><p>{detail}</p></html>"
    );
    (status, Extension(refusal), Html(page)).into_response()
}

/// Scheme, name and port under which the caller has reached the relay. `Host` and `Origin` have been checked.
pub(super) fn address(headers: &HeaderMap, actor: &Actor) -> Result<String, ApiError> {
    let text = |name| headers.get(name).and_then(|value: &header::HeaderValue| value.to_str().ok());
    if let Some(origin) = text(header::ORIGIN) {
        return Ok(origin.to_owned());
    }
    let host =
        text(header::HOST).ok_or_else(|| ApiError::Unreadable("the request names no Host".to_owned()))?;
    // Without a browser: plain HTTP is on loopback only.
    let is_plain = actor.kind() == ActorKind::Local
        || actor.from().parse().is_ok_and(|from: std::net::IpAddr| from.is_loopback());
    Ok(format!("{}://{host}", if is_plain { "http" } else { "https" }))
}

/// An image that a tablet's camera reads.
pub(super) fn qr_svg(url: &str) -> Result<String, ApiError> {
    let code = QrCode::new(url).map_err(|error| ApiError::Internal(format!("no QR code: {error}")))?;
    Ok(code.render::<svg::Color<'_>>().min_dimensions(240, 240).build())
}

#[cfg(test)]
mod tests {
    use cipdeck_shared::api::Role;

    use super::*;

    #[test]
    fn a_link_leads_to_where_its_maker_is() {
        let actor = Actor::local(Role::Admin, "127.0.0.1");
        let mut headers = HeaderMap::new();
        address(&headers, &actor).unwrap_err();
        headers.insert(header::HOST, "127.0.0.1:8818".parse().unwrap());
        assert_eq!(address(&headers, &actor).unwrap(), "http://127.0.0.1:8818");
        headers.insert(header::ORIGIN, "https://relay.plant.example:8818".parse().unwrap());
        assert_eq!(address(&headers, &actor).unwrap(), "https://relay.plant.example:8818");
    }

    #[test]
    fn the_code_is_an_image() {
        let svg = qr_svg(&format!("https://relay.plant.example:8818/view/{}", "0".repeat(64))).unwrap();
        assert!(svg.contains("<svg") && !svg.contains("<script"), "{svg}");
    }
}
