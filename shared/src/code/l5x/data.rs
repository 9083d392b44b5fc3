//! The data of a tag as the bytes that a `MESSAGE` sends of it.

use alloc::string::{String, ToString};
use alloc::vec::Vec;

use roxmltree::Node;

/// `Name[3]`: the tag, and the element that is meant.
pub(super) fn element(text: &str) -> Option<(&str, usize)> {
    let Some((name, rest)) = text.split_once('[') else { return Some((text, 0)) };
    let index = rest.strip_suffix(']')?.parse().ok()?;
    Some((name, index))
}

/// Bytes of one element of a type that has no padding.
pub(super) fn element_size(data_type: &str) -> Option<usize> {
    Some(match data_type {
        "SINT" | "USINT" => 1,
        "INT" | "UINT" => 2,
        "DINT" | "UDINT" | "REAL" => 4,
        "LINT" | "ULINT" | "LREAL" => 8,
        _ => return None,
    })
}

/// Bytes of a whole tag: one element, or as many as its dimensions say.
pub(super) fn size(tag: Node<'_, '_>) -> Option<usize> {
    let size = element_size(tag.attribute("DataType")?)?;
    let mut elements: usize = 1;
    for dimension in tag.attribute("Dimensions").unwrap_or_default().split_whitespace() {
        elements = elements.checked_mul(dimension.parse().ok()?)?;
    }
    elements.checked_mul(size)
}

/// All bytes of a tag, as its export shows them: decorated, as L5K, or raw. An error says what of it cannot be read.
pub(super) fn bytes(tag: Node<'_, '_>) -> Result<Vec<u8>, String> {
    let name = tag.attribute("DataType").unwrap_or_default();
    if element_size(name).is_none() {
        return Err(alloc::format!("data of type {name}"));
    }
    let formats = || tag.children().filter(|child| child.has_tag_name("Data"));
    let format = |format: Option<&str>| formats().find(|data| data.attribute("Format") == format);
    if let Some(decorated) = format(Some("Decorated")) {
        return decorated
            .descendants()
            .filter(|node| node.has_tag_name("Element") || node.has_tag_name("DataValue"))
            .map(|node| node.attribute("Value").unwrap_or_default())
            .map(|value| literal(value, name).ok_or_else(|| value.to_string()))
            .collect::<Result<Vec<Vec<u8>>, String>>()
            .map(|elements| elements.concat());
    }
    let text = |data: Node<'_, '_>| -> String { data.children().filter_map(|node| node.text()).collect() };
    if let Some(l5k) = format(Some("L5K")) {
        let text = text(l5k);
        let list = text.trim().trim_start_matches('[').trim_end_matches(']');
        let elements = list.split(',').map(str::trim);
        return elements
            .map(|value| literal(value, name).ok_or_else(|| value.to_string()))
            .collect::<Result<Vec<Vec<u8>>, String>>()
            .map(|elements| elements.concat());
    }
    let raw = format(None).map(text).ok_or_else(|| "no data".to_string())?;
    crate::config::read_hex(&raw).map_err(|_| raw)
}

/// A number as Logix writes it: `-1`, `16#00ff`, `2#1010_0101`, `8#377`, `'a'`, `1.5`.
pub(super) fn literal(text: &str, data_type: &str) -> Option<Vec<u8>> {
    match data_type {
        "REAL" => return Some(text.parse::<f32>().ok()?.to_le_bytes().to_vec()),
        "LREAL" => return Some(text.parse::<f64>().ok()?.to_le_bytes().to_vec()),
        _ => {}
    }
    let size = element_size(data_type)?;
    let value = match text.split_once('#') {
        Some((radix, digits)) => {
            let radix = radix.parse().ok().filter(|radix| matches!(radix, 2 | 8 | 16))?;
            i128::from(u64::from_str_radix(&digits.replace('_', ""), radix).ok()?)
        }
        None => match text.strip_prefix('\'').and_then(|text| text.strip_suffix('\'')) {
            Some(character) => i128::from(character_code(character)?),
            None => text.parse().ok()?,
        },
    };
    let bits = 8 * u32::try_from(size).ok()?;
    let fits = (-(1_i128 << (bits - 1))..1_i128 << bits).contains(&value);
    fits.then(|| value.to_le_bytes().into_iter().take(size).collect())
}

/// `a`, or `$0D`.
fn character_code(text: &str) -> Option<u8> {
    match text.strip_prefix('$') {
        Some(code) if code.len() == 2 => u8::from_str_radix(code, 16).ok(),
        Some(_) => None,
        None => u8::try_from(text.parse::<char>().ok()?).ok().filter(u8::is_ascii),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn numbers_are_read_in_every_radix() {
        for (text, data_type, bytes) in [
            ("-1", "SINT", Some(&[0xFF][..])),
            ("16#ff", "SINT", Some(&[0xFF])),
            ("200", "SINT", Some(&[200])),
            ("256", "SINT", None),
            ("-129", "SINT", None),
            ("2#1010_0101", "SINT", Some(&[0xA5])),
            ("8#377", "INT", Some(&[0xFF, 0])),
            ("16#0000_04d2", "DINT", Some(&[0xD2, 4, 0, 0])),
            ("'$0D'", "SINT", Some(&[13])),
            ("'A'", "SINT", Some(&[65])),
            ("1.5", "REAL", Some(&[0, 0, 0xC0, 0x3F])),
            ("1.5", "DINT", None),
            ("3#12", "DINT", None),
            ("1", "STRING", None),
        ] {
            assert_eq!(literal(text, data_type).as_deref(), bytes, "{text} {data_type}");
        }
    }

    #[test]
    fn an_element_is_a_tag_and_an_index() {
        assert_eq!(element("Req[3]"), Some(("Req", 3)));
        assert_eq!(element("Req"), Some(("Req", 0)));
        assert_eq!((element("Req[i]"), element("Req[1,2]"), element("Req[0].x")), (None, None, None));
    }
}
