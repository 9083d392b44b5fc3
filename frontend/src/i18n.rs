//! Texts. All of them are in `locales/`. A text whose key is written in the source is found when the page is compiled, so
//! that a document carries only what it shows; those whose key is put together at run time are tables.

use core::cmp::Ordering;
use std::fmt::Display;

use yew::AttrValue;

/// A text of the page: `tr!("list.new")`, `tr!("field.byte_count", count = 3)`.
macro_rules! tr {
    ($key:literal) => {
        yew::AttrValue::Static(const { $crate::i18n::text($key) })
    };
    ($key:literal, $($name:ident = $value:expr),+ $(,)?) => {
        $crate::i18n::filled(
            const { $crate::i18n::text($key) },
            &[$((stringify!($name), &$value as &dyn std::fmt::Display)),+],
        )
    };
}
pub(crate) use tr;

// Sorted by their keys: PAGE, OFFICE, DEVICES, WORDS, CODE, and what is looked up at run time.
include!(concat!(env!("OUT_DIR"), "/texts.rs"));

/// Keys and their texts, sorted.
pub(crate) type Texts = &'static [(&'static str, &'static str)];

/// The text of a key of the page.
///
/// # Panics
/// Where there is none: the page does not compile.
pub(crate) const fn text(key: &str) -> &'static str {
    first_of(&[PAGE], key)
}

/// The text of a key in the first table that has one.
///
/// # Panics
/// Where there is none: the page does not compile.
pub(crate) const fn first_of(tables: &[Texts], key: &str) -> &'static str {
    let mut place = 0;
    while place < tables.len() {
        if let Some(text) = find(tables[place], key) {
            return text;
        }
        place += 1;
    }
    panic!("there is no text for this key in locales/")
}

/// The text of a key, or `None` where there is none.
pub(crate) const fn find(texts: Texts, key: &str) -> Option<&'static str> {
    let (mut low, mut high) = (0, texts.len());
    while low < high {
        let middle = usize::midpoint(low, high);
        let (there, text) = texts[middle];
        match compare(there.as_bytes(), key.as_bytes()) {
            Ordering::Less => low = middle + 1,
            Ordering::Equal => return Some(text),
            Ordering::Greater => high = middle,
        }
    }
    None
}

const fn compare(one: &[u8], other: &[u8]) -> Ordering {
    let mut place = 0;
    while place < one.len() && place < other.len() {
        if one[place] != other[place] {
            return if one[place] < other[place] { Ordering::Less } else { Ordering::Greater };
        }
        place += 1;
    }
    if one.len() == other.len() {
        return Ordering::Equal;
    }
    if one.len() < other.len() { Ordering::Less } else { Ordering::Greater }
}

/// A text with its `%{name}`s replaced.
#[inline(never)]
pub(crate) fn filled(text: &'static str, values: &[(&'static str, &dyn Display)]) -> AttrValue {
    fill(text, values.iter().map(|(name, value)| (*name, value.to_string()))).into()
}

/// The text of a validation rule, by its key and arguments.
pub(crate) fn rule_text(key: &str, arguments: &[(&'static str, String)]) -> String {
    fill(find(RULE, key).unwrap_or(key), arguments.iter().cloned())
}

/// Puts values where their names are.
fn fill(text: &str, values: impl Iterator<Item = (&'static str, String)>) -> String {
    values.fold(text.to_owned(), |text, (name, value)| text.replace(&format!("%{{{name}}}"), &value))
}

#[cfg(test)]
mod tests;
