//! The head of a block: its name, what it is, and what can be done with it.

use std::rc::Rc;

use cipdeck_shared::{api::BlockStatus, plan::Field};
use web_sys::HtmlInputElement;
use yew::prelude::*;

use super::subject::Subject;
use crate::{
    kit::{Dialog, describes},
    pages::block::Commands,
    words::{
        edit::{Draft, Edit},
        hooks::use_desk,
        i18n::tr,
        route::{self, Page, link},
    },
};

#[derive(Clone, PartialEq, Properties)]
pub(super) struct HeadProps {
    pub(super) subject: Rc<Subject>,
    pub(super) status: Rc<BlockStatus>,
    pub(super) edit: Callback<Edit>,
}

/// The way back, name, form, tools, commands.
#[component]
pub(super) fn Head(props: &HeadProps) -> Html {
    let subject = &props.subject;
    let remarks = subject.remarks_of("name");
    let oninput = use_callback(props.edit.clone(), |event: InputEvent, edit| {
        let text = event.target_unchecked_into::<HtmlInputElement>().value();
        edit.emit(Edit::Text(Field::Name, text));
    });
    html! {
        <header class="head">
            <div class="head-name">
                { link(Page::All, "back", html! { <>{ "‹ " }{ tr!("block.back") }</> }) }
                <label class="unseen" for="field-name">{ tr!("field.name") }</label>
                <input
                    id="field-name" name="name" class="input name" value={subject.draft.config.name.clone()} {oninput}
                    readonly={!subject.may_edit}
                    aria-describedby={describes("field-name", &remarks, None)} autocomplete="off" spellcheck="false"
                />
                <span class="form-name" data-test="form-name">{ subject.draft.config.form().to_string() }</span>
                if !remarks.is_empty() {
                    <div id="field-name-finding">
                        { for remarks.iter().map(|remark| html! { <p class="finding error" role="alert">{ &remark.text }</p> }) }
                    </div>
                }
                <Tools subject={subject.clone()} />
            </div>
            <Commands<Draft, ()> block={subject.commanded()} status={props.status.clone()} />
        </header>
    }
}

#[derive(Clone, PartialEq, Properties)]
struct ToolsProps {
    subject: Rc<Subject>,
}

/// Save, discard, duplicate, delete, and the ways to other documents.
#[component]
fn Tools(props: &ToolsProps) -> Html {
    let desk = use_desk();
    let subject = &props.subject;
    let id = subject.id;
    let deleting = use_state(|| false);
    let on_save = use_callback((desk.clone(), id), |_: MouseEvent, (desk, id)| desk.save(*id));
    let on_revert = use_callback((desk.clone(), id), |_: MouseEvent, (desk, id)| desk.revert(*id));
    let on_duplicate = use_callback((desk.clone(), id), |_: MouseEvent, (desk, id)| {
        if let Some(draft) = desk.draft(*id) {
            route::go(Page::Block(desk.add(draft.config)));
        }
    });
    let on_ask = use_callback(deleting.clone(), |_: MouseEvent, deleting| deleting.set(true));
    let on_close = use_callback(deleting.clone(), |(), deleting| deleting.set(false));
    let no_save = subject.no_save();
    let can_save = subject.can_save();
    let locked = !subject.may_edit;
    let lock = locked.then_some(tr!("may.not_edit"));
    let name = subject.draft.config.name.clone();
    let on_delete = {
        let deleting = deleting.clone();
        move |event: SubmitEvent| {
            event.prevent_default();
            deleting.set(false);
            desk.delete(id);
        }
    };
    html! { <>
        <span class="saved" data-test="saved" data-unsaved={subject.unsaved.to_string()}>
            { if subject.unsaved { tr!("save.unsaved") } else { tr!("save.saved", revision = subject.revision) } }
        </span>
        <button type="button" class="button" disabled={!can_save} title={no_save.unwrap_or(tr!("save.title"))} onclick={on_save} data-test="save">
            { tr!("save.do") }
        </button>
        if subject.unsaved && id.stored().is_some() {
            <button type="button" class="tool" onclick={on_revert} data-test="revert">{ tr!("save.revert") }</button>
        }
        <button type="button" class="tool" disabled={locked} title={lock.clone()} onclick={on_duplicate} data-test="duplicate">{ tr!("list.duplicate") }</button>
        <button type="button" class="tool" disabled={locked} title={lock} onclick={on_ask} data-test="delete">{ tr!("list.delete") }</button>
        if let Some(stored) = id.stored() {
            <a class="tool" href={format!("/code/{stored}")} data-test="to-code">{ tr!("block.as_code") }</a>
        }
        if *deleting {
            <Dialog title={tr!("delete.title")} test="delete-dialog" on_close={on_close.clone()}>
                <form onsubmit={on_delete}>
                    <p>{ tr!("delete.text", name = name) }</p>
                    <div class="dialog-buttons">
                        <button type="button" class="button" autofocus=true onclick={on_close.reform(|_: MouseEvent| ())}>{ tr!("dialog.cancel") }</button>
                        <button type="submit" class="button danger" data-test="delete-confirm">{ tr!("delete.do") }</button>
                    </div>
                </form>
            </Dialog>
        }
    </> }
}
