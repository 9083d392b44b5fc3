//! The dialog that is open.

use std::rc::Rc;

use cipdeck_shared::config::{Device, Group, VariableId};
use yew::prelude::*;

use super::{
    asked::Asked, browse::BrowseDialog, form::VariableDialog, lines::Lines, paste::PasteDialog,
    settings::SettingsDialog,
};
use crate::{
    devices::{
        i18n::tr,
        route::{self, Page},
        write::WriteDialog,
    },
    office::kit::Confirm,
};

/// The dialog for a wish; `close` is called when it is done, or is not wanted any more.
pub(super) fn dialog(
    asked: Asked,
    group: &Group,
    device: &Device,
    lines: &Rc<Lines>,
    ask: &Callback<Asked>,
    close: &Callback<()>,
) -> Option<Html> {
    let on_close = close.clone();
    let line = |id: VariableId| lines.line(id).cloned();
    Some(match asked {
        Asked::Add(parent) => html! {
            <VariableDialog
                key={format!("add-{parent:?}")} group={group.id} device={device.clone()} lines={lines.clone()} {parent} ask={ask.clone()} {on_close}
            />
        },
        Asked::Change(id) => {
            let line = line(id)?;
            html! {
                <VariableDialog
                    key={id.to_string()} group={group.id} device={device.clone()} lines={lines.clone()}
                    stored={Some(line.variable.clone())} parent={line.variable.config.parent} ask={ask.clone()} {on_close}
                />
            }
        }
        Asked::Write(id) => {
            let line = line(id)?;
            html! { <WriteDialog variable={line.variable.clone()} address={line.address.clone()} device={device.clone()} {on_close} /> }
        }
        Asked::Paste => {
            html! { <PasteDialog group={group.id} device={device.clone()} lines={lines.clone()} {on_close} /> }
        }
        Asked::Browse => {
            html! { <BrowseDialog device={device.clone()} group={group.id} lines={lines.clone()} {on_close} /> }
        }
        Asked::Settings => html! { <SettingsDialog group={group.clone()} {on_close} /> },
        Asked::Delete => {
            let (id, close) = (group.config.device, close.clone());
            let on_close = Callback::from(move |gone: bool| {
                close.emit(());
                if gone {
                    route::go(Page::Device(id));
                }
            });
            html! {
                <Confirm
                    title={tr!("group.delete_title")} text={tr!("group.delete_text", name = group.config.name, count = lines.ids.len())}
                    answer={tr!("group.delete")} resource={format!("groups/{}?revision={}", group.id, group.revision)} {on_close}
                />
            }
        }
        Asked::Remove(id) => {
            let line = line(id)?;
            let text = if line.has_parts {
                tr!("variable.delete_parts", name = line.variable.config.name)
            } else {
                tr!("variable.delete_text", name = line.variable.config.name)
            };
            html! {
                <Confirm
                    title={tr!("variable.delete_title")} {text} answer={tr!("variable.delete")}
                    resource={format!("variables/{id}?revision={}", line.variable.revision)} on_close={close.reform(|_: bool| ())}
                />
            }
        }
        Asked::Trace(_) => return None,
    })
}
