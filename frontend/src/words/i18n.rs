//! The texts of this document; those of the workbench are there as well.

use crate::i18n::{self, PAGE, WORDS};

/// A text of this document: `tr!("list.title")`.
macro_rules! tr {
    ($key:literal) => {
        yew::AttrValue::Static(const { $crate::words::i18n::text($key) })
    };
    ($key:literal, $($name:ident = $value:expr),+ $(,)?) => {
        $crate::i18n::filled(
            const { $crate::words::i18n::text($key) },
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
    i18n::first_of(&[WORDS, PAGE], key)
}
