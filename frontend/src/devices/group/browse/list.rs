//! What was found, in a windowed table: a controller has thousands of names.

use std::rc::Rc;

use yew::prelude::*;

use super::{Found, Ticked};
use crate::{devices::i18n::tr, kit::WindowTable};

#[derive(Clone, PartialEq, Properties)]
pub(super) struct FoundListProps {
    pub(super) found: Rc<Vec<Rc<Found>>>,
    pub(super) ticked: Ticked,
    /// Addresses that the group has already.
    pub(super) known: Rc<[String]>,
    pub(super) toggle: Callback<String>,
    pub(super) members: Callback<(String, String)>,
}

/// Height of a row in px; the style sheet has to agree.
const ROW_HEIGHT: u32 = 32;

/// A box to tick, name, type, access.
#[component]
pub(super) fn FoundList(props: &FoundListProps) -> Html {
    let ids: Rc<[usize]> = (0..props.found.len()).collect();
    let row = use_callback(props.clone(), |(index, place): (usize, usize), props| {
        props.found.get(place).map_or_else(Html::default, |found| line(index, found, props))
    });
    let header = html! { <>
        <th scope="col" class="col-tick"><span class="unseen">{ tr!("browse.tick") }</span></th>
        <th scope="col">{ tr!("variable.address") }</th>
        <th scope="col">{ tr!("variable.type") }</th>
        <th scope="col" class="col-access">{ tr!("browse.access") }</th>
    </> };
    html! {
        <div class="browse-list">
            <WindowTable<usize> label={tr!("browse.label")} {ids} row_height={ROW_HEIGHT} {header} {row} />
        </div>
    }
}

fn line(index: usize, found: &Rc<Found>, props: &FoundListProps) -> Html {
    let is_known = props.known.contains(&found.address);
    let is_ticked = props.ticked.get(&found.address).is_some();
    let address = found.address.clone();
    let onchange = props.toggle.reform(move |_: Event| address.clone());
    let remark = found.symbol.note.clone();
    let opens = found.symbol.structure.clone().map(|of| (found.address.clone(), of));
    html! {
        <tr key={found.address.clone()} aria-rowindex={index.to_string()} data-test="symbol" data-name={found.address.clone()}>
            <td class="col-tick">
                <input type="checkbox" class="check" checked={is_ticked || is_known} disabled={is_known} aria-label={found.address.clone()} {onchange} />
            </td>
            <th scope="row" class={classes!("mono", format!("depth-{}", found.depth.min(6)))} title={found.address.clone()}>{ &found.symbol.name }</th>
            <td class="mono" title={remark.clone()}>
                { &found.symbol.kind }
                if let Some(opens) = opens {
                    <button type="button" class="tool" aria-expanded={if found.is_open { "true" } else { "false" }} onclick={props.members.reform(move |_: MouseEvent| opens.clone())}>
                        { if found.is_open { tr!("browse.hide") } else { tr!("browse.show") } }
                    </button>
                }
            </td>
            <td class="col-access">{ if is_known { tr!("browse.known") } else { found.symbol.access.clone().or(remark).unwrap_or_default().into() } }</td>
        </tr>
    }
}
