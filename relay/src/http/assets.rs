//! The page, embedded in the binary.

use axum::http::{HeaderMap, HeaderValue, Method, StatusCode, Uri, header};
use axum::response::{Html, IntoResponse, Response};
use cipdeck_shared::config::BlockId;
use rust_embed::RustEmbed;

use crate::error::ApiError;

#[derive(RustEmbed)]
#[folder = "../frontend/dist"]
#[allow_missing = true]
struct Page;

/// A file of the page; for every address without a file ending one of the documents, which know their own routes.
pub(crate) async fn show(method: Method, uri: Uri, headers: HeaderMap) -> Response {
    let path = uri.path().trim_start_matches('/');
    if !matches!(method, Method::GET | Method::HEAD) {
        return ApiError::NotFound(format!("nothing takes {method} at /{path}")).into_response();
    }
    let document = document(path);
    let file = document.unwrap_or(path);
    let zipped = takes_gzip(&headers).then(|| Page::get(&format!("{file}.gz"))).flatten();
    if let Some(content) = zipped {
        let mut response = serve(file, content.data.into_owned());
        response.headers_mut().insert(header::CONTENT_ENCODING, HeaderValue::from_static("gzip"));
        return response;
    }
    match Page::get(file) {
        Some(content) => serve(file, content.data.into_owned()),
        None if document.is_some() => not_built().into_response(),
        None => ApiError::NotFound(format!("nothing is at /{path}")).into_response(),
    }
}

/// The document of an address, if it is not that of a file: one of those with an address of their own, or the workbench.
fn document(path: &str) -> Option<&'static str> {
    let path = path.trim_end_matches('/');
    let (first, last) = (path.split('/').next(), path.rsplit('/').next());
    match (first, last) {
        (_, Some(name)) if name.contains('.') => None,
        (Some("office"), _) => Some("office.html"),
        (Some("devices"), _) => Some("devices.html"),
        (Some("words"), _) => Some("words.html"),
        (Some("code"), Some(last)) if last == "project" || last.parse::<BlockId>().is_ok() => {
            Some("take.html")
        }
        (Some("code"), _) => Some("code.html"),
        _ => Some("index.html"),
    }
}

fn serve(path: &str, content: Vec<u8>) -> Response {
    let kind = mime_guess::from_path(path).first_or_octet_stream();
    let content_type = match kind.essence_str() {
        "text/html" | "text/javascript" | "text/css" => format!("{}; charset=utf-8", kind.essence_str()),
        other => other.to_owned(),
    };
    let cache = if is_hashed(path) { "public, max-age=31536000, immutable" } else { "no-cache" };
    let content_type = HeaderValue::from_str(&content_type)
        .unwrap_or_else(|_| HeaderValue::from_static("application/octet-stream"));
    let headers = [
        (header::CONTENT_TYPE, content_type),
        (header::CACHE_CONTROL, HeaderValue::from_static(cache)),
        // What is shipped is there gzipped as well: these are files, the same for everybody.
        (header::VARY, HeaderValue::from_static("accept-encoding")),
    ];
    (headers, content).into_response()
}

/// Whether the caller can read gzip: named, and not ruled out by `q=0`.
fn takes_gzip(headers: &HeaderMap) -> bool {
    let named = headers.get_all(header::ACCEPT_ENCODING).iter().filter_map(|value| value.to_str().ok());
    named.flat_map(|value| value.split(',')).any(|coding| {
        let (name, weight) = coding.split_once(';').unwrap_or((coding, "q=1"));
        let weight = weight.trim().strip_prefix("q=").and_then(|weight| weight.parse::<f32>().ok());
        name.trim().eq_ignore_ascii_case("gzip") && weight.is_none_or(|weight| weight > 0.0)
    })
}

/// A name that changes with the content: `page-0123456789abcdef.wasm`.
fn is_hashed(path: &str) -> bool {
    let stem = path.rsplit('/').next().unwrap_or_default().split('.').next().unwrap_or_default();
    stem.rsplit_once('-')
        .is_some_and(|(_, hash)| hash.len() == 16 && hash.bytes().all(|b| b.is_ascii_hexdigit()))
}

/// The relay compiles without a built page, and then says how to build it.
fn not_built() -> impl IntoResponse {
    let text = "<!doctype html><html lang=\"en\"><meta charset=\"utf-8\"><title>cipdeck</title>\
                <h1>This relay was built without its page</h1>\
                <p>Build it with <code>cargo xtask run</code>, or use the interfaces: <a href=\"/api/v1/health\">/api/v1/health</a>.</p></html>";
    (StatusCode::OK, [(header::CACHE_CONTROL, "no-cache")], Html(text))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn an_address_is_that_of_a_document_or_of_a_file() {
        for path in ["", "monitor", "deck/b7", "officer", "deck/office", "deck/devices", "wordy", "deck/code"]
        {
            assert_eq!(document(path), Some("index.html"), "{path}");
        }
        for path in ["office", "office/", "office/sign-in", "office/history/b7"] {
            assert_eq!(document(path), Some("office.html"), "{path}");
        }
        for path in ["devices", "devices/", "devices/d1", "devices/g12/trend"] {
            assert_eq!(document(path), Some("devices.html"), "{path}");
        }
        for path in ["words", "words/", "words/new", "words/b7"] {
            assert_eq!(document(path), Some("words.html"), "{path}");
        }
        for path in ["code/b7", "code/b7/", "code/project"] {
            assert_eq!(document(path), Some("take.html"), "{path}");
        }
        for path in ["code", "code/", "code/b", "code/projects"] {
            assert_eq!(document(path), Some("code.html"), "{path}");
        }
        for path in ["icon.svg", "office/page.js", "snippets/gloo-0123/inline0.js"] {
            assert_eq!(document(path), None, "{path}");
        }
    }

    #[test]
    fn gzip_goes_to_whom_it_is_named_by() {
        let takes = |value: &'static str| {
            takes_gzip(&HeaderMap::from_iter([(header::ACCEPT_ENCODING, HeaderValue::from_static(value))]))
        };
        for value in ["gzip", "gzip, deflate, br, zstd", "br;q=1.0, GZIP;q=0.5"] {
            assert!(takes(value), "{value}");
        }
        for value in ["", "identity", "br", "gzip;q=0", "xgzip"] {
            assert!(!takes(value), "{value}");
        }
        assert!(!takes_gzip(&HeaderMap::new()));
    }

    #[test]
    fn only_names_that_change_with_their_content_are_kept_for_ever() {
        assert!(is_hashed("page-0123456789abcdef.wasm"));
        for path in ["index.html", "page.js", "snippets/gloo-0123/inline0.js", "page-0123456789abcdeg.js"] {
            assert!(!is_hashed(path), "{path}");
        }
    }
}
