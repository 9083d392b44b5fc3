//! All drafts of this browser. They survive a reload.

use std::{cell::RefCell, fmt, rc::Rc};

use cipdeck_shared::{config::MsgCipGeneric, plan::Field};
use serde::{Deserialize, Serialize};
use yew::Callback;

use super::{draft::Draft, number::number_fields};
use crate::store::{DeckId, Shelf, Watch, Watchers};

/// Where drafts are kept as text, such as the browser's local storage.
pub type Keep = Rc<dyn Fn(&str)>;

/// A handle to the drafts. Clones are the same store.
#[derive(Clone)]
pub struct DraftStore(Rc<Inner>);

struct Inner {
    keep: Keep,
    drafts: RefCell<Shelf<DeckId, Rc<Draft>>>,
    watchers: RefCell<Shelf<DeckId, Watchers>>,
    last_new: RefCell<u32>,
}

impl DraftStore {
    /// The drafts that `kept` describes; what cannot be read is dropped.
    pub fn new(kept: Option<&str>, keep: Keep) -> Self {
        let drafts = kept.map(read).unwrap_or_default();
        let last_new = drafts.keys().filter_map(|id| new_number(*id)).max().unwrap_or(0);
        let (drafts, watchers) = (RefCell::new(drafts), RefCell::default());
        Self(Rc::new(Inner { keep, drafts, watchers, last_new: RefCell::new(last_new) }))
    }

    /// The draft of an entry, if it has one.
    pub fn draft(&self, id: DeckId) -> Option<Rc<Draft>> {
        self.0.drafts.borrow().get(&id).cloned()
    }

    /// Entries with drafts.
    pub fn ids(&self) -> Vec<DeckId> {
        self.0.drafts.borrow().keys().copied().collect()
    }

    /// A name that no entry has: for a new block.
    pub fn next_new(&self) -> DeckId {
        let mut last = self.0.last_new.borrow_mut();
        *last += 1;
        DeckId::New(*last)
    }

    /// Keeps a draft.
    pub fn put(&self, id: DeckId, draft: Draft) {
        self.0.drafts.borrow_mut().insert(id, Rc::new(draft));
        self.changed(id);
    }

    /// Forgets a draft.
    pub fn discard(&self, id: DeckId) {
        if self.0.drafts.borrow_mut().remove(&id).is_some() {
            self.changed(id);
        }
    }

    /// Wakes when the draft of this entry changes, comes or goes.
    pub fn watch(&self, id: DeckId, wake: Callback<()>) -> Watch {
        self.0.watchers.borrow_mut().or_default(id).watch(wake)
    }

    fn changed(&self, id: DeckId) {
        (self.0.keep)(&write(&self.0.drafts.borrow()));
        let watchers = self.0.watchers.borrow().get(&id).cloned();
        if let Some(watchers) = watchers {
            watchers.wake();
        }
    }
}

impl PartialEq for DraftStore {
    fn eq(&self, other: &Self) -> bool {
        Rc::ptr_eq(&self.0, &other.0)
    }
}

impl fmt::Debug for DraftStore {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "DraftStore({} drafts)", self.0.drafts.borrow().len())
    }
}

/// One draft: a line of JSON.
#[derive(Serialize, Deserialize)]
struct Kept {
    id: String,
    revision: Option<u64>,
    config: MsgCipGeneric,
    typed: Vec<(String, String)>,
}

fn write(drafts: &Shelf<DeckId, Rc<Draft>>) -> String {
    let keep = |(id, draft): (&DeckId, &Rc<Draft>)| Kept {
        id: id.to_string(),
        revision: draft.revision,
        config: draft.config.clone(),
        typed: draft.typed().iter().map(|(field, text)| (field.to_string(), text.clone())).collect(),
    };
    let lines = drafts.iter().filter_map(|draft| serde_json::to_string(&keep(draft)).ok());
    lines.collect::<Vec<_>>().join("\n")
}

fn read(text: &str) -> Shelf<DeckId, Rc<Draft>> {
    let mut drafts = Shelf::default();
    for line in text.lines() {
        let Ok(kept) = serde_json::from_str::<Kept>(line) else { continue };
        let Ok(id) = kept.id.parse() else { continue };
        drafts.insert(id, Rc::new(Draft::restored(kept.config, kept.revision, typed(&kept.typed))));
    }
    drafts
}

fn typed(kept: &[(String, String)]) -> Shelf<Field, String> {
    let mut typed = Shelf::default();
    for field in number_fields() {
        let name = field.to_string();
        if let Some((_, text)) = kept.iter().find(|(kept, _)| *kept == name) {
            typed.insert(field, text.clone());
        }
    }
    typed
}

const fn new_number(id: DeckId) -> Option<u32> {
    match id {
        DeckId::New(number) => Some(number),
        DeckId::Stored(_) => None,
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::editor::Edit;
    use cipdeck_shared::config::BlockId;

    fn kept() -> (DraftStore, Rc<RefCell<String>>) {
        let text = Rc::new(RefCell::new(String::new()));
        let into = text.clone();
        (DraftStore::new(None, Rc::new(move |text| *into.borrow_mut() = text.to_owned())), text)
    }

    #[test]
    fn drafts_survive_a_reload_with_the_text_that_was_typed() {
        let (store, text) = kept();
        let mut draft = Draft::new(MsgCipGeneric::product_name("4,10.0.0.1"), Some(3));
        draft.edit(Edit::Number(Field::MemberId(1), "1x".into()));
        let stored = DeckId::Stored(BlockId(7));
        store.put(stored, draft.clone());
        let new = store.next_new();
        store.put(new, Draft::new(MsgCipGeneric::product_name("0,0"), None));
        let again = DraftStore::new(Some(&text.borrow()), Rc::new(|_| ()));
        assert_eq!(*again.draft(stored).unwrap(), draft);
        assert_eq!(again.ids(), [stored, new]);
        assert_ne!(again.next_new(), new, "a new block gets a name of its own");
    }

    #[test]
    fn one_unreadable_draft_does_not_cost_the_others() {
        let (store, text) = kept();
        store.put(DeckId::New(1), Draft::new(MsgCipGeneric::product_name("0,0"), None));
        let broken = format!("{{\"id\":\"new-2\",\"config\":1}}\n{}", text.borrow());
        assert_eq!(DraftStore::new(Some(&broken), Rc::new(|_| ())).ids(), [DeckId::New(1)]);
        assert!(DraftStore::new(Some("not json"), Rc::new(|_| ())).ids().is_empty());
    }
}
