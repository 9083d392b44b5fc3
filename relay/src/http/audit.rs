//! `/api/v1/audit`: the records, newest first, and the file as it is.

use std::io;

use axum::Json as Answer;
use axum::body::Body;
use axum::extract::{Query, State};
use axum::http::header;
use axum::response::IntoResponse;
use cipdeck_shared::api::{AuditPage, AuditState};
use tokio::io::AsyncReadExt;
use tokio::sync::mpsc;

use crate::app::App;
use crate::audit::Filter;
use crate::error::ApiError;

/// Bytes that are read and sent at once.
const CHUNK: usize = 64 * 1024;

/// Records of the audit, the newest first.
#[utoipa::path(
    get,
    path = "/audit",
    tag = "audit",
    params(Filter),
    responses((status = 200, description = "A page", body = AuditPage))
)]
pub(super) async fn list(
    State(app): State<App>,
    filter: Result<Query<Filter>, axum::extract::rejection::QueryRejection>,
) -> Result<Answer<AuditPage>, ApiError> {
    let Query(filter) = filter.map_err(|rejection| ApiError::Unreadable(rejection.body_text()))?;
    let read = tokio::task::spawn_blocking(move || app.audit.page(&filter)).await;
    let page =
        read.map_err(|error| error.to_string()).and_then(|page| page.map_err(|error| error.to_string()));
    page.map(Answer).map_err(|error| ApiError::Internal(format!("the audit cannot be read: {error}")))
}

/// Whether the audit is written, and its end.
#[utoipa::path(
    get,
    path = "/audit/state",
    tag = "audit",
    responses((status = 200, description = "The state", body = AuditState))
)]
pub(super) async fn state(State(app): State<App>) -> Answer<AuditState> {
    Answer(app.audit.state())
}

/// The whole audit, as it is kept.
#[utoipa::path(
    get,
    path = "/audit.jsonl",
    tag = "audit",
    responses((status = 200, description = "A record per line", body = String, content_type = "application/x-ndjson"))
)]
pub(super) async fn export(State(app): State<App>) -> Result<impl IntoResponse, ApiError> {
    let body = match app.audit.file() {
        None => Body::from(app.audit.memory().unwrap_or_default()),
        Some((path, length)) => {
            let unreadable =
                |error: io::Error| ApiError::Internal(format!("the audit cannot be read: {error}"));
            let file = tokio::fs::File::open(path).await.map_err(unreadable)?;
            Body::from_stream(pieces(file.take(length)))
        }
    };
    let headers = [
        (header::CONTENT_TYPE, "application/x-ndjson"),
        (header::CONTENT_DISPOSITION, "attachment; filename=\"audit.jsonl\""),
    ];
    Ok((headers, body))
}

/// Read no faster than the client takes it.
fn pieces(
    mut file: tokio::io::Take<tokio::fs::File>,
) -> impl futures_util::Stream<Item = io::Result<Vec<u8>>> + Send {
    let (sender, mut receiver) = mpsc::channel(1);
    tokio::spawn(async move {
        loop {
            let mut piece = Vec::with_capacity(CHUNK);
            let read = (&mut file).take(CHUNK as u64).read_to_end(&mut piece).await;
            let is_last = !matches!(read, Ok(1..));
            if !matches!(read, Ok(0)) && sender.send(read.map(|_| piece)).await.is_err() || is_last {
                return;
            }
        }
    });
    futures_util::stream::poll_fn(move |context| receiver.poll_recv(context))
}
