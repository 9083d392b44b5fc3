//! Texts. All of them are in `locales/`.

use std::fmt::Display;

use yew::AttrValue;

/// A text of the page: `tr!("list.new")`, `tr!("field.byte_count", count = 3)`.
///
/// Calls a function, where rust-i18n's own macro would put the whole search into every place that uses it: that was a
/// tenth of the page's size.
macro_rules! tr {
    ($key:literal) => {
        $crate::i18n::text($key)
    };
    ($key:literal, $($name:ident = $value:expr),+ $(,)?) => {
        $crate::i18n::filled($key, &[$((stringify!($name), &$value as &dyn std::fmt::Display)),+])
    };
}
pub(crate) use tr;

/// The text of a key; the key itself where the locale has none, which a test rules out.
#[inline(never)]
pub(crate) fn text(key: &'static str) -> AttrValue {
    try_text(key).map_or(AttrValue::Static(key), AttrValue::from)
}

/// The text of a key with its `%{name}`s replaced.
#[inline(never)]
pub(crate) fn filled(key: &'static str, values: &[(&'static str, &dyn Display)]) -> AttrValue {
    let (names, values): (Vec<_>, Vec<_>) =
        values.iter().map(|(name, value)| (*name, value.to_string())).unzip();
    rust_i18n::replace_patterns(&text(key), &names, &values).into()
}

/// The text of a validation rule, by its key and arguments.
pub(crate) fn rule_text(key: &str, arguments: &[(&'static str, String)]) -> String {
    let (names, values): (Vec<_>, Vec<_>) = arguments.iter().cloned().unzip();
    let text = try_text(&format!("rule.{key}")).unwrap_or_else(|| key.to_owned());
    rust_i18n::replace_patterns(&text, &names, &values)
}

/// A text whose key is put together at run time, or `None` where the locale has none.
pub(crate) fn try_text(key: &str) -> Option<String> {
    crate::_rust_i18n_try_translate(&rust_i18n::locale(), key).map(std::borrow::Cow::into_owned)
}

#[cfg(test)]
mod tests;
