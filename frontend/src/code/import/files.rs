//! Files that are chosen, or dropped onto the page.

use wasm_bindgen::JsCast;
use web_sys::{DragEvent, File, FileList};
use yew::{platform::spawn_local, prelude::*};

use super::{
    super::decode::{MAX_FILE, NoText, decode},
    desk::{Deed, Refusal},
};
use crate::browser;

/// Reads all files of a list, one after the other.
pub(super) fn take(files: &FileList, on_deed: &Callback<Deed>) {
    let files: Vec<_> = (0..files.length()).filter_map(|index| files.get(index)).collect();
    let on_deed = on_deed.clone();
    spawn_local(async move {
        for file in files {
            on_deed.emit(match read(&file).await {
                Ok(deed) => deed,
                Err(why) => Deed::Refuse(file.name(), why),
            });
        }
    });
}

async fn read(file: &File) -> Result<Deed, Refusal> {
    // A file of gigabytes is not even fetched. Sizes of files are whole numbers.
    #[expect(clippy::cast_possible_truncation, clippy::cast_sign_loss, reason = "whole, not negative")]
    let size = file.size() as usize;
    if size > MAX_FILE {
        return Err(Refusal::NoText(NoText::TooBig(size)));
    }
    let bytes = browser::bytes_of(file).await.ok_or(Refusal::Unreadable)?;
    let decoded = decode(&bytes).map_err(Refusal::NoText)?;
    Ok(Deed::Add(file.name(), decoded.text, decoded.encoding))
}

/// A place to drop files at.
pub(super) struct Landing {
    /// Whether files are held over it.
    pub(super) is_over: bool,
    pub(super) over: Callback<DragEvent>,
    pub(super) leave: Callback<DragEvent>,
    pub(super) drop: Callback<DragEvent>,
}

/// Files only: texts that are dragged go where the browser puts them.
#[hook]
pub(super) fn use_drop(on_deed: &Callback<Deed>) -> Landing {
    let is_over = use_state_eq(|| false);
    let set = is_over.setter();
    let over = {
        let set = set.clone();
        Callback::from(move |event: DragEvent| {
            if has_files(&event) {
                event.prevent_default();
                set.set(true);
            }
        })
    };
    let leave = {
        let set = set.clone();
        Callback::from(move |event: DragEvent| {
            // Going from one element of the page to another is no leaving.
            let to = event.related_target().and_then(|to| to.dyn_into::<web_sys::Node>().ok());
            let page = event.current_target().and_then(|page| page.dyn_into::<web_sys::Node>().ok());
            if !page.is_some_and(|page| page.contains(to.as_ref())) {
                set.set(false);
            }
        })
    };
    let on_deed = on_deed.clone();
    let drop = Callback::from(move |event: DragEvent| {
        set.set(false);
        if let Some(files) = event.data_transfer().and_then(|data| data.files()).filter(|it| it.length() > 0)
        {
            event.prevent_default();
            take(&files, &on_deed);
        }
    });
    Landing { is_over: *is_over, over, leave, drop }
}

fn has_files(event: &DragEvent) -> bool {
    event.data_transfer().is_some_and(|data| data.types().includes(&"Files".into(), 0))
}
