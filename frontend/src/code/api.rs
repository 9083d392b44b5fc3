//! What this document asks of the relay, beside what it reads with the office's `fetch`.

use cipdeck_shared::{
    api::ProjectImport,
    config::{BlockConfig, BlockId},
};
use gloo_net::http::Method;
use js_sys::Uint8Array;
use serde::Deserialize;

use crate::net::rest::{self, Answered};

/// What is needed of a stored block. Reading all of it would be 4 kB of the document.
#[derive(Debug, PartialEq, Deserialize)]
pub(super) struct Stored {
    /// Given by the relay.
    pub(super) id: BlockId,
    /// What people call it.
    pub(super) name: String,
}

/// One more block.
pub(super) async fn save(config: &BlockConfig) -> Answered<Stored> {
    rest::parse(&rest::ask(Method::POST, "blocks", Some(rest::json(config)?)).await?)
}

/// Everything in a zip, or what would come of it.
pub(super) async fn import_project(zip: &Uint8Array, is_preview: bool) -> Answered<ProjectImport> {
    let resource = if is_preview { "project?preview=true" } else { "project" };
    let reply = rest::send(Method::POST, resource, Some((ZIP, zip.clone().into()))).await?;
    match reply.status {
        200..300 => rest::parse(&reply.text),
        _ => Err(reply.problem()),
    }
}

const ZIP: &str = "application/zip";
