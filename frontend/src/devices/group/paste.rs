//! Many variables at once: pasted from a spreadsheet or read from a file, looked at before they are added.

mod preview;

use std::rc::Rc;

use cipdeck_shared::{
    config::{Device, GroupId, Variable},
    plan::plant,
};
use web_sys::HtmlInputElement;
use yew::{platform::spawn_local, prelude::*};

use self::preview::{preview, refused};
use super::{lines::Lines, sheet::Sheet};
use crate::{
    browser,
    devices::{
        answer::problem_note,
        api,
        fields::{Findings, Said, area},
        i18n::tr,
    },
    kit::Dialog,
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
