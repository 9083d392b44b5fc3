//! What is taken in is looked at first: a zip that somebody chooses, or the relay's folder on its disk.

use cipdeck_shared::{api::ProjectImport, plan::Severity};
use js_sys::Uint8Array;
use yew::prelude::*;

use super::{
    super::{api, i18n::tr},
    preview::preview,
};
use crate::office::{
    fetch::{Action, use_action},
    kit::problem_note,
};

/// What is to be taken in.
#[derive(Clone, Debug)]
pub(in super::super) enum Source {
    /// The bytes of a zip.
    Zip(Uint8Array),
    /// The files as they are now on the relay's disk.
    Folder,
}

impl Source {
    const fn is_folder(&self) -> bool {
        matches!(self, Self::Folder)
    }
}

/// A look, and what follows from it.
#[derive(Clone)]
pub(super) struct Review {
    action: Action,
    seen: UseStateHandle<Option<(Source, ProjectImport)>>,
    done: UseStateHandle<Option<ProjectImport>>,
}

/// One on each place that takes something in.
#[hook]
pub(super) fn use_review() -> Review {
    Review { action: use_action(), seen: use_state(|| None), done: use_state(|| None) }
}

impl Review {
    /// Nothing was looked at yet.
    pub(super) fn clear(&self) {
        self.seen.set(None);
        self.done.set(None);
    }

    /// Whether the relay is at it.
    pub(super) fn is_busy(&self) -> bool {
        self.action.is_busy()
    }

    /// Asks what would happen.
    pub(super) fn look(&self, source: Source) {
        self.clear();
        let (asked, seen) = (source.clone(), self.seen.setter());
        self.action.go(async move { api::look(&asked).await }, move |import| {
            seen.set(Some((source, import)));
        });
    }

    /// Does what was looked at.
    fn take(&self) {
        let Some((source, import)) = &*self.seen else { return };
        let (source, import) = (source.clone(), import.clone());
        let (seen, done) = (self.seen.setter(), self.done.setter());
        self.action.go(async move { api::take(&source, &import).await }, move |import| {
            seen.set(None);
            done.set(Some(import));
        });
    }

    /// What would happen with the button that does it, or what has happened.
    pub(super) fn html(&self) -> Html {
        let onclick = {
            let review = self.clone();
            move |_: MouseEvent| review.take()
        };
        html! { <>
            { problem_note(self.action.problem().as_ref()) }
            if self.is_busy() {
                <p class="hint" role="status">{ tr!("project.looking") }</p>
            }
            if let Some((source, import)) = &*self.seen {
                { preview(import) }
                <div class="code-save">
                    <button type="button" class="button primary" disabled={self.is_busy() || !may(source, import)} {onclick} data-test="project-do">
                        { if source.is_folder() { tr!("project.folder_do") } else { tr!("project.do") } }
                    </button>
                    if !is_whole(source, import) {
                        <span class="finding error">{ tr!("project.not_whole") }</span>
                    } else if !changes_something(import) {
                        <span class="hint">{ tr!("project.nothing") }</span>
                    }
                </div>
            }
            if let Some(import) = &*self.done {
                <div class="code-all" role="status" data-test="project-done">{ tr!("project.done") }</div>
                { preview(import) }
            }
        </> }
    }
}

/// A file on the disk may have been written anew without saying anything new: then it has to be taken all the same, before
/// it can be written again.
fn may(source: &Source, import: &ProjectImport) -> bool {
    is_whole(source, import) && (source.is_folder() || changes_something(import))
}

/// A zip must have no errors. In the folder wrong numbers are what somebody works on; what cannot be read is an error
/// there, too.
fn is_whole(source: &Source, import: &ProjectImport) -> bool {
    let mut errors = import.findings.iter().filter(|finding| finding.severity == Severity::Error);
    !errors.any(|finding| !source.is_folder() || finding.rule == "project_file")
}

fn changes_something(import: &ProjectImport) -> bool {
    use cipdeck_shared::api::ProjectChange::{Changed, Created, Removed};
    import.parts.iter().any(|part| matches!(part.how, Created | Changed | Removed))
}
