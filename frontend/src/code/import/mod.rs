//! Code in: texts on the left, what was found in them on the right.

mod aim;
mod block;
mod can;
pub mod desk;
pub mod editor;
pub mod entry;
mod files;
mod found;
mod intake;
mod kept;
mod reading;
mod remarks;
mod save;

use std::{collections::BTreeSet, rc::Rc};

use yew::prelude::*;

pub use self::desk::Desk;
pub(super) use self::kept::restored;
use self::{
    can::can_be_read, desk::Deed, editor::Wish, entry::entries, found::Found, intake::Intake,
    kept::use_keeping, reading::use_reading,
};
use super::{api::Stored, i18n::tr};
use crate::{hooks::use_title, office::fetch::use_fetched};

/// The desk outlives the page, and the document: who looks at a project and comes back finds it as it was.
#[derive(Clone, PartialEq, Properties)]
pub(super) struct ImportPageProps {
    pub(super) desk: UseReducerHandle<Desk>,
}

/// The page.
#[component]
pub(super) fn ImportPage(props: &ImportPageProps) -> Html {
    use_title(&tr!("intake.title"));
    let desk = props.desk.clone();
    use_reading(&desk);
    let keeping = use_keeping(&desk);
    let in_deck = use_fetched::<Vec<Stored>>("blocks".to_owned());
    let names = use_memo(in_deck.data.clone(), |blocks| {
        let blocks = blocks.iter().flat_map(|blocks| blocks.iter());
        blocks.map(|block| block.name.clone()).collect::<BTreeSet<_>>()
    });
    let decided: Vec<_> =
        desk.sources.iter().map(|it| (it.key, it.imported.clone(), it.picks.clone())).collect();
    let entries = use_memo((decided, desk.target.clone(), names), {
        let desk = desk.clone();
        move |(_, _, names)| entries(&desk, names)
    });
    let wish = use_state(Wish::default);
    // A line of a text: shows both.
    let on_line =
        use_callback((desk.dispatcher(), wish.clone()), |(key, line): (u32, usize), (desk, wish)| {
            desk.dispatch(Deed::Show(key));
            wish.set(Wish { line, number: wish.number + 1 });
        });
    let on_deed = {
        let dispatcher = desk.dispatcher();
        use_callback((), move |deed: Deed, ()| dispatcher.dispatch(deed))
    };
    let drop = files::use_drop(&on_deed);
    let is_empty = desk.sources.iter().all(desk::Source::is_empty);
    html! {
        <div class={classes!("code-page", drop.is_over.then_some("over"))} ondragover={drop.over} ondragleave={drop.leave} ondrop={drop.drop}>
            <div class="page-head"><h1>{ tr!("intake.title") }</h1></div>
            <p class="lead">{ tr!("intake.lead") }</p>
            <div class="code-in">
                <Intake desk={desk.clone()} wish={*wish} {keeping} on_deed={on_deed.clone()} />
                if is_empty {
                    { can_be_read() }
                } else {
                    <Found desk={desk.clone()} entries={(*entries).clone()} {on_line} {on_deed} on_saved={in_deck.reload} />
                }
            </div>
        </div>
    }
}

/// Blocks as they are shown.
type Entries = Vec<Rc<entry::Entry>>;
