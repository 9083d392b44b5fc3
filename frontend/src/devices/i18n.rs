//! The texts of this document; those of the workbench and of the office are there as well.

use crate::i18n::{self, DEVICES, OFFICE, PAGE};

/// A text of this document: `tr!("tree.label")`, `tr!("group.every", ms = 500)`.
macro_rules! tr {
    ($key:literal) => {
        yew::AttrValue::Static(const { $crate::devices::i18n::text($key) })
    };
    ($key:literal, $($name:ident = $value:expr),+ $(,)?) => {
        $crate::i18n::filled(
            const { $crate::devices::i18n::text($key) },
            &[$((stringify!($name), &$value as &dyn std::fmt::Display)),+],
        )
    };
}
pub(crate) use tr;

/// The text of a key.
///
/// # Panics
/// Where there is none: the page does not compile.
pub(crate) const fn text(key: &str) -> &'static str {
    i18n::first_of(&[DEVICES, OFFICE, PAGE], key)
}
