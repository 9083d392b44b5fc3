//! The texts of this document; those of the workbench and of the office are there as well.

use crate::i18n::{self, CODE, OFFICE, PAGE};

/// A text of this document: `tr!("intake.title")`, `tr!("found.blocks", count = 3)`.
macro_rules! tr {
    ($key:literal) => {
        yew::AttrValue::Static(const { $crate::code::i18n::text($key) })
    };
    ($key:literal, $($name:ident = $value:expr),+ $(,)?) => {
        $crate::i18n::filled(
            const { $crate::code::i18n::text($key) },
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
    i18n::first_of(&[CODE, OFFICE, PAGE], key)
}
