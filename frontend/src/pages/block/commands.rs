//! The switch, Run and Cancel. A write is asked for before anything is sent.

use std::rc::Rc;

use cipdeck_shared::{api::BlockStatus, config::BlockId, plan::MessagePlan};
use yew::{platform::spawn_local, prelude::*};

use super::{
    keys::{Key, use_keys},
    write_dialog::WriteDialog,
};
use crate::{
    desk::{Consent, Desk, Intent, Local, Runs},
    editor::Editable,
    i18n::tr,
    kit::Switch,
    store::DeckId,
};

/// A block as its commands see it.
#[derive(Clone, PartialEq)]
pub(crate) struct Commanded {
    pub(crate) id: DeckId,
    /// The stored block and its revision, if the relay would run it.
    pub(crate) stored: Option<(BlockId, u64)>,
    pub(crate) plan: Option<Rc<MessagePlan>>,
    /// What the switch is called, and what it does.
    pub(crate) switch: (&'static str, AttrValue),
    /// The switch sends again and again.
    pub(crate) repeats: bool,
    /// Why it cannot run now.
    pub(crate) obstacle: Option<AttrValue>,
    pub(crate) asks: Asks,
    pub(crate) may_stop: bool,
    pub(crate) can_save: bool,
}

/// What comes before a block runs.
#[derive(Clone, Copy, PartialEq)]
pub(crate) enum Asks {
    /// Nothing: it only reads.
    Nothing,
    /// A person, who sees what will be written.
    Consent,
    /// The same, and before that it is stored: the relay writes what is stored.
    Storing,
}

#[derive(Clone, PartialEq, Properties)]
pub(crate) struct CommandsProps {
    pub(crate) block: Commanded,
    pub(crate) status: Rc<BlockStatus>,
}

/// The commands of a block; Ctrl+Enter runs it, Ctrl+S stores it.
#[component]
pub(crate) fn Commands<D, L>(props: &CommandsProps) -> Html
where
    D: Editable,
    L: Local,
    Desk<D, L>: Runs,
{
    let desk = use_context::<Desk<D, L>>().expect("the document provides its desk");
    let CommandsProps { block, status } = props;
    let (id, asks) = (block.id, block.asks);
    let asked = use_state(|| desk.take_wanted(id));
    let busy = status.phase.is_busy();
    let can_run = block.obstacle.is_none() && !busy && !status.input;
    let carry_out = {
        let desk = desk.clone();
        move |intent: Intent, consent: Consent| match intent {
            Intent::Run => desk.run(id, consent),
            Intent::SwitchOn => desk.set_in(id, true, consent),
        }
    };
    let begin = {
        let (desk, asked, carry_out) = (desk.clone(), asked.clone(), carry_out.clone());
        Callback::from(move |intent: Intent| match asks {
            Asks::Nothing => carry_out(intent, Consent::None),
            Asks::Consent => asked.set(Some(intent)),
            Asks::Storing => store_and_ask(&desk, &asked, id, intent),
        })
    };
    let on_run = begin.reform(|_: MouseEvent| Intent::Run);
    let on_switch =
        {
            let (desk, begin) = (desk.clone(), begin.clone());
            Callback::from(move |on: bool| {
                if on { begin.emit(Intent::SwitchOn) } else { desk.set_in(id, false, Consent::None) }
            })
        };
    let on_cancel = use_callback((desk.clone(), id), |_: MouseEvent, (desk, id)| desk.cancel(*id));
    use_keys({
        let (desk, is_open, can_save) = (desk.clone(), asked.is_some(), block.can_save);
        Callback::from(move |key: Key| match key {
            Key::Run if can_run && !is_open => begin.emit(Intent::Run),
            Key::Save if can_save && !is_open => desk.save(id),
            _ => {}
        })
    });
    let on_answer = {
        let asked = asked.clone();
        Callback::from(move |consent: Consent| {
            if let Some(intent) = asked.filter(|_| consent != Consent::None) {
                carry_out(intent, consent);
            }
            asked.set(None);
        })
    };
    let (label, words) = block.switch.clone();
    let switch = Switch {
        label,
        on: status.input,
        disabled: if status.input { !block.may_stop } else { block.obstacle.is_some() },
        title: block.obstacle.clone().unwrap_or(words),
        on_switch,
    };
    html! {
        <div class="commands">
            { switch.draw() }
            <button type="button" class="button primary run" disabled={!can_run} title={block.obstacle.clone()} onclick={on_run} data-test="run">
                { if asks == Asks::Nothing { tr!("run.run") } else { tr!("run.write") } }
            </button>
            <button type="button" class="button" disabled={!busy || !block.may_stop} onclick={on_cancel} data-test="cancel">{ tr!("run.cancel") }</button>
            <span class="obstacle" data-test="obstacle">{ block.obstacle.clone().unwrap_or_default() }</span>
            if let Some((intent, plan)) = (*asked).zip(block.plan.clone()) {
                <WriteDialog
                    relay={desk.relay().clone()}
                    stored={block.stored}
                    {plan}
                    repeats={intent == Intent::SwitchOn && block.repeats}
                    {on_answer}
                />
            }
        </div>
    }
}

impl Asks {
    /// Of a block that may write, and that is not stored as it is.
    pub(crate) const fn of(may_write: bool, unsaved: bool) -> Self {
        match (may_write, unsaved) {
            (false, _) => Self::Nothing,
            (true, false) => Self::Consent,
            (true, true) => Self::Storing,
        }
    }
}

/// Opens the dialog of a write once the block is stored.
fn store_and_ask<D: Editable, L: Local>(
    desk: &Desk<D, L>,
    asked: &UseStateHandle<Option<Intent>>,
    id: DeckId,
    intent: Intent,
) {
    let (desk, asked) = (desk.clone(), asked.clone());
    spawn_local(async move {
        if desk.store_to_write(id, intent).await {
            asked.set(Some(intent));
        }
    });
}
