//! Saving: one block after the other, each with its own result.

use cipdeck_shared::api::Role;
use yew::{platform::spawn_local, prelude::*};

use super::{
    super::{api, i18n::tr, say},
    Entries,
    desk::{Deed, Outcome},
};
use crate::{hooks::use_session, net::session};

#[derive(Clone, PartialEq, Properties)]
pub(super) struct SaveBarProps {
    pub(super) entries: Entries,
    pub(super) on_deed: Callback<Deed>,
    /// After the last one.
    pub(super) on_saved: Callback<()>,
}

/// How much there is to save, the button, and how far it is.
#[component]
pub(super) fn SaveBar(props: &SaveBarProps) -> Html {
    use_session();
    let busy = use_state(|| None::<(usize, usize)>);
    let done = use_state(|| None::<(usize, usize)>);
    let due: Vec<_> = props.entries.iter().filter(|entry| entry.is_due()).cloned().collect();
    let count = due.len();
    let wrong =
        props.entries.iter().filter(|it| it.pick.kept && !it.pick.is_saved() && it.has_errors()).count();
    let may = session::may(Role::may_edit);
    let onclick = {
        let (busy, done, on_deed, on_saved) =
            (busy.clone(), done.setter(), props.on_deed.clone(), props.on_saved.clone());
        move |_: MouseEvent| {
            if busy.is_some() {
                return;
            }
            let (busy, done, due) = (busy.setter(), done.clone(), due.clone());
            let (on_deed, on_saved) = (on_deed.clone(), on_saved.clone());
            busy.set(Some((0, count)));
            done.set(None);
            spawn_local(async move {
                let (mut saved, mut refused) = (0, 0);
                for (number, entry) in due.iter().enumerate() {
                    busy.set(Some((number, count)));
                    on_deed.emit(Deed::Became(entry.place, Outcome::Saving));
                    let outcome = match api::save(&entry.config).await {
                        Ok(block) => Outcome::Saved(block.id),
                        Err(problem) => Outcome::Refused(problem.into()),
                    };
                    *if matches!(outcome, Outcome::Saved(_)) { &mut saved } else { &mut refused } += 1;
                    on_deed.emit(Deed::Became(entry.place, outcome));
                }
                busy.set(None);
                done.set(Some((saved, refused)));
                on_saved.emit(());
            });
        }
    };
    let words = match (*busy, count) {
        (Some((number, all)), _) => tr!("save.busy", done = number, all = all),
        (None, 0) => tr!("save.nothing"),
        (None, _) => tr!("save.do", blocks = say::blocks(count)),
    };
    html! {
        <div class="code-save">
            <button type="button" class="button primary" disabled={busy.is_some() || count == 0 || !may} {onclick} data-test="save">{ words }</button>
            if !may {
                <span class="hint">{ tr!("save.not_you") }</span>
            }
            if wrong > 0 {
                <span class="finding error">{ if wrong == 1 { tr!("save.has_error") } else { tr!("save.has_errors", count = wrong) } }</span>
            }
            <span role="status" data-test="save-done">
                if let Some((saved, refused)) = *done {
                    { if refused == 0 { tr!("save.done", saved = saved) } else { tr!("save.done_partly", saved = saved, refused = refused) } }
                }
            </span>
        </div>
    }
}
