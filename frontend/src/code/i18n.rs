//! The texts of this document; those of the workbench are there as well.

use crate::i18n::{self, CODE, PAGE};

/// A text of this document: `tr!("code.title")`.
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
    i18n::first_of(&[CODE, PAGE], key)
}
