//! What is asked about a block: its new name, its JSON, whether it may go.

use cipdeck_shared::{config::MsgCipGeneric, plan::Field};
use web_sys::{HtmlInputElement, HtmlTextAreaElement};
use yew::prelude::*;

use crate::{
    browser, editor::Edit, hooks::use_workbench, i18n::tr, kit::Dialog, store::DeckId, workbench::Workbench,
};

/// A question.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) enum Asked {
    /// A new name.
    Rename(DeckId),
    /// The block as JSON.
    Copy(DeckId),
    /// A block from JSON.
    Paste,
    /// May it go?
    Delete(DeckId),
}

/// The dialog of a question. `on_answered` closes it, with an entry if one was added.
pub(super) fn dialog(asked: Asked, on_answered: Callback<Option<DeckId>>) -> Html {
    match asked {
        Asked::Rename(id) => html! { <Rename {id} {on_answered} /> },
        Asked::Copy(id) => html! { <Copy {id} {on_answered} /> },
        Asked::Paste => html! { <Paste {on_answered} /> },
        Asked::Delete(id) => html! { <Delete {id} {on_answered} /> },
    }
}

#[derive(Clone, PartialEq, Properties)]
struct OneProps {
    id: DeckId,
    on_answered: Callback<Option<DeckId>>,
}

fn name(bench: &Workbench, id: DeckId) -> String {
    bench.draft(id).map(|draft| draft.config.name).unwrap_or_default()
}

fn buttons(
    words: AttrValue,
    kind: &'static str,
    test: &'static str,
    on_answered: &Callback<Option<DeckId>>,
) -> Html {
    // After a copy there is nothing to cancel.
    let leave = if test == "confirm-copy" { tr!("dialog.close") } else { tr!("dialog.cancel") };
    html! {
        <div class="dialog-buttons">
            <button type="button" class="button" onclick={on_answered.reform(|_: MouseEvent| None)}>{ leave }</button>
            <button type="submit" class={classes!("button", kind)} data-test={test}>{ words }</button>
        </div>
    }
}

#[component]
fn Rename(props: &OneProps) -> Html {
    let bench = use_workbench();
    let node = use_node_ref();
    let OneProps { id, on_answered } = props.clone();
    let old = name(&bench, id);
    let onsubmit = {
        let (node, on_answered) = (node.clone(), on_answered.clone());
        Callback::from(move |event: SubmitEvent| {
            event.prevent_default();
            let was_unsaved = bench.is_unsaved(id);
            let name = node.cast::<HtmlInputElement>().map(|input| input.value()).unwrap_or_default();
            bench.edit(id, Edit::Text(Field::Name, name));
            // Only the name is stored here: other changes wait for their own Save.
            if !was_unsaved && bench.relay().is_online() {
                bench.save(id);
            }
            on_answered.emit(None);
        })
    };
    html! {
        <Dialog title={tr!("rename.title")} test="rename-dialog" on_close={on_answered.reform(|()| None)}>
            <form {onsubmit}>
                <label for="rename-name">{ tr!("rename.name") }</label>
                <input id="rename-name" class="input" value={old} ref={node} autofocus=true maxlength="64" />
                { buttons(tr!("rename.do"), "primary", "confirm-rename", &on_answered) }
            </form>
        </Dialog>
    }
}

#[component]
fn Delete(props: &OneProps) -> Html {
    let bench = use_workbench();
    let OneProps { id, on_answered } = props.clone();
    let name = name(&bench, id);
    let onsubmit = {
        let on_answered = on_answered.clone();
        Callback::from(move |event: SubmitEvent| {
            event.prevent_default();
            bench.delete(id);
            on_answered.emit(None);
        })
    };
    html! {
        <Dialog title={tr!("delete.title")} test="delete-dialog" on_close={on_answered.reform(|()| None)}>
            <form {onsubmit}>
                <p>{ tr!("delete.text", name = name) }</p>
                { buttons(tr!("delete.do"), "danger", "confirm-delete", &on_answered) }
            </form>
        </Dialog>
    }
}

#[component]
fn Copy(props: &OneProps) -> Html {
    let bench = use_workbench();
    let copied = use_state(|| None::<bool>);
    let OneProps { id, on_answered } = props.clone();
    let json = bench
        .draft(id)
        .and_then(|draft| serde_json::to_string_pretty(&draft.config).ok())
        .unwrap_or_default();
    let onsubmit = {
        let (json, copied) = (json.clone(), copied.clone());
        Callback::from(move |event: SubmitEvent| {
            event.prevent_default();
            let copied = copied.clone();
            browser::copy(&json, move |done| copied.set(Some(done)));
        })
    };
    html! {
        <Dialog title={tr!("copy.title")} test="copy-dialog" on_close={on_answered.reform(|()| None)}>
            <form {onsubmit}>
                <textarea class="input json" rows="16" readonly=true aria-label={tr!("copy.title")} value={json} />
                <p role="status" class="hint">
                    { match *copied { None => tr!("copy.hint"), Some(true) => tr!("copy.done"), Some(false) => tr!("copy.refused") } }
                </p>
                { buttons(tr!("copy.do"), "primary", "confirm-copy", &on_answered) }
            </form>
        </Dialog>
    }
}

#[derive(Clone, PartialEq, Properties)]
struct PasteProps {
    on_answered: Callback<Option<DeckId>>,
}

#[component]
fn Paste(props: &PasteProps) -> Html {
    let bench = use_workbench();
    let node = use_node_ref();
    let problem = use_state(|| None::<String>);
    let on_answered = props.on_answered.clone();
    let onsubmit = {
        let (node, problem, on_answered) = (node.clone(), problem.clone(), on_answered.clone());
        Callback::from(move |event: SubmitEvent| {
            event.prevent_default();
            let text = node.cast::<HtmlTextAreaElement>().map(|input| input.value()).unwrap_or_default();
            match read(&text) {
                Ok(config) => on_answered.emit(Some(bench.add(config))),
                Err(error) => problem.set(Some(error)),
            }
        })
    };
    html! {
        <Dialog title={tr!("paste.title")} test="paste-dialog" on_close={on_answered.reform(|()| None)}>
            <form {onsubmit}>
                <label for="paste-json">{ tr!("paste.label") }</label>
                <textarea id="paste-json" class="input json" rows="16" spellcheck="false" ref={node} autofocus=true
                    aria-describedby={problem.is_some().then_some("paste-finding")} />
                if let Some(problem) = &*problem {
                    <p id="paste-finding" class="finding error" role="alert">{ tr!("paste.unreadable", error = problem) }</p>
                }
                { buttons(tr!("paste.do"), "primary", "confirm-paste", &on_answered) }
            </form>
        </Dialog>
    }
}

/// A block as it was copied, with or without the id and revision that a relay gave it.
fn read(text: &str) -> Result<MsgCipGeneric, String> {
    let mut config: MsgCipGeneric = serde_json::from_str(text).map_err(|error| error.to_string())?;
    config.extra.remove("id");
    config.extra.remove("revision");
    Ok(config)
}

#[cfg(test)]
mod tests {
    use super::*;
    use cipdeck_shared::config::{Block, BlockId};

    #[test]
    fn a_block_from_a_relay_is_pasted_without_its_id() {
        let config = MsgCipGeneric::product_name("0,0");
        let block = Block { id: BlockId(7), revision: 3, config: config.clone() };
        assert_eq!(read(&serde_json::to_string(&block).unwrap()), Ok(config));
    }

    #[test]
    fn what_is_no_block_says_where() {
        assert!(read("{\"name\":").unwrap_err().contains("line 1"));
    }
}
