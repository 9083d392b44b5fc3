//! What an upload would do, or has done, part by part.

use cipdeck_shared::{
    api::{ProjectChange, ProjectImport, ProjectPart, ProjectPartKind},
    plan::Severity,
};
use yew::prelude::*;

use super::super::i18n::tr;
use crate::{editor::Remark, kit::Shape};

/// What is wrong first, then what changes, then what stays.
pub(super) fn preview(import: &ProjectImport) -> Html {
    let count = |how: &[ProjectChange]| import.parts.iter().filter(|part| how.contains(&part.how)).count();
    let errors = import.findings.iter().filter(|finding| finding.severity == Severity::Error).count();
    let counts = tr!(
        "project.counts",
        created = count(&[ProjectChange::Created]),
        changed = count(&[ProjectChange::Changed]),
        removed = count(&[ProjectChange::Removed]),
        left = count(&STAYS),
        wrong = errors
    );
    let (stay, move_): (Vec<_>, Vec<_>) = import.parts.iter().partition(|part| STAYS.contains(&part.how));
    html! {
        <div class="project-preview" data-test="project-preview">
            <h3>{ if import.stored { tr!("project.what_happened") } else { tr!("project.preview") } }</h3>
            if !import.name.is_empty() {
                <p><b>{ &import.name }</b></p>
            }
            <p class="project-counts" role="status" data-test="project-counts">{ counts }</p>
            { for import.findings.iter().map(finding) }
            { for import.ignored.iter().map(|file| html! {
                <p class="finding warning" data-test="project-ignored">{ tr!("project.ignored", file = file) }</p>
            }) }
            if !move_.is_empty() {
                { table(&move_) }
            }
            if !stay.is_empty() {
                <details><summary>{ tr!("project.show_left") }</summary>{ table(&stay) }</details>
            }
        </div>
    }
}

/// Nothing happens to it.
const STAYS: [ProjectChange; 2] = [ProjectChange::Unchanged, ProjectChange::Left];

fn finding(finding: &cipdeck_shared::api::Finding) -> Html {
    let remark = Remark::from_relay(finding);
    let (class, role) = match finding.severity {
        Severity::Error => ("error", Some("alert")),
        Severity::Warning => ("warning", None),
        Severity::Note => ("note", None),
    };
    html! {
        <p class={classes!("finding", class)} {role} data-test="project-finding">
            <span class="finding-word mono">{ remark.field }</span>{ remark.text }
        </p>
    }
}

fn table(parts: &[&ProjectPart]) -> Html {
    html! {
        <div class="scroll"><table class="listing" aria-label={tr!("project.preview")}>
            <thead><tr>
                <th scope="col">{ tr!("changes.what") }</th><th scope="col">{ tr!("project.what") }</th>
                <th scope="col">{ tr!("project.name") }</th><th scope="col">{ tr!("project.file") }</th><th scope="col">{ tr!("project.why") }</th>
            </tr></thead>
            <tbody>{ for parts.iter().map(|part| line(part)) }</tbody>
        </table></div>
    }
}

fn line(part: &ProjectPart) -> Html {
    let (words, shape, class, how) = match part.how {
        ProjectChange::Created => (tr!("project.created"), Shape::Dot, "tick", "created"),
        ProjectChange::Changed => (tr!("project.changed"), Shape::Half, "half", "changed"),
        ProjectChange::Unchanged => (tr!("project.unchanged"), Shape::Ring, "ring", "unchanged"),
        ProjectChange::Left => (tr!("project.left"), Shape::Ring, "ring", "left"),
        ProjectChange::Removed => (tr!("project.removed"), Shape::Cross, "cross", "removed"),
    };
    let what = match part.what {
        ProjectPartKind::Block => tr!("project.block"),
        ProjectPartKind::Target => tr!("project.target"),
        ProjectPartKind::Group => tr!("project.group"),
    };
    html! {
        <tr data-test="project-part" data-how={how}>
            <td><span class={classes!("state", class)}>{ shape.draw() }<span>{ words }</span></span></td>
            <td>{ what }</td>
            <th scope="row">{ &part.name }</th>
            <td class="mono">{ part.file.clone().unwrap_or_default() }</td>
            <td>{ part.detail.clone().unwrap_or_default() }</td>
        </tr>
    }
}
