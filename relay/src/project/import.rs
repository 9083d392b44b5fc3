//! A project that somebody sends, or that lies in the folder: taken in as a whole, or not at all.

use cipdeck_shared::api::{ProjectChange, ProjectImport, ProjectPart, ProjectPartKind};
use cipdeck_shared::config::write_hex;
use cipdeck_shared::plan::Severity;
use sha2::{Digest, Sha256};
use tokio::task::JoinError;

use super::difference::together;
use super::{ArchiveError, Folder, Looked, Outcome, found, unpack};
use crate::actor::Actor;
use crate::app::App;
use crate::error::ApiError;
use crate::store::StoreError;

/// What somebody wants to know or to have done.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub(crate) struct Wish {
    /// Tell what would be done; store nothing.
    pub(crate) is_preview: bool,
    /// What a preview has called the files of the folder: they have to be the same still.
    pub(crate) seen: Option<String>,
}

/// Stores what an archive holds, or tells what that would do. Nothing is stored when anything is wrong.
pub(crate) async fn import(
    app: &App,
    actor: &Actor,
    archive: Vec<u8>,
    is_preview: bool,
) -> Result<ProjectImport, ApiError> {
    let unpacked = aside(move || {
        let (files, ignored) = unpack(&archive)?;
        Ok((found(&files), ignored))
    });
    let ((read, findings), mut ignored) =
        unpacked.await?.map_err(|error: ArchiveError| ApiError::Unreadable(error.to_string()))?;
    ignored.extend(read.ignored);
    let is_wrong = findings.iter().any(|finding| finding.severity == Severity::Error);
    let name = read.project.head.name.clone();
    let mut answer = ProjectImport { name, findings, ignored, ..ProjectImport::default() };
    if is_wrong {
        return wrong(answer, is_preview);
    }
    let (app, actor) = (app.clone(), actor.clone());
    // It runs to its end even when nobody waits for it any more: the database and the engine must agree.
    let merge = tokio::spawn(async move {
        let _no_other_block = app.blocks.hold().await;
        let _no_other_device = app.plant.hold().await;
        let outcome = app.store.merge(read.project, is_preview).await?;
        take_over(&app, &actor, outcome, is_preview).await
    });
    answer.parts = ended(merge.await)?;
    answer.stored = !is_preview;
    Ok(answer)
}

/// Reads the folder that the relay keeps again, because somebody else has changed it, or tells what that would do.
/// Nothing is stored when a file cannot be read; a block with wrong numbers is taken as it is, as at the start.
pub(crate) async fn reread(app: &App, actor: &Actor, wish: Wish) -> Result<ProjectImport, ApiError> {
    let no_folder =
        || ApiError::Conflict("this relay keeps no folder: cipdeck serve --project DIR does".to_owned());
    let root = app.settings.project.clone().ok_or_else(no_folder)?;
    let (app, actor) = (app.clone(), actor.clone());
    let reading = tokio::spawn(async move {
        // What the relay itself writes meanwhile would look like somebody else's.
        let _no_other_block = app.blocks.hold().await;
        let _no_other_device = app.plant.hold().await;
        let stored = app.store.last_change().await?;
        let looked = aside(move || {
            Folder::repair(&root, stored.as_deref())?;
            Looked::at(&root)
        });
        let Looked { folder, read, findings } = looked.await?.map_err(StoreError::Files)?;
        let seen = folder.as_ref().map(digest);
        if wish.seen.is_some() && wish.seen != seen {
            let words =
                "the folder has been changed since somebody has looked at it: look again, and decide again";
            return Err(ApiError::Conflict(words.to_owned()));
        }
        let (name, ignored) = (read.project.head.name.clone(), read.ignored.clone());
        let mut answer = ProjectImport { name, findings, ignored, seen, ..ProjectImport::default() };
        let Some(folder) = folder.filter(|_| read.errors.is_empty()) else {
            return wrong(answer, wish.is_preview);
        };
        let outcome = app.store.join(folder, read, wish.is_preview).await?;
        answer.parts = take_over(&app, &actor, outcome, wish.is_preview).await?;
        answer.stored = !wish.is_preview;
        Ok(answer)
    });
    ended(reading.await)
}

/// Everybody hears of what was stored; of what would be stored, nobody.
async fn take_over(
    app: &App,
    actor: &Actor,
    mut outcome: Outcome,
    is_preview: bool,
) -> Result<Vec<ProjectPart>, ApiError> {
    let is_block = |part: &&mut ProjectPart| part.what == ProjectPartKind::Block;
    for part in outcome.parts.iter_mut().filter(is_block) {
        let id = part.id.as_deref().and_then(|id| id.parse().ok());
        let is_other = matches!(part.how, ProjectChange::Changed | ProjectChange::Removed);
        if is_other && id.is_some_and(|id| app.blocks.is_on(id)) {
            part.detail = together([Some("it runs, and is stopped".to_owned()), part.detail.take()]);
        }
    }
    if is_preview {
        for part in outcome.parts.iter_mut().filter(|part| part.how == ProjectChange::Created) {
            part.id = None;
        }
    } else {
        app.blocks.take_over(actor, &outcome.touched).await?;
        app.plant.take_over(actor, &outcome.touched, &outcome.parts).await?;
    }
    Ok(outcome.parts)
}

/// Something is wrong with the files: a preview says what, and everything else is refused.
fn wrong(answer: ProjectImport, is_preview: bool) -> Result<ProjectImport, ApiError> {
    if is_preview { Ok(answer) } else { Err(ApiError::Findings(answer.findings)) }
}

/// What the files of a folder are, in few characters.
fn digest(folder: &Folder) -> String {
    let mut digest = Sha256::new();
    for (path, text) in folder.files() {
        // Lengths in front, so that no two folders are the same text.
        digest.update(format!("{} {} {path}", path.len(), text.len()));
        digest.update(text);
    }
    write_hex(&digest.finalize())
}

/// Work that takes a while, beside everything else.
async fn aside<T: Send + 'static>(work: impl FnOnce() -> T + Send + 'static) -> Result<T, ApiError> {
    tokio::task::spawn_blocking(work).await.map_err(|error| ApiError::Internal(error.to_string()))
}

fn ended<T>(task: Result<Result<T, ApiError>, JoinError>) -> Result<T, ApiError> {
    task.map_err(|error| ApiError::Internal(error.to_string()))?
}
