//! A group: its variables as a live table, and everything that is done with them.

mod asked;
mod browse;
mod dialogs;
mod draft;
mod form;
mod head;
mod lines;
mod paste;
mod row;
mod settings;
mod sheet;
mod table;
mod tools;

use std::rc::Rc;

use cipdeck_shared::{
    api::Role,
    config::{GroupId, Variable, VariableId},
};
use yew::prelude::*;

use self::{
    asked::Asked, dialogs::dialog, head::Head, lines::Lines, row::Common, table::Variables, tools::tools,
};
use super::{
    i18n::tr,
    live::{use_plant, use_tree, use_watched},
    trend::TrendPanel,
};
use crate::{
    hooks::{use_session, use_title},
    net::session,
    office::{
        fetch::use_fetched,
        kit::{note, waiting},
    },
    pages::connection::stale_note,
};

#[derive(Clone, PartialEq, Properties)]
pub(super) struct GroupPageProps {
    pub(super) id: GroupId,
}

/// Head, tools, table, trend, and the dialog that is open.
#[component]
pub(super) fn GroupPage(props: &GroupPageProps) -> Html {
    let plant = use_plant();
    let tree = use_tree();
    use_session();
    use_watched(props.id);
    let fetched = use_fetched::<Vec<Variable>>(format!("groups/{}/variables", props.id));
    use_effect_with((plant.edition(props.id), plant.is_live()), {
        let reload = fetched.reload.clone();
        move |(edition, live)| {
            // The first answer is under way already.
            if *edition > 0 && *live {
                reload.emit(());
            }
        }
    });
    let lines =
        use_memo(fetched.data.clone(), |data| data.as_ref().map(|all| Lines::of(all)).unwrap_or_default());
    let filter = use_state(String::new);
    let traced = use_state(|| Rc::<[VariableId]>::from([]));
    let asked = use_state(|| None::<Asked>);
    let ask = use_callback((asked.clone(), traced.clone()), |wish: Asked, (asked, traced)| match wish {
        Asked::Trace(id) => traced.set(toggled(traced, id)),
        wish => asked.set(Some(wish)),
    });
    let close = use_callback((asked.clone(), fetched.reload.clone()), |(), (asked, reload)| {
        asked.set(None);
        reload.emit(());
    });
    let group = tree.as_ref().and_then(|tree| tree.group(props.id)).cloned();
    use_title(group.as_ref().map_or("", |group| group.config.name.as_str()));
    let (Some(tree), Some(group)) = (tree, group) else { return html! {} };
    let Some(device) = tree.device(group.config.device).cloned() else { return html! {} };
    let common = Common {
        on: group.config.on,
        live: plant.is_live(),
        may_edit: session::may(Role::may_edit),
        may_write: session::may(Role::may_write),
        traced: (*traced).clone(),
        ask: ask.clone(),
    };
    let is_empty = lines.ids.is_empty();
    html! {
        <div class="group-page">
            <Head group={group.clone()} device={device.clone()} ask={ask.clone()} />
            { stale_note(&plant.link()) }
            { tools(&group, &lines, &common, &filter, &plant) }
            { waiting(&fetched) }
            if fetched.data.is_some() && is_empty {
                { empty(common.may_edit) }
            } else {
                <Variables lines={lines.clone()} common={common.clone()} filter={AttrValue::from((*filter).clone())} />
            }
            if !traced.is_empty() {
                <TrendPanel variables={chosen(&lines, &traced)} on_close={
                    let traced = traced.clone();
                    Callback::from(move |()| traced.set(Rc::from([])))
                } />
            }
            { asked.and_then(|asked| dialog(asked, &group, &device, &lines, &ask, &close)) }
        </div>
    }
}

fn empty(may_edit: bool) -> Html {
    html! {
        <div class="empty" data-test="no-variables">
            <p>{ tr!("group.empty") }</p>
            if may_edit {
                <p>{ tr!("group.begin") }</p>
            } else {
                { note(tr!("all.not_you")) }
            }
        </div>
    }
}

/// With one more, or without it; the first goes when there are too many to tell apart.
fn toggled(traced: &Rc<[VariableId]>, id: VariableId) -> Rc<[VariableId]> {
    if traced.contains(&id) {
        return traced.iter().copied().filter(|other| *other != id).collect();
    }
    let first = (traced.len() + 1).saturating_sub(MOST_TRACED);
    traced.iter().skip(first).copied().chain([id]).collect()
}

/// As many as there are colours and dashes.
const MOST_TRACED: usize = 6;

fn chosen(lines: &Lines, traced: &[VariableId]) -> Rc<[Variable]> {
    traced.iter().filter_map(|id| lines.line(*id)).map(|line| line.variable.clone()).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_oldest_leaves_a_full_trend() {
        let ids = |numbers: &[u32]| numbers.iter().map(|number| VariableId(*number)).collect::<Rc<[_]>>();
        assert_eq!(toggled(&ids(&[1, 2]), VariableId(1)), ids(&[2]));
        assert_eq!(toggled(&ids(&[1, 2, 3, 4, 5, 6]), VariableId(7)), ids(&[2, 3, 4, 5, 6, 7]));
    }
}
