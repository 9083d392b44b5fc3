//! REST: what is asked once and answered once.

use cipdeck_shared::{
    api::{
        DiscoverRequest, Discovered, ExchangeView, NewWindow, Problem, ProblemCode, SessionView,
        TargetStatus, WriteRequest, WriteTicket,
    },
    config::{Block, BlockId},
};
use gloo_net::http::{Method, Request, RequestBuilder};
use serde::{Serialize, de::DeserializeOwned};
use wasm_bindgen::JsValue;
use web_sys::AbortSignal;

use super::session;

/// An answer, or why there is none.
pub type Answered<T> = Result<T, Problem>;

/// Whether the relay answers, whatever it says: also the way to measure how far away it is.
pub async fn is_there() -> bool {
    answer(soon("health")).await.is_ok()
}

/// Who the relay takes this browser for.
pub async fn session() -> Answered<SessionView> {
    parse(&answer(soon("session")).await?.text()?)
}

/// A question that is given up when nobody has answered soon: a browser has few connections to one relay, and those
/// over which nothing will come any more would keep others waiting.
fn soon(resource: &str) -> Result<Request, gloo_net::Error> {
    let too_late = AbortSignal::timeout_with_u32(SOON_MS);
    RequestBuilder::new(&address(resource)).abort_signal(Some(&too_late)).build()
}

/// ms
const SOON_MS: u32 = 10_000;

/// Ends the session.
pub async fn sign_out() -> Answered<()> {
    ask(Method::DELETE, "session", None).await.map(|_| ())
}

/// Says that somebody is there.
pub async fn is_active() -> Answered<()> {
    ask(Method::POST, "session/active", None).await.map(|_| ())
}

/// Stores a new block.
pub async fn create(config: &impl Serialize) -> Answered<Block> {
    parse(&ask(Method::POST, "blocks", Some(json(config)?)).await?)
}

/// Replaces a block by a configuration that says which revision was seen.
pub async fn replace(id: BlockId, config: &impl Serialize) -> Answered<Block> {
    parse(&ask(Method::PUT, &format!("blocks/{id}"), Some(json(config)?)).await?)
}

/// Deletes a block, if it still has this revision.
pub async fn delete(id: BlockId, revision: u64) -> Answered<()> {
    ask(Method::DELETE, &format!("blocks/{id}?revision={revision}"), None).await.map(|_| ())
}

/// The newest exchange of a block.
pub async fn newest_exchange(id: BlockId) -> Answered<Option<ExchangeView>> {
    let all: Vec<ExchangeView> = parse(&ask(Method::GET, &format!("blocks/{id}/exchange"), None).await?)?;
    // RFC 3339 in UTC sorts as text.
    Ok(all.into_iter().max_by(|one, other| one.at.cmp(&other.at)))
}

/// Where the frames of a block's last messages are, for Wireshark.
pub fn capture(id: BlockId) -> String {
    address(&format!("blocks/{id}/exchange.pcapng"))
}

/// Opens the write window.
pub async fn open_window(minutes: u32) -> Answered<()> {
    let wanted = json(&NewWindow { minutes: Some(minutes) })?;
    ask(Method::POST, "window", Some(wanted)).await.map(|_| ())
}

/// Closes the write window.
pub async fn close_window() -> Answered<()> {
    ask(Method::DELETE, "window", None).await.map(|_| ())
}

/// The first half of a write: what would happen, and the ticket for it.
pub async fn ask_write(id: BlockId, revision: u64) -> Answered<WriteTicket> {
    let seen = json(&WriteRequest { revision })?;
    parse(&ask(Method::POST, &format!("blocks/{id}/write"), Some(seen)).await?)
}

/// Who is on the network.
pub async fn discover(request: &DiscoverRequest) -> Answered<Discovered> {
    parse(&ask(Method::POST, "discover", Some(json(request)?)).await?)
}

/// All targets, with what counts up in them as it is now.
pub async fn targets() -> Answered<Vec<TargetStatus>> {
    parse(&ask(Method::GET, "targets", None).await?)
}

/// A problem that the relay did not report: it could not be reached, or did not speak our language.
pub fn unreachable(detail: String) -> Problem {
    Problem {
        title: "no answer".to_owned(),
        status: 0,
        code: ProblemCode::Other("no_answer".to_owned()),
        detail,
        findings: None,
        current: None,
    }
}

/// Where something of the relay's is.
pub fn address(resource: &str) -> String {
    format!("/api/v1/{resource}")
}

/// The text of an answer. One function for all: what asks differs in a few words only.
pub async fn ask(method: Method, resource: &str, body: Option<String>) -> Answered<String> {
    request(method, resource, body).await?.text()
}

/// What came back, whatever it says.
#[derive(Clone, Debug)]
pub struct Reply {
    /// HTTP.
    pub status: u16,
    /// Seconds after which it makes sense to try again.
    pub retry_after: Option<u32>,
    /// The body.
    pub text: String,
}

impl Reply {
    /// The text of an answer, or the refusal.
    #[expect(clippy::result_large_err, reason = "once per request, and shown to somebody")]
    pub fn text(self) -> Answered<String> {
        if (200..300).contains(&self.status) { Ok(self.text) } else { Err(self.problem()) }
    }

    /// Read as a refusal.
    pub fn problem(&self) -> Problem {
        let status = self.status;
        serde_json::from_str(&self.text)
            .unwrap_or_else(|_| Problem { status, ..unreachable(format!("HTTP {status}")) })
    }
}

/// Sends a request with the proof that it comes from this page. Whoever is not signed in is known to be so from then on.
pub async fn request(method: Method, resource: &str, body: Option<String>) -> Answered<Reply> {
    send(method, resource, body.map(|body| ("application/json", body.into()))).await
}

/// The same with a body of any kind: its media type, and a text or bytes.
pub async fn send(method: Method, resource: &str, body: Option<(&str, JsValue)>) -> Answered<Reply> {
    let mut request = RequestBuilder::new(&address(resource)).method(method);
    if let Some(token) = session::csrf() {
        request = request.header("X-CSRF-Token", &token);
    }
    let request = match body {
        Some((kind, body)) => request.header("Content-Type", kind).body(body),
        None => request.build(),
    };
    answer(request).await
}

async fn answer(request: Result<Request, gloo_net::Error>) -> Answered<Reply> {
    let response = request.map_err(no_answer)?.send().await.map_err(no_answer)?;
    let status = response.status();
    if status == SIGNED_OUT {
        session::lost();
    }
    let retry_after = response.headers().get("Retry-After").and_then(|text| text.parse().ok());
    let text = response.text().await.map_err(no_answer)?;
    Ok(Reply { status, retry_after, text })
}

/// HTTP: nobody is signed in.
const SIGNED_OUT: u16 = 401;

/// A body.
#[expect(clippy::result_large_err, reason = "once per request, and shown to somebody")]
pub fn json(body: &impl Serialize) -> Answered<String> {
    serde_json::to_string(body).map_err(|error| unreachable(error.to_string()))
}

/// What an answer says.
#[expect(clippy::result_large_err, reason = "once per request, and shown to somebody")]
pub fn parse<T: DeserializeOwned>(text: &str) -> Answered<T> {
    serde_json::from_str(text).map_err(|error| unreachable(error.to_string()))
}

#[expect(clippy::needless_pass_by_value, reason = "for map_err")]
fn no_answer(error: gloo_net::Error) -> Problem {
    unreachable(error.to_string())
}
