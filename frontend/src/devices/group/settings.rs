//! What people enter about a group.

use cipdeck_shared::config::{Group, GroupConfig};
use yew::prelude::*;

use crate::{
    devices::{answer::problem_note, api, fields::Findings, i18n::tr},
    kit::Dialog,
    office::{check, fetch::use_action, kit::Entry},
};

#[derive(Clone, PartialEq, Properties)]
pub(super) struct SettingsProps {
    pub(super) group: Group,
    pub(super) on_close: Callback<()>,
}

/// Name, period, place.
#[component]
pub(super) fn SettingsDialog(props: &SettingsProps) -> Html {
    let action = use_action();
    let config = &props.group.config;
    let name = use_state(|| config.name.clone());
    let period = use_state(|| config.period_ms.to_string());
    let order = use_state(|| config.order.to_string());
    let named = check::needed(&name);
    let wanted = check::number(&period, 10, 3_600_000);
    let place = order.trim().parse::<i64>().map_err(|_| tr!("variable.no_number", text = order.trim()));
    let onsubmit = {
        let (action, group, on_close) = (action.clone(), props.group.clone(), props.on_close.clone());
        let (name, wanted, place, is_named) = (name.clone(), wanted.clone(), place.clone(), named.is_none());
        move |event: SubmitEvent| {
            event.prevent_default();
            if let (true, Ok(period), Ok(order)) = (is_named, &wanted, &place) {
                let config = GroupConfig {
                    name: name.trim().to_owned(),
                    period_ms: i64::from(*period),
                    order: *order,
                    ..group.config.clone()
                };
                let on_close = on_close.clone();
                action.go(api::change_group(Group { config, ..group.clone() }), move |_| on_close.emit(()));
            }
        }
    };
    let findings = Findings::of(action.problem());
    html! {
        <Dialog title={tr!("group.settings")} test="group-dialog" on_close={props.on_close.clone()}>
            <form {onsubmit}>
                { Entry::text("group-name", tr!("group.name"), &name).problem(named.or_else(|| findings.at("name"))).draw() }
                { Entry::text("group-period", tr!("groups.new_period"), &period).problem(wanted.err().or_else(|| findings.at("period_ms"))).hint(tr!("group.period_hint")).draw() }
                { Entry::text("group-order", tr!("group.order"), &order).problem(place.err().or_else(|| findings.at("order"))).hint(tr!("group.order_hint")).draw() }
                { findings.elsewhere(&["name", "period_ms", "order"]) }
                { problem_note(action.problem().as_ref()) }
                <div class="dialog-buttons">
                    <button type="button" class="button" onclick={props.on_close.reform(|_: MouseEvent| ())}>{ tr!("dialog.cancel") }</button>
                    <button type="submit" class="button primary" disabled={action.is_busy()} data-test="store-group">{ tr!("form.store") }</button>
                </div>
            </form>
        </Dialog>
    }
}
