//! What is behind the question mark of a request.

/// `?event=run&from=2026-11-22`: only what is not empty.
pub(crate) fn query(pairs: &[(&str, &str)]) -> String {
    let mut text = String::new();
    for (name, value) in pairs.iter().filter(|(_, value)| !value.is_empty()) {
        text.push(if text.is_empty() { '?' } else { '&' });
        text += name;
        text.push('=');
        text += &String::from(js_sys::encode_uri_component(value));
    }
    text
}
