//! Texts. All of them are in `locales/`.

/// A text of the page: `tr!("list.new")`, `tr!("field.byte_count", count = 3)`.
macro_rules! tr {
    ($($key_and_arguments:tt)*) => {
        yew::AttrValue::from(rust_i18n::t!($($key_and_arguments)*).into_owned())
    };
}
pub(crate) use tr;

/// The text of a validation rule, by its key and arguments.
pub(crate) fn rule_text(key: &str, arguments: &[(&'static str, String)]) -> String {
    let (names, values): (Vec<_>, Vec<_>) = arguments.iter().cloned().unzip();
    rust_i18n::replace_patterns(&rust_i18n::t!(format!("rule.{key}")), &names, &values)
}

/// A text whose key is put together at run time, or `None` where the locale has none.
pub(crate) fn try_text(key: &str) -> Option<String> {
    crate::_rust_i18n_try_translate(&rust_i18n::locale(), key).map(std::borrow::Cow::into_owned)
}

#[cfg(test)]
mod tests;
