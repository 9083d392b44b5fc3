//! The head of a block: its name, what can be done with it, and why not.

use std::rc::Rc;

use cipdeck_shared::{api::BlockStatus, plan::Field};
use web_sys::HtmlInputElement;
use yew::prelude::*;

use super::{commands::Commands, subject::Subject};
use crate::{
    demo::Demo,
    editor::{Draft, Edit},
    hooks::use_workbench,
    i18n::tr,
    kit::describes,
};

#[derive(Clone, PartialEq, Properties)]
pub(super) struct HeadProps {
    pub(super) subject: Rc<Subject>,
    pub(super) status: Rc<BlockStatus>,
    pub(super) edit: Callback<Edit>,
}

/// Name, commands, Save and Revert.
#[component]
pub(super) fn Head(props: &HeadProps) -> Html {
    let bench = use_workbench();
    let subject = &props.subject;
    let id = subject.id;
    let remarks = subject.remarks_of(&Field::Name);
    let oninput = use_callback(props.edit.clone(), |event: InputEvent, edit| {
        let text = event.target_unchecked_into::<HtmlInputElement>().value();
        edit.emit(Edit::Text(Field::Name, text));
    });
    let on_save = use_callback((bench.clone(), id), |_: MouseEvent, (bench, id)| bench.save(*id));
    let on_revert = use_callback((bench, id), |_: MouseEvent, (bench, id)| bench.revert(*id));
    let no_save = subject.no_save();
    let can_save = subject.can_save();
    let can_revert = subject.unsaved && id.stored().is_some();
    let save_title = no_save.unwrap_or(tr!("save.title"));
    html! {
        <header class="head">
            <div class="head-name">
                <label class="unseen" for="field-name">{ tr!("field.name") }</label>
                <input
                    id="field-name" name="name" class="input name" value={subject.draft.config.name.clone()} {oninput}
                    aria-describedby={describes("field-name", &remarks, None)} autocomplete="off" spellcheck="false"
                />
                if !remarks.is_empty() {
                    <div id="field-name-finding">
                        { for remarks.iter().map(|remark| html! { <p class="finding error" role="alert">{ &remark.text }</p> }) }
                    </div>
                }
                <span class="saved" data-test="saved" data-unsaved={subject.unsaved.to_string()}>
                    { if subject.unsaved { tr!("save.unsaved") } else { tr!("save.saved", revision = subject.revision) } }
                </span>
                if can_revert {
                    <button type="button" class="quiet-button" onclick={on_revert} data-test="revert">{ tr!("save.revert") }</button>
                }
                <button type="button" class="button" disabled={!can_save} title={save_title} onclick={on_save} data-test="save">
                    { tr!("save.do") }
                </button>
            </div>
            <Commands<Draft, Demo> block={subject.commanded()} status={props.status.clone()} />
        </header>
    }
}
