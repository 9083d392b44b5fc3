//! One variable on one line. It knows its id; its value comes from the store.

use std::rc::Rc;

use cipdeck_shared::{
    api::Quality,
    config::{VariableConfig, VariableId},
};
use yew::prelude::*;

use super::{asked::Asked, lines::Line};
use crate::{
    browser,
    devices::{
        i18n::tr,
        live::{Shown, use_value},
        quality::Mark,
    },
    hooks::use_second,
    kit::short,
    pages::block::age_words,
};

/// What all rows have in common.
#[derive(Clone, PartialEq)]
#[expect(clippy::struct_excessive_bools, reason = "each is independent of the others")]
pub(super) struct Common {
    /// The group is read.
    pub(super) on: bool,
    /// What is shown is what is.
    pub(super) live: bool,
    /// Variables may be changed.
    pub(super) may_edit: bool,
    /// Values may be changed.
    pub(super) may_write: bool,
    /// Those whose numbers are drawn.
    pub(super) traced: Rc<[VariableId]>,
    /// Hears what somebody wants to do.
    pub(super) ask: Callback<Asked>,
}

#[derive(Clone, PartialEq, Properties)]
pub(super) struct RowProps {
    /// `aria-rowindex`
    pub(super) index: usize,
    pub(super) line: Rc<Line>,
    pub(super) common: Common,
}

/// Quality, name, value, unit, range, age, type, address, and what can be done.
#[component]
pub(super) fn VariableRow(props: &RowProps) -> Html {
    let RowProps { index, line, common } = props;
    let (id, config) = (line.variable.id, &line.variable.config);
    let shown = use_value(id);
    use_second(shown.as_ref().is_some_and(|shown| shown.value.age_ms.is_some()));
    let quality = shown.as_ref().map(|shown| shown.value.quality);
    let mark = match quality {
        _ if !common.on => Mark::Off,
        None => Mark::Of(Quality::Waiting),
        Some(Quality::Good) if !common.live => Mark::Of(Quality::Stale),
        Some(quality) => Mark::Of(quality),
    };
    let is_old = mark != Mark::Of(Quality::Good);
    let value = shown.as_ref().map(|shown| without_unit(&shown.value.text, &config.unit)).unwrap_or_default();
    let reason = shown.as_ref().and_then(|shown| shown.value.reason.clone());
    let range = shown.as_ref().and_then(|shown| shown.range);
    let kind = shown.as_ref().map(|shown| shown.value.kind.clone()).filter(|kind| !kind.is_empty());
    let is_traced = common.traced.contains(&id);
    let ask = |asked: Asked| common.ask.reform(move |_: MouseEvent| asked);
    let trace = common.ask.reform(move |_: Event| Asked::Trace(id));
    html! {
        <tr aria-rowindex={index.to_string()} data-test="variable" data-variable={id.to_string()} data-name={config.name.clone()} data-quality={quality.filter(|_| common.live).map(Quality::word)}>
            <td class="col-quality">{ mark.draw() }</td>
            <th scope="row" class={classes!("col-variable", format!("depth-{}", line.depth.min(6)))} title={config.name.clone()}>
                if common.may_edit {
                    <button type="button" class="row-name" onclick={ask(Asked::Change(id))} title={tr!("row.change")}>{ &config.name }</button>
                } else {
                    { &config.name }
                }
            </th>
            { cells(value, config, range, reason.filter(|_| common.on), is_old) }
            <td class="col-age">{ shown.as_deref().and_then(age).map(age_words) }</td>
            <td class="col-type mono" title={kind.clone()}>{ kind.unwrap_or_else(|| config.kind.clone()) }</td>
            <td class="col-address mono" title={line.address.clone()}>{ &line.address }</td>
            <td class="col-trend">
                <input type="checkbox" class="check" checked={is_traced} onchange={trace} title={tr!("row.trace_title")} aria-label={tr!("row.trace", name = config.name)} />
            </td>
            <td class="col-do">
                if config.writable && common.may_write {
                    <button type="button" class="tool" onclick={ask(Asked::Write(id))} aria-label={tr!("row.write_label", name = config.name)} data-test="write">{ tr!("row.write") }</button>
                }
            </td>
        </tr>
    }
}

/// Value, unit and range; a reason takes the place of what is missing.
fn cells(
    value: &str,
    config: &VariableConfig,
    range: Option<(f64, f64)>,
    reason: Option<String>,
    is_old: bool,
) -> Html {
    if let Some(reason) = reason.clone().filter(|_| value.is_empty()) {
        return html! { <>
            <td class="col-reason" colspan="2" title={reason.clone()} data-test="reason"><span>{ reason }</span></td>
            <td class="col-low" /><td class="col-high" />
        </> };
    }
    html! { <>
        <td class={classes!("col-number", is_old.then_some("stale"))} title={value.to_owned()} data-test="value">{ value }</td>
        <td class="col-unit">{ &config.unit }</td>
        if let Some(reason) = reason {
            <td class="col-low col-reason" colspan="2" title={reason.clone()} data-test="reason"><span>{ reason }</span></td>
        } else {
            <td class="col-low">{ range.map(|(low, _)| short(low)) }</td>
            <td class="col-high">{ range.map(|(_, high)| short(high)) }</td>
        }
    </> }
}

/// Seconds since the value was read.
fn age(shown: &Shown) -> Option<f64> {
    #[expect(clippy::cast_precision_loss, reason = "an age")]
    let before = shown.value.age_ms? as f64;
    Some((before + (browser::now_ms() - shown.heard_ms)).max(0.0) / 1_000.0)
}

/// The unit has a column of its own.
fn without_unit<'a>(text: &'a str, unit: &str) -> &'a str {
    if unit.is_empty() {
        return text;
    }
    text.strip_suffix(unit).map_or(text, str::trim_end)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_unit_is_shown_once() {
        assert_eq!(without_unit("21.5 °C", "°C"), "21.5");
        assert_eq!(without_unit("21.5", "°C"), "21.5");
        assert_eq!(without_unit("running", ""), "running");
    }
}
