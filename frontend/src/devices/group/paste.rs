//! Many variables at once: pasted from a spreadsheet or read from a file, looked at before they are added.

use std::rc::Rc;

use cipdeck_shared::{
    config::{Device, GroupId, Variable},
    plan::plant,
};
use web_sys::HtmlInputElement;
use yew::{platform::spawn_local, prelude::*};

use super::{
    lines::Lines,
    sheet::{Column, Sheet, SheetRow, words},
};
use crate::{
    browser,
    devices::{
        answer::problem_note,
        api,
        fields::{Findings, Said, area},
        i18n::tr,
    },
    kit::{Dialog, Shape},
    office::fetch::use_action,
};

#[derive(Clone, PartialEq, Properties)]
pub(super) struct PasteProps {
    pub(super) group: GroupId,
    pub(super) device: Device,
    pub(super) lines: Rc<Lines>,
    pub(super) on_close: Callback<()>,
}

/// A text, and below it what it means.
#[component]
pub(super) fn PasteDialog(props: &PasteProps) -> Html {
    let action = use_action();
    let text = use_state(String::new);
    let sheet =
        use_memo(((*text).clone(), props.lines.clone(), props.device.clone()), |(text, lines, device)| {
            let known: Vec<_> = lines.iter().map(|line| line.address.clone()).collect();
            let there: Vec<Variable> = lines.iter().map(|line| line.variable.clone()).collect();
            let types = plant::device(&device.config).map(|plan| plan.types).unwrap_or_default();
            Sheet::read(text, &known).checked(&there, &types)
        });
    let good = sheet.good();
    let (count, wrong) = (good.len(), sheet.rows.len() - good.len());
    let onsubmit = {
        let (action, group, on_close) = (action.clone(), props.group, props.on_close.clone());
        move |event: SubmitEvent| {
            event.prevent_default();
            let on_close = on_close.clone();
            if !good.is_empty() {
                action.go(api::add_variables(group, good.clone()), move |_| on_close.emit(()));
            }
        }
    };
    let onchange = {
        let text = text.setter();
        move |event: Event| {
            let (text, input) = (text.clone(), event.target_unchecked_into::<HtmlInputElement>());
            spawn_local(async move {
                if let Some(read) = browser::read_file(&input).await {
                    text.set(read);
                }
            });
        }
    };
    let on_text = {
        let text = text.setter();
        Callback::from(move |typed| text.set(typed))
    };
    let findings = Findings::of(action.problem());
    html! {
        <Dialog title={tr!("paste.title")} test="paste-dialog" on_close={props.on_close.clone()}>
            <form {onsubmit} class="wide-form">
                { area("paste-text", tr!("paste.label"), 5, &text, Said::Hint(tr!("paste.hint")), on_text) }
                <div class="entry-line">
                    <label for="paste-file">{ tr!("paste.file") }</label>
                    <input id="paste-file" type="file" accept=".csv,.txt,.tsv,text/csv" {onchange} data-test="paste-file" />
                </div>
                { preview(&sheet) }
                { refused(&sheet, &findings) }
                { problem_note(action.problem().as_ref()) }
                <div class="dialog-buttons">
                    <span class="spring" role="status" data-test="paste-count">
                        if !sheet.rows.is_empty() { { tr!("paste.counts", good = count, wrong = wrong) } }
                    </span>
                    <button type="button" class="button" onclick={props.on_close.reform(|_: MouseEvent| ())}>{ tr!("dialog.cancel") }</button>
                    <button type="submit" class="button primary" disabled={action.is_busy() || count == 0} data-test="paste-do">
                        { if wrong == 0 { tr!("paste.do", count = count) } else { tr!("paste.do_good", count = count) } }
                    </button>
                </div>
            </form>
        </Dialog>
    }
}

/// Lines that are shown: those with something wrong first.
const MOST_SHOWN: usize = 200;

fn preview(sheet: &Sheet) -> Html {
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
fn refused(sheet: &Sheet, findings: &Findings) -> Html {
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
