//! A project that somebody sends: taken in as a whole, or not at all.

use cipdeck_shared::api::{ProjectChange, ProjectImport};
use cipdeck_shared::config::project::read;
use cipdeck_shared::plan::Severity;

use super::{findings, unpack};
use crate::actor::Actor;
use crate::app::App;
use crate::error::ApiError;

/// Stores what an archive holds, or tells what that would do. Nothing is stored when anything is wrong.
pub(crate) async fn import(
    app: &App,
    actor: &Actor,
    archive: Vec<u8>,
    is_preview: bool,
) -> Result<ProjectImport, ApiError> {
    let unpacked = tokio::task::spawn_blocking(move || {
        let (files, ignored) = unpack(&archive)?;
        let read = read(&files);
        let findings = findings(&files, &read);
        Ok((read, findings, ignored))
    });
    let unpacked = unpacked.await.map_err(|error| ApiError::Internal(error.to_string()))?;
    let (read, findings, mut ignored) =
        unpacked.map_err(|error: super::ArchiveError| ApiError::Unreadable(error.to_string()))?;
    ignored.extend(read.ignored);
    let is_wrong = findings.iter().any(|finding| finding.severity == Severity::Error);
    if is_wrong && !is_preview {
        return Err(ApiError::Findings(findings));
    }
    let name = read.project.head.name.clone();
    let mut answer = ProjectImport { stored: false, name, parts: Vec::new(), findings, ignored };
    if is_wrong {
        return Ok(answer);
    }
    let (blocks, plant, store, actor) =
        (app.blocks.clone(), app.plant.clone(), app.store.clone(), actor.clone());
    // It runs to its end even when nobody waits for it any more: the database and the engine must agree.
    let merge = tokio::spawn(async move {
        let _no_other_block = blocks.hold().await;
        let _no_other_device = plant.hold().await;
        let mut outcome = store.merge(read.project, is_preview).await?;
        if is_preview {
            for part in outcome.parts.iter_mut().filter(|part| part.how == ProjectChange::Created) {
                part.id = None;
            }
        } else {
            blocks.take_over(&actor, &outcome.touched).await?;
            plant.take_over(&actor, &outcome.touched, &outcome.parts).await?;
        }
        Ok::<_, ApiError>(outcome.parts)
    });
    answer.parts = merge.await.map_err(|error| ApiError::Internal(error.to_string()))??;
    answer.stored = !is_preview;
    Ok(answer)
}
