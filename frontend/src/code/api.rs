//! What this document asks of the relay, beside what it reads with the office's `fetch`.

use cipdeck_shared::{
    api::ProjectImport,
    config::{BlockConfig, BlockId},
};
use gloo_net::http::Method;
use serde::Deserialize;

use super::project::Source;
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

/// What would come of a project.
pub(super) async fn look(source: &Source) -> Answered<ProjectImport> {
    project(source, "?preview=true").await
}

/// Takes a project in that was looked at.
pub(super) async fn take(source: &Source, looked: &ProjectImport) -> Answered<ProjectImport> {
    let seen = looked.seen.as_ref().map(|seen| format!("?seen={seen}"));
    project(source, &seen.unwrap_or_default()).await
}

async fn project(source: &Source, query: &str) -> Answered<ProjectImport> {
    let (resource, body) = match source {
        Source::Zip(zip) => ("project", Some((ZIP, zip.clone().into()))),
        Source::Folder => ("project/folder", None),
    };
    let reply = rest::send(Method::POST, &format!("{resource}{query}"), body).await?;
    match reply.status {
        200..300 => rest::parse(&reply.text),
        _ => Err(reply.problem()),
    }
}

const ZIP: &str = "application/zip";
