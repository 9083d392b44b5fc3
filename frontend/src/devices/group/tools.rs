//! What is done with all variables of a group.

use cipdeck_shared::config::Group;
use web_sys::HtmlInputElement;
use yew::prelude::*;

use super::{asked::Asked, lines::Lines, row::Common};
use crate::{
    devices::{i18n::tr, live::Plant},
    net::rest,
};

/// Add, paste, browse, take along, count anew, filter.
pub(super) fn tools(
    group: &Group,
    lines: &Lines,
    common: &Common,
    filter: &UseStateHandle<String>,
    plant: &Plant,
) -> Html {
    let wish = |asked: Asked| common.ask.reform(move |_: MouseEvent| asked);
    let oninput = {
        let filter = filter.clone();
        move |event: InputEvent| filter.set(event.target_unchecked_into::<HtmlInputElement>().value())
    };
    let reset = {
        let (plant, id) = (plant.clone(), group.id);
        move |_: MouseEvent| plant.values().reset_ranges(id)
    };
    let csv = rest::address(&format!("groups/{}/variables.csv", group.id));
    html! {
        <div class="group-tools">
            if common.may_edit {
                <button type="button" class="button primary" onclick={wish(Asked::Add(None))} data-test="add-variable">{ tr!("tools.add") }</button>
                <button type="button" class="button" onclick={wish(Asked::Paste)} data-test="paste">{ tr!("tools.paste") }</button>
                <button type="button" class="button" onclick={wish(Asked::Browse)} data-test="browse">{ tr!("tools.browse") }</button>
            }
            if !lines.ids.is_empty() {
                <a class="tool" href={csv} download={format!("{}.csv", group.config.name)} data-test="export">{ tr!("tools.export") }</a>
                <button type="button" class="tool" onclick={reset} title={tr!("tools.reset_title")} data-test="reset-ranges">{ tr!("tools.reset") }</button>
                <input
                    class="input filter" type="search" placeholder={tr!("tree.filter_short")} aria-label={tr!("tools.filter")}
                    value={(**filter).clone()} {oninput} data-test="variable-filter"
                />
            }
        </div>
    }
}
