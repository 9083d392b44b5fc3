//! `/api/v1/project`: blocks, devices and groups as one file.

use axum::Json as Answer;
use axum::extract::{Query, State};
use axum::http::{Uri, header};
use axum::response::IntoResponse;
use cipdeck_shared::api::{ProjectFolder, ProjectImport};

use super::caller::Caller;
use super::extract::Archive;
use crate::app::App;
use crate::error::ApiError;
use crate::project::{self, Wish};

/// The one address whose body is no JSON.
pub(super) const ROUTE: &str = "/api/v1/project";

/// All blocks, devices, groups and variables as a zip archive of small files; docs/PROJECTS.md describes them.
#[utoipa::path(
    get,
    path = "/project",
    tag = "project",
    responses((status = 200, description = "The archive", body = [u8], content_type = "application/zip"))
)]
pub(super) async fn export(State(app): State<App>) -> Result<impl IntoResponse, ApiError> {
    let files = app.store.files().await?;
    let packed = tokio::task::spawn_blocking(move || project::pack(&files)).await;
    let packed = packed.map_err(|error| ApiError::Internal(error.to_string()))?;
    let packed = packed.map_err(|error| ApiError::Internal(error.to_string()))?;
    let headers = [
        (header::CONTENT_TYPE, "application/zip"),
        (header::CONTENT_DISPOSITION, "attachment; filename=\"cipdeck-project.zip\""),
    ];
    Ok((headers, packed))
}

/// The folder that the relay keeps as a project, if it keeps one.
#[utoipa::path(
    get,
    path = "/project/folder",
    tag = "project",
    responses((status = 200, description = "The folder, as the relay's machine names it", body = ProjectFolder))
)]
pub(super) async fn folder(State(app): State<App>) -> Answer<ProjectFolder> {
    let folder = app.settings.project.as_ref().map(|folder| folder.display().to_string());
    Answer(ProjectFolder { folder })
}

/// Takes in such an archive: what has the same name is replaced, what is new is created, everything else stays. All of
/// it is stored, or nothing.
#[utoipa::path(
    post,
    path = "/project",
    tag = "project",
    params(("preview" = Option<bool>, Query, description = "Tells what would be done, and what is wrong, and stores nothing")),
    request_body(content = [u8], content_type = "application/zip", description = "At most 16 MB"),
    extensions(("x-cipdeck-problems" = json!(["conflict", "findings"]))),
    responses((status = 200, description = "What was done, or would be", body = ProjectImport))
)]
pub(super) async fn import(
    State(app): State<App>,
    Caller(actor): Caller,
    uri: Uri,
    Archive(archive): Archive,
) -> Result<Answer<ProjectImport>, ApiError> {
    project::import(&app, &actor, archive, wish(&uri, &["preview"])?.is_preview).await.map(Answer)
}

/// The folder is read again, after somebody else has changed its files: what is new is created, what differs is changed,
/// what has no file any more is removed, and what of it runs is stopped. All of it is stored, or nothing.
#[utoipa::path(
    post,
    path = "/project/folder",
    tag = "project",
    params(
        ("preview" = Option<bool>, Query, description = "Tells what would be done, and what is wrong, and stores nothing"),
        ("seen" = Option<String>, Query, description = "`seen` of a preview: if the files have been changed since, nothing is stored"),
    ),
    extensions(("x-cipdeck-problems" = json!(["conflict", "findings", "unavailable"]))),
    responses((status = 200, description = "What was done, or would be", body = ProjectImport))
)]
pub(super) async fn reread(
    State(app): State<App>,
    Caller(actor): Caller,
    uri: Uri,
) -> Result<Answer<ProjectImport>, ApiError> {
    project::reread(&app, &actor, wish(&uri, &["preview", "seen"])?).await.map(Answer)
}

/// `?preview=true&seen=…`, as far as `known`. Anything else could be meant as that, and would store something.
fn wish(uri: &Uri, known: &[&str]) -> Result<Wish, ApiError> {
    let unreadable = || {
        let known = known.join(" and ");
        ApiError::Unreadable(format!("parameters here are {known}, each once; preview is true or false"))
    };
    let Query(pairs) = Query::<Vec<(String, String)>>::try_from_uri(uri).map_err(|_| unreadable())?;
    let mut wish = Wish::default();
    let mut given: Vec<&str> = Vec::new();
    for (name, value) in &pairs {
        if !known.contains(&&**name) || given.contains(&&**name) {
            return Err(unreadable());
        }
        given.push(name);
        match name.as_str() {
            "preview" => wish.is_preview = value.parse().map_err(|_| unreadable())?,
            _ => wish.seen = Some(value.clone()),
        }
    }
    Ok(wish)
}
