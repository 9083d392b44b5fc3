//! All drafts of this browser. They survive a reload.

use std::{cell::RefCell, fmt, rc::Rc};

use cipdeck_shared::{config::MsgCipGeneric, plan::Field};
use serde::{Deserialize, Serialize};
use yew::Callback;

use super::{draft::Draft, number::number_fields};
use crate::store::{DeckId, Shelf, Watch, Watchers};

/// Where drafts are kept as text, such as the browser's local storage.
pub type Keep = Rc<dyn Fn(&str)>;

/// What can be kept as a line of text.
pub trait Keepable: Sized {
    /// The line of a draft with this id.
    fn write(&self, id: &str) -> Option<String>;

    /// Id and draft of a line, if it is one.
    fn read(line: &str) -> Option<(String, Self)>;
}

/// A handle to the drafts. Clones are the same store.
pub struct DraftStore<D = Draft>(Rc<Inner<D>>);

struct Inner<D> {
    keep: Keep,
    drafts: RefCell<Shelf<DeckId, Rc<D>>>,
    watchers: RefCell<Shelf<DeckId, Watchers>>,
    last_new: RefCell<u32>,
}

impl<D: Keepable> DraftStore<D> {
    /// The drafts that `kept` describes; what cannot be read is dropped.
    pub fn new(kept: Option<&str>, keep: Keep) -> Self {
        let drafts = kept.map(read_all).unwrap_or_default();
        let last_new = drafts.keys().filter_map(|id| new_number(*id)).max().unwrap_or(0);
        let (drafts, watchers) = (RefCell::new(drafts), RefCell::default());
        Self(Rc::new(Inner { keep, drafts, watchers, last_new: RefCell::new(last_new) }))
    }

    /// The draft of an entry, if it has one.
    pub fn draft(&self, id: DeckId) -> Option<Rc<D>> {
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
    pub fn put(&self, id: DeckId, draft: D) {
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
        (self.0.keep)(&write_all(&self.0.drafts.borrow()));
        let watchers = self.0.watchers.borrow().get(&id).cloned();
        if let Some(watchers) = watchers {
            watchers.wake();
        }
    }
}

impl<D> Clone for DraftStore<D> {
    fn clone(&self) -> Self {
        Self(self.0.clone())
    }
}

impl<D> PartialEq for DraftStore<D> {
    fn eq(&self, other: &Self) -> bool {
        Rc::ptr_eq(&self.0, &other.0)
    }
}

impl<D> fmt::Debug for DraftStore<D> {
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

impl Keepable for Draft {
    fn write(&self, id: &str) -> Option<String> {
        let kept = Kept {
            id: id.to_owned(),
            revision: self.revision,
            config: self.config.clone(),
            typed: self.typed().iter().map(|(field, text)| (field.to_string(), text.clone())).collect(),
        };
        serde_json::to_string(&kept).ok()
    }

    fn read(line: &str) -> Option<(String, Self)> {
        let kept: Kept = serde_json::from_str(line).ok()?;
        Some((kept.id, Self::restored(kept.config, kept.revision, typed(&kept.typed))))
    }
}

fn write_all<D: Keepable>(drafts: &Shelf<DeckId, Rc<D>>) -> String {
    let lines = drafts.iter().filter_map(|(id, draft)| draft.write(&id.to_string()));
    lines.collect::<Vec<_>>().join("\n")
}

fn read_all<D: Keepable>(text: &str) -> Shelf<DeckId, Rc<D>> {
    let mut drafts = Shelf::default();
    for (id, draft) in text.lines().filter_map(D::read) {
        if let Ok(id) = id.parse() {
            drafts.insert(id, Rc::new(draft));
        }
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
    use crate::editor::{Edit, Editable};
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
        let again = DraftStore::<Draft>::new(Some(&text.borrow()), Rc::new(|_| ()));
        assert_eq!(*again.draft(stored).unwrap(), draft);
        assert_eq!(again.ids(), [stored, new]);
        assert_ne!(again.next_new(), new, "a new block gets a name of its own");
    }

    #[test]
    fn one_unreadable_draft_does_not_cost_the_others() {
        let (store, text) = kept();
        store.put(DeckId::New(1), Draft::new(MsgCipGeneric::product_name("0,0"), None));
        let broken = format!("{{\"id\":\"new-2\",\"config\":1}}\n{}", text.borrow());
        assert_eq!(DraftStore::<Draft>::new(Some(&broken), Rc::new(|_| ())).ids(), [DeckId::New(1)]);
        assert!(DraftStore::<Draft>::new(Some("not json"), Rc::new(|_| ())).ids().is_empty());
    }
}
