//! One more device like this one.

use cipdeck_shared::{api::CopyDevice, config::Device};
use yew::prelude::*;

use crate::{
    devices::{
        answer::problem_note,
        api,
        fields::Findings,
        i18n::tr,
        route::{self, Page},
    },
    kit::Dialog,
    office::{check, fetch::use_action, kit::Entry},
};

#[derive(Clone, PartialEq, Properties)]
pub(super) struct CopyDialogProps {
    pub(super) device: Device,
    pub(super) on_close: Callback<()>,
}

/// Asks what the copy is called and where it is; its groups are off.
#[component]
pub(super) fn CopyDialog(props: &CopyDialogProps) -> Html {
    let action = use_action();
    let name = use_state(|| tr!("device.copy_name", name = props.device.config.name).to_string());
    let path = use_state(|| props.device.config.path.clone());
    let tried = use_state(|| false);
    let problems = [check::needed(&name), check::needed(&path)];
    let is_good = problems.iter().all(Option::is_none);
    let onsubmit = {
        let (action, tried, name, path) = (action.clone(), tried.clone(), name.clone(), path.clone());
        let (id, on_close) = (props.device.id, props.on_close.clone());
        move |event: SubmitEvent| {
            event.prevent_default();
            tried.set(true);
            if is_good {
                let copy = CopyDevice { name: name.trim().to_owned(), path: path.trim().to_owned() };
                let on_close = on_close.clone();
                action.go(api::copy_device(id, copy), move |device| {
                    on_close.emit(());
                    route::go(Page::Device(device.id));
                });
            }
        }
    };
    let findings = Findings::of(action.problem());
    let [name_problem, path_problem] = problems.map(|problem| problem.filter(|_| *tried));
    html! {
        <Dialog title={tr!("device.copy_title")} test="copy-dialog" on_close={props.on_close.clone()}>
            <form {onsubmit}>
                <p>{ tr!("device.copy_text") }</p>
                { Entry::text("copy-name", tr!("device.name"), &name).problem(name_problem.or_else(|| findings.at("name"))).draw() }
                { Entry::text("copy-path", tr!("device.path"), &path).hint(tr!("device.path_hint")).problem(path_problem.or_else(|| findings.at("path"))).draw() }
                { findings.elsewhere(&["name", "path"]) }
                { problem_note(action.problem().as_ref()) }
                <div class="dialog-buttons">
                    <button type="button" class="button" onclick={props.on_close.reform(|_: MouseEvent| ())}>{ tr!("dialog.cancel") }</button>
                    <button type="submit" class="button primary" disabled={action.is_busy()} data-test="copy-do">{ tr!("device.copy") }</button>
                </div>
            </form>
        </Dialog>
    }
}
