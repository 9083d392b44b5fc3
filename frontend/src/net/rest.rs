//! REST: what is asked once and answered once.

use cipdeck_shared::{
    api::{DiscoverRequest, Discovered, ExchangeView, Health, Problem, ProblemCode, TargetStatus},
    config::{Block, BlockId, MsgCipGeneric},
};
use gloo_net::http::{Request, RequestBuilder, Response};
use serde::{Serialize, de::DeserializeOwned};

/// An answer, or why there is none.
pub type Answered<T> = Result<T, Problem>;

/// The relay's health: also the way to measure how far away it is.
pub async fn health() -> Answered<Health> {
    read(send(Request::get(&address("health"))).await?).await
}

/// Stores a new block.
pub async fn create(config: &MsgCipGeneric) -> Answered<Block> {
    read(send_json(Request::post(&address("blocks")), config).await?).await
}

/// Replaces a block; the block names the revision that it replaces.
pub async fn replace(block: &Block) -> Answered<Block> {
    let mut config = block.config.clone();
    // One way to write configurations instead of two. The relay takes the id from the address.
    config.extra.insert("revision".to_owned(), block.revision.into());
    config.extra.insert("id".to_owned(), String::from(block.id).into());
    read(send_json(Request::put(&address(&format!("blocks/{}", block.id))), &config).await?).await
}

/// Deletes a block, if it still has this revision.
pub async fn delete(id: BlockId, revision: u64) -> Answered<()> {
    let address = address(&format!("blocks/{id}?revision={revision}"));
    refuse(send(Request::delete(&address)).await?).await.map(|_| ())
}

/// The newest exchange of a block.
pub async fn newest_exchange(id: BlockId) -> Answered<Option<ExchangeView>> {
    let all: Vec<ExchangeView> =
        read(send(Request::get(&address(&format!("blocks/{id}/exchange")))).await?).await?;
    // RFC 3339 in UTC sorts as text.
    Ok(all.into_iter().max_by(|one, other| one.at.cmp(&other.at)))
}

/// Where the frames of a block's last messages are, for Wireshark.
pub fn capture(id: BlockId) -> String {
    address(&format!("blocks/{id}/exchange.pcapng"))
}

/// Who is on the network.
pub async fn discover(request: &DiscoverRequest) -> Answered<Discovered> {
    read(send_json(Request::post(&address("discover")), request).await?).await
}

/// All targets, with what counts up in them as it is now.
pub async fn targets() -> Answered<Vec<TargetStatus>> {
    read(send(Request::get(&address("targets"))).await?).await
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

fn address(resource: &str) -> String {
    format!("/api/v1/{resource}")
}

async fn send(request: RequestBuilder) -> Answered<Response> {
    request.send().await.map_err(|error| unreachable(error.to_string()))
}

async fn send_json(request: RequestBuilder, body: &impl Serialize) -> Answered<Response> {
    let text = serde_json::to_string(body).map_err(|error| unreachable(error.to_string()))?;
    let request = request.header("Content-Type", "application/json").body(text);
    let request = request.map_err(|error| unreachable(error.to_string()))?;
    request.send().await.map_err(|error| unreachable(error.to_string()))
}

async fn refuse(response: Response) -> Answered<Response> {
    if response.ok() {
        return Ok(response);
    }
    let status = response.status();
    let text = response.text().await.unwrap_or_default();
    Err(serde_json::from_str(&text)
        .unwrap_or_else(|_| Problem { status, ..unreachable(format!("HTTP {status}")) }))
}

async fn read<T: DeserializeOwned>(response: Response) -> Answered<T> {
    let text = refuse(response).await?.text().await.map_err(|error| unreachable(error.to_string()))?;
    serde_json::from_str(&text).map_err(|error| unreachable(error.to_string()))
}
