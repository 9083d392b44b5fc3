//! Texts. All of them are in `locales/`; build.rs makes them the tables that are searched here.

use std::{fmt::Display, sync::LazyLock};

use yew::AttrValue;

/// A text of the page: `tr!("list.new")`, `tr!("field.byte_count", count = 3)`.
macro_rules! tr {
    ($key:literal) => {
        $crate::i18n::text($key)
    };
    ($key:literal, $($name:ident = $value:expr),+ $(,)?) => {
        $crate::i18n::filled($key, &[$((stringify!($name), &$value as &dyn std::fmt::Display)),+])
    };
}
pub(crate) use tr;

/// Keys and their texts.
pub(crate) struct Texts(Vec<(&'static str, &'static str)>);

impl Texts {
    /// One `key<TAB>text` per line, in the order of the keys.
    pub(crate) fn read(table: &'static str) -> Self {
        Self(table.lines().filter_map(|line| line.split_once('\t')).collect())
    }

    /// The text of a key.
    pub(crate) fn get(&self, key: &str) -> Option<&'static str> {
        let place = self.0.binary_search_by(|(other, _)| (*other).cmp(key)).ok()?;
        self.0.get(place).map(|(_, text)| *text)
    }
}

static PAGE: LazyLock<Texts> =
    LazyLock::new(|| Texts::read(include_str!(concat!(env!("OUT_DIR"), "/page.tsv"))));

/// The text of a key; the key itself where there is none, which a test rules out.
#[inline(never)]
pub(crate) fn text(key: &'static str) -> AttrValue {
    AttrValue::Static(PAGE.get(key).unwrap_or(key))
}

/// The text of a key with its `%{name}`s replaced.
#[inline(never)]
pub(crate) fn filled(key: &'static str, values: &[(&'static str, &dyn Display)]) -> AttrValue {
    fill(&text(key), values.iter().map(|(name, value)| (*name, value.to_string()))).into()
}

/// The text of a validation rule, by its key and arguments.
pub(crate) fn rule_text(key: &str, arguments: &[(&'static str, String)]) -> String {
    let text = try_text(&format!("rule.{key}")).unwrap_or_else(|| key.to_owned());
    fill(&text, arguments.iter().cloned())
}

/// A text whose key is put together at run time, or `None` where there is none.
pub(crate) fn try_text(key: &str) -> Option<String> {
    PAGE.get(key).map(str::to_owned)
}

/// Puts values where their names are.
pub(crate) fn fill(text: &str, values: impl Iterator<Item = (&'static str, String)>) -> String {
    values.fold(text.to_owned(), |text, (name, value)| text.replace(&format!("%{{{name}}}"), &value))
}

#[cfg(test)]
mod tests;
