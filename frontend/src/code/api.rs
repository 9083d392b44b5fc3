//! What this document asks of the relay, beside what it reads with the office's `fetch`.

use cipdeck_shared::{
    api::ProjectImport,
    config::{Block, BlockConfig},
};
use gloo_net::http::Method;
use js_sys::Uint8Array;

use crate::net::rest::{self, Answered};

/// One more block.
pub(super) async fn save(config: &BlockConfig) -> Answered<Block> {
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
