//! The variables, live, in a windowed table.

use std::rc::Rc;

use cipdeck_shared::{api::Quality, config::VariableId};
use yew::prelude::*;

use super::{
    lines::Lines,
    row::{Common, VariableRow},
};
use crate::{
    browser,
    devices::{
        i18n::tr,
        live::{use_frames, use_plant},
    },
    kit::WindowTable,
};

#[derive(Clone, PartialEq, Properties)]
pub(super) struct VariablesProps {
    pub(super) lines: Rc<Lines>,
    pub(super) common: Common,
    pub(super) filter: AttrValue,
}

/// Height of a row in px; the style sheet has to agree.
const ROW_HEIGHT: u32 = 32;

/// Summary and table.
#[component]
pub(super) fn Variables(props: &VariablesProps) -> Html {
    let ids = use_memo((props.lines.clone(), props.filter.clone()), |(lines, filter)| found(lines, filter));
    let row = use_callback(
        (props.lines.clone(), props.common.clone()),
        |(index, id): (usize, VariableId), (lines, common)| {
            let line = lines.line(id).cloned();
            line.map_or_else(Html::default, |line| {
                html! { <VariableRow key={id.to_string()} {index} {line} common={common.clone()} /> }
            })
        },
    );
    let heading = |class: &'static str, words: AttrValue| html! { <th scope="col" {class}>{ words }</th> };
    let header = html! { <>
        { heading("col-quality", tr!("row.quality")) }
        { heading("col-variable", tr!("variable.name")) }
        { heading("col-number", tr!("row.value")) }
        { heading("col-unit", tr!("variable.unit")) }
        <th scope="col" class="col-low" title={tr!("row.low_title")}>{ tr!("row.low") }</th>
        <th scope="col" class="col-high" title={tr!("row.high_title")}>{ tr!("row.high") }</th>
        { heading("col-age", tr!("row.age")) }
        { heading("col-type", tr!("variable.type")) }
        { heading("col-address", tr!("variable.address")) }
        { heading("col-trend", tr!("row.trend")) }
        <th scope="col" class="col-do"><span class="unseen">{ tr!("row.do") }</span></th>
    </> };
    html! { <>
        <Summary lines={props.lines.clone()} on={props.common.on} />
        if ids.is_empty() {
            <p class="empty">{ tr!("group.nothing") }</p>
        } else {
            <WindowTable<VariableId> label={tr!("group.label")} ids={(*ids).clone()} row_height={ROW_HEIGHT} {header} {row} />
        }
    </> }
}

/// Those whose name or address contains the text.
fn found(lines: &Lines, filter: &str) -> Rc<[VariableId]> {
    if filter.trim().is_empty() {
        return lines.ids.clone();
    }
    let is_found = |id: &VariableId| {
        lines.line(*id).is_some_and(|line| {
            browser::contains(&line.variable.config.name, filter) || browser::contains(&line.address, filter)
        })
    };
    lines.ids.iter().copied().filter(is_found).collect()
}

#[derive(Clone, PartialEq, Properties)]
struct SummaryProps {
    lines: Rc<Lines>,
    on: bool,
}

/// `51 variables: 49 good, 1 stale, 1 bad`: counted anew every second, and not read out each time.
#[component]
fn Summary(props: &SummaryProps) -> Html {
    let plant = use_plant();
    use_frames(1_000, !props.on);
    let count = props.lines.ids.len();
    let mut of = [0_usize; 4];
    for line in props.lines.iter() {
        let quality =
            plant.values().value(line.variable.id).map_or(Quality::Waiting, |shown| shown.value.quality);
        if let Some(counted) =
            Quality::ALL.iter().position(|it| *it == quality).and_then(|place| of.get_mut(place))
        {
            *counted += 1;
        }
    }
    let [waiting, good, stale, bad] = of;
    let words = match (props.on, plant.is_live()) {
        (false, _) => tr!("group.is_off", count = count),
        (true, false) => tr!("group.not_live", count = count),
        (true, true) => {
            tr!("group.counts", count = count, good = good, stale = stale, bad = bad, waiting = waiting)
        }
    };
    html! { <p class="summary" data-test="summary">{ words }</p> }
}
