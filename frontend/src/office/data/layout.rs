//! The text of a layout.

use cipdeck_shared::tag::DataFields;
use yew::prelude::*;

use crate::office::{i18n::tr, kit::Entry};

/// A layout with what is wrong with it, or what may be written.
pub(super) fn layout_entry(id: &'static str, label: AttrValue, text: &UseStateHandle<String>) -> Html {
    let problem = wrong(text);
    Entry::text(id, label, text).hint(tr!("data.layout_hint")).problem(problem).draw()
}

/// Empty is readable: nobody has said what the bytes are.
pub(super) fn is_readable(text: &str) -> bool {
    wrong(text).is_none()
}

fn wrong(text: &str) -> Option<AttrValue> {
    let error = DataFields::read(text).err().filter(|_| !text.trim().is_empty())?;
    Some(error.to_string().into())
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn no_layout_is_no_mistake() {
        assert_eq!((wrong(""), wrong(" "), wrong("speed: REAL; run: BOOL")), (None, None, None));
        assert!(wrong("speed: REEL").is_some_and(|why| why.contains("character 8")));
    }
}
