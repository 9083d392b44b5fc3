//! What people enter about a variable: one by itself, a structure before its members, an array before its elements.

use std::rc::Rc;

use cipdeck_shared::config::{Device, GroupId, NewVariable, Variable, VariableId, join_address};
use yew::prelude::*;

use super::{asked::Asked, draft::VariableDraft, lines::Lines};
use crate::{
    devices::{answer::problem_note, api, fields::Findings, i18n::tr, live::use_value},
    kit::Dialog,
    office::fetch::use_action,
};

mod fields;
mod shape;

use self::{
    fields::{Fields, fields},
    shape::{Shape, chooser},
};

#[derive(Clone, PartialEq, Properties)]
pub(super) struct VariableDialogProps {
    pub(super) group: GroupId,
    pub(super) device: Device,
    pub(super) lines: Rc<Lines>,
    /// The one that is changed; without it a new one is made.
    #[prop_or_default]
    pub(super) stored: Option<Variable>,
    /// What it is a part of.
    pub(super) parent: Option<VariableId>,
    pub(super) ask: Callback<Asked>,
    pub(super) on_close: Callback<()>,
}

/// The form. After a structure or an array it asks for the first part.
#[component]
pub(super) fn VariableDialog(props: &VariableDialogProps) -> Html {
    let action = use_action();
    let begin = || props.stored.as_ref().map(|it| VariableDraft::of(&it.config)).unwrap_or_default();
    let draft = use_state(begin);
    let (parent, shape) = (use_state(|| props.parent), use_state(|| Shape::Plain));
    let (tried, added) = (use_state(|| false), use_state(|| None::<String>));
    let own = use_value(props.stored.as_ref().map_or(VariableId(u32::MAX), |stored| stored.id));
    let read = draft.read(*parent);
    let wrong = read.as_ref().err().filter(|_| *tried).cloned().unwrap_or_default();
    let above = parent.and_then(|id| props.lines.line(id)).map(|line| line.address.clone());
    let address = join_address(above.as_deref().unwrap_or_default(), &draft.address);
    let submit = {
        let (action, tried, props) = (action.clone(), tried.clone(), props.clone());
        let (draft, shape, added, address) = (draft.clone(), shape.clone(), added.clone(), address.clone());
        Callback::from(move |again: bool| {
            tried.set(true);
            let Ok(config) = &read else { return };
            let on_close = props.on_close.clone();
            if let Some(stored) = &props.stored {
                let change = api::change_variable(Variable { config: config.clone(), ..stored.clone() });
                action.go(change, move |_| on_close.emit(()));
                return;
            }
            let new = NewVariable { parent_address: None, config: config.clone() };
            let (draft, tried, added, address) =
                (draft.clone(), tried.clone(), added.clone(), address.clone());
            let goes_on = again || *shape != Shape::Plain;
            let (ask, shape) = (props.ask.clone(), *shape);
            action.go(api::add_variables(props.group, vec![new]), move |made| {
                let parent = made.first().map(|variable| variable.id);
                match (goes_on, shape) {
                    (false, _) => on_close.emit(()),
                    (true, Shape::Plain) => {
                        draft.set(VariableDraft::default());
                        tried.set(false);
                        added.set(Some(address));
                    }
                    (true, _) => ask.emit(Asked::Add(parent)),
                }
            });
        })
    };
    let onsubmit = {
        let submit = submit.clone();
        move |event: SubmitEvent| {
            event.prevent_default();
            submit.emit(false);
        }
    };
    let findings = Findings::of(action.problem());
    let title = match (&props.stored, *parent) {
        (Some(stored), _) => tr!("variable.change_title", name = stored.config.name),
        (None, None) => tr!("variable.add_title"),
        (None, Some(_)) => tr!("variable.add_part", parent = above.as_deref().unwrap_or_default()),
    };
    let is_new = props.stored.is_none();
    html! {
        <Dialog {title} test="variable-dialog" on_close={props.on_close.clone()}>
            <form {onsubmit} class="grid-form">
                if is_new {
                    { chooser(&shape) }
                }
                { fields(&Fields { draft: &draft, parent: &parent, shape: *shape, wrong: &wrong, findings: &findings, props, address: &address, own: own.as_deref() }) }
                if let Some(added) = &*added {
                    <p class="made" role="status" data-test="added">{ tr!("variable.added", address = added) }</p>
                }
                { problem_note(action.problem().as_ref()) }
                { buttons(props, *shape, action.is_busy(), &submit) }
            </form>
        </Dialog>
    }
}

fn buttons(props: &VariableDialogProps, shape: Shape, busy: bool, submit: &Callback<bool>) -> Html {
    let cancel = props.on_close.reform(|_: MouseEvent| ());
    let again = submit.reform(|_: MouseEvent| true);
    let words = match (&props.stored, shape) {
        (Some(_), _) => tr!("form.store"),
        (None, Shape::Plain) => tr!("variable.add"),
        (None, Shape::Structure) => tr!("variable.add_then_member"),
        (None, Shape::Array) => tr!("variable.add_then_element"),
    };
    html! {
        <div class="dialog-buttons">
            if let Some(stored) = &props.stored {
                <button type="button" class="button" onclick={props.ask.reform({ let id = stored.id; move |_: MouseEvent| Asked::Add(Some(id)) })} data-test="add-part">{ tr!("variable.add_part_do") }</button>
                <button type="button" class="button" onclick={props.ask.reform({ let id = stored.id; move |_: MouseEvent| Asked::Remove(id) })} data-test="delete-variable">{ tr!("variable.delete") }</button>
                <span class="spring" />
            }
            <button type="button" class="button" onclick={cancel} data-test="close">{ if props.stored.is_some() { tr!("dialog.cancel") } else { tr!("dialog.close") } }</button>
            if props.stored.is_none() && shape == Shape::Plain {
                <button type="button" class="button" onclick={again} disabled={busy} data-test="add-next">{ tr!("variable.add_next") }</button>
            }
            <button type="submit" class="button primary" disabled={busy} data-test="store-variable">{ words }</button>
        </div>
    }
}
