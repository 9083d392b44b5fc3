//! What a pasted text means, line by line.

use yew::prelude::*;

use super::super::sheet::{Column, Sheet, SheetRow, words};
use crate::{
    devices::{fields::Findings, i18n::tr},
    kit::Shape,
};

/// Lines that are shown: those with something wrong first.
const MOST_SHOWN: usize = 200;

pub(super) fn preview(sheet: &Sheet) -> Html {
    if sheet.rows.is_empty() {
        return html! {};
    }
    let heading = |column: &Column| match column {
        Column::Member(name) => html! { <th scope="col">{ *name }</th> },
        Column::Unknown(name) => {
            html! { <th scope="col" class="ignored" title={tr!("paste.ignored")}>{ name }</th> }
        }
    };
    let (wrong, good): (Vec<_>, Vec<_>) = sheet.rows.iter().partition(|row| row.variable.is_none());
    let left = sheet.rows.len().saturating_sub(MOST_SHOWN);
    html! {
        <div class="scroll preview" tabindex="0" role="region" aria-label={tr!("paste.preview")}>
            <table class="listing" aria-label={tr!("paste.preview")} data-test="preview">
                <thead><tr><th scope="col" class="num">{ tr!("paste.line") }</th>{ for sheet.columns.iter().map(heading) }<th scope="col">{ tr!("paste.verdict") }</th></tr></thead>
                <tbody>{ for wrong.into_iter().chain(good).take(MOST_SHOWN).map(|row| line(row, sheet.columns.len())) }</tbody>
            </table>
            if left > 0 {
                <p class="hint">{ tr!("paste.left", count = left) }</p>
            }
        </div>
    }
}

fn line(row: &SheetRow, columns: usize) -> Html {
    let cell = |place: usize| html! { <td>{ row.cells.get(place).cloned().unwrap_or_default() }</td> };
    let is_wrong = row.variable.is_none();
    html! {
        <tr key={row.number} class={is_wrong.then_some("wrong")} data-test={if is_wrong { "preview-wrong" } else { "preview-good" }}>
            <td class="num">{ row.number }</td>
            { for (0..columns).map(cell) }
            <td>
                if is_wrong {
                    <span class="state cross">{ Shape::Cross.draw() }<span>{ words(&row.wrong) }</span></span>
                } else {
                    <span class="state tick">{ Shape::Tick.draw() }<span>{ tr!("paste.good") }</span></span>
                }
            </td>
        </tr>
    }
}

/// What only the relay has found, with the number of the line: it counts what it was sent.
pub(super) fn refused(sheet: &Sheet, findings: &Findings) -> Html {
    let sent: Vec<_> = sheet.rows.iter().filter(|row| row.variable.is_some()).map(|row| row.number).collect();
    let place = |field: &str| {
        let (index, member) = field.strip_prefix("variables[")?.split_once("].")?;
        let number = sent.get(index.parse::<usize>().ok()?)?;
        Some(tr!("paste.line_of", line = number, field = member).to_string())
    };
    html! { <>{ for findings.all().map(|(field, words)| {
        let field = place(&field).unwrap_or(field);
        html! { <p class="finding error" role="alert" data-test="paste-finding">{ tr!("finding_at", field = field, words = words) }</p> }
    }) }</> }
}
