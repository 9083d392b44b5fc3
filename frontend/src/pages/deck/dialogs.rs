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

#[derive(Clone, PartialEq, Properties)]
pub(super) struct QuestionProps {
    pub(super) asked: Asked,
    /// Closes it, with an entry if one was added.
    pub(super) on_answered: Callback<Option<DeckId>>,
}

/// The dialog of a question. One component for all: each of its own would be 1 kB of the page.
#[component]
pub(super) fn Question(props: &QuestionProps) -> Html {
    let bench = use_workbench();
    let node = use_node_ref();
    let note = use_state(|| None::<AttrValue>);
    let QuestionProps { asked, on_answered } = props.clone();
    let body = body(asked, &bench, &node, (*note).clone());
    let close = on_answered.reform(|_: MouseEvent| None);
    let on_close = on_answered.reform(|()| None);
    let onsubmit = move |event: SubmitEvent| {
        event.prevent_default();
        match asked {
            Asked::Rename(id) => {
                rename(&bench, id, node.cast::<HtmlInputElement>().map(|input| input.value()));
                on_answered.emit(None);
            }
            Asked::Delete(id) => {
                bench.delete(id);
                on_answered.emit(None);
            }
            Asked::Copy(id) => {
                let note = note.clone();
                browser::copy(&json(&bench, id), move |done| {
                    note.set(Some(if done { tr!("copy.done") } else { tr!("copy.refused") }));
                });
            }
            Asked::Paste => {
                let text = node.cast::<HtmlTextAreaElement>().map(|input| input.value());
                match read(&text.unwrap_or_default()) {
                    Ok(config) => on_answered.emit(Some(bench.add(config))),
                    Err(error) => note.set(Some(tr!("paste.unreadable", error = error))),
                }
            }
        }
    };
    let (name, title, answer, kind, leave) = match asked {
        Asked::Rename(_) => {
            ("rename", tr!("rename.title"), tr!("rename.do"), "primary", tr!("dialog.cancel"))
        }
        // After a copy there is nothing to cancel.
        Asked::Copy(_) => ("copy", tr!("copy.title"), tr!("copy.do"), "primary", tr!("dialog.close")),
        Asked::Paste => ("paste", tr!("paste.title"), tr!("paste.do"), "primary", tr!("dialog.cancel")),
        Asked::Delete(_) => ("delete", tr!("delete.title"), tr!("delete.do"), "danger", tr!("dialog.cancel")),
    };
    html! {
        <Dialog {title} test={format!("{name}-dialog")} {on_close}>
            <form {onsubmit}>
                { body }
                <div class="dialog-buttons">
                    <button type="button" class="button" onclick={close}>{ leave }</button>
                    <button type="submit" class={classes!("button", kind)} data-test={format!("confirm-{name}")}>{ answer }</button>
                </div>
            </form>
        </Dialog>
    }
}

fn body(asked: Asked, bench: &Workbench, node: &NodeRef, said: Option<AttrValue>) -> Html {
    let name = |id| bench.name(id);
    match asked {
        Asked::Rename(id) => html! { <>
            <label for="rename-name">{ tr!("rename.name") }</label>
            <input id="rename-name" class="input" value={name(id)} ref={node.clone()} autofocus=true maxlength="64" />
        </> },
        Asked::Delete(id) => html! { <p>{ tr!("delete.text", name = name(id)) }</p> },
        Asked::Copy(id) => html! { <>
            <textarea class="input json" rows="16" readonly=true aria-label={tr!("copy.title")} value={json(bench, id)} />
            <p role="status" class="hint">{ said.unwrap_or(tr!("copy.hint")) }</p>
        </> },
        Asked::Paste => html! { <>
            <label for="paste-json">{ tr!("paste.label") }</label>
            <textarea id="paste-json" class="input json" rows="16" spellcheck="false" ref={node.clone()} autofocus=true
                aria-describedby={said.is_some().then_some("paste-finding")} />
            if let Some(problem) = said {
                <p id="paste-finding" class="finding error" role="alert">{ problem }</p>
            }
        </> },
    }
}

fn rename(bench: &Workbench, id: DeckId, name: Option<String>) {
    let was_unsaved = bench.is_unsaved(id);
    bench.edit(id, Edit::Text(Field::Name, name.unwrap_or_default()));
    // Only the name is stored here: other changes wait for their own Save.
    if !was_unsaved && bench.relay().is_online() {
        bench.save(id);
    }
}

fn json(bench: &Workbench, id: DeckId) -> String {
    let json = bench.draft(id).map(|draft| serde_json::to_string_pretty(&draft.config).unwrap_or_default());
    json.unwrap_or_default()
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
        let block = Block { id: BlockId(7), revision: 3, config: config.clone().into() };
        assert_eq!(read(&serde_json::to_string(&block).unwrap()), Ok(config));
    }

    #[test]
    fn what_is_no_block_says_where() {
        assert!(read("{\"name\":").unwrap_err().contains("line 1"));
    }
}
