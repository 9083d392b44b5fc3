//! The texts of this document; those of the workbench and of the office are there as well.

use std::{fmt::Display, sync::LazyLock};

use yew::AttrValue;

use crate::{
    i18n::{self, Texts},
    office,
};

/// A text of this document: `tr!("tree.label")`, `tr!("group.every", ms = 500)`.
macro_rules! tr {
    ($key:literal) => {
        $crate::devices::i18n::text($key)
    };
    ($key:literal, $($name:ident = $value:expr),+ $(,)?) => {
        $crate::devices::i18n::filled($key, &[$((stringify!($name), &$value as &dyn std::fmt::Display)),+])
    };
}
pub(crate) use tr;

static DEVICES: LazyLock<Texts> =
    LazyLock::new(|| Texts::read(include_str!(concat!(env!("OUT_DIR"), "/devices.tsv"))));

/// The text of a key.
pub(crate) fn text(key: &'static str) -> AttrValue {
    DEVICES.get(key).map_or_else(|| office::text(key), AttrValue::Static)
}

/// The text of a key with its `%{name}`s replaced.
pub(crate) fn filled(key: &'static str, values: &[(&'static str, &dyn Display)]) -> AttrValue {
    i18n::fill(&text(key), values.iter().map(|(name, value)| (*name, value.to_string()))).into()
}

/// The text of a key, if this document has one.
#[cfg(test)]
pub(crate) fn try_text(key: &str) -> Option<&'static str> {
    DEVICES.get(key)
}
