//! The office's texts; those of the workbench are there as well.

use std::{fmt::Display, sync::LazyLock};

use yew::AttrValue;

use crate::i18n::{self, Texts};

/// A text of the office: `tr!("users.title")`, `tr!("check.code_length", count = 3)`.
macro_rules! tr {
    ($key:literal) => {
        $crate::office::i18n::text($key)
    };
    ($key:literal, $($name:ident = $value:expr),+ $(,)?) => {
        $crate::office::i18n::filled($key, &[$((stringify!($name), &$value as &dyn std::fmt::Display)),+])
    };
}
pub(crate) use tr;

static OFFICE: LazyLock<Texts> =
    LazyLock::new(|| Texts::read(include_str!(concat!(env!("OUT_DIR"), "/office.tsv"))));

/// The text of a key.
pub(crate) fn text(key: &'static str) -> AttrValue {
    OFFICE.get(key).map_or_else(|| i18n::text(key), AttrValue::Static)
}

/// The text of a key with its `%{name}`s replaced.
pub(crate) fn filled(key: &'static str, values: &[(&'static str, &dyn Display)]) -> AttrValue {
    i18n::fill(&text(key), values.iter().map(|(name, value)| (*name, value.to_string()))).into()
}

/// A text whose key is put together at run time, or `None` where there is none.
pub(crate) fn try_text(key: &str) -> Option<AttrValue> {
    OFFICE.get(key).map(AttrValue::Static)
}
