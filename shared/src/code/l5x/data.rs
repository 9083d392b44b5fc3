//! The data of a tag as the bytes that a `MESSAGE` sends of it.

use alloc::string::{String, ToString};
use alloc::vec::Vec;

use roxmltree::Node;

/// `Name.member[3]`: the tag, what of it, and the element that is meant.
#[derive(Clone, Debug, PartialEq, Eq)]
pub(super) struct Operand<'t> {
    pub(super) tag: &'t str,
    members: Vec<&'t str>,
    pub(super) index: usize,
}

impl<'t> Operand<'t> {
    /// `None`: an index is no number, or not the last thing.
    pub(super) fn read(text: &'t str) -> Option<Self> {
        let (names, index) = match text.split_once('[') {
            Some((names, rest)) => (names, rest.strip_suffix(']')?.parse().ok()?),
            None => (text, 0),
        };
        let mut names = names.split('.');
        Some(Self { tag: names.next()?, members: names.collect(), index })
    }

    /// What it is where its tag is an alias for that. `None`: both have an index.
    pub(super) fn behind(self, other: Self) -> Option<Self> {
        let index = match (self.index, other.index) {
            (index, 0) => index,
            // An element has no members here.
            (0, index) if self.members.is_empty() => index,
            _ => return None,
        };
        let members = other.members.into_iter().chain(self.members).collect();
        Some(Self { tag: other.tag, members, index })
    }
}

/// The part of a tag that an operand names: the tag itself, or a member in its decorated data. An error says what
/// of it is not known.
pub(super) fn member<'a, 'i>(tag: Node<'a, 'i>, operand: &Operand<'_>) -> Result<Node<'a, 'i>, String> {
    if operand.members.is_empty() {
        return Ok(tag);
    }
    let decorated = tag.children().find(|data| data.attribute("Format") == Some("Decorated"));
    let mut part = decorated.and_then(|data| data.first_element_child()).ok_or("no data of its members")?;
    for name in &operand.members {
        let is_it =
            |node: &Node<'_, '_>| node.attribute("Name").is_some_and(|it| it.eq_ignore_ascii_case(name));
        part = part.children().find(is_it).ok_or_else(|| alloc::format!("no member {name}"))?;
    }
    Ok(part)
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

/// Bytes of a whole tag or member: one element, or as many as its dimensions say.
pub(super) fn size(whole: Node<'_, '_>) -> Option<usize> {
    let size = element_size(whole.attribute("DataType")?)?;
    let mut elements: usize = 1;
    let dimensions = whole.attribute("Dimensions").unwrap_or_default();
    for dimension in dimensions.split([' ', ',']).filter(|dimension| !dimension.is_empty()) {
        elements = elements.checked_mul(dimension.parse().ok()?)?;
    }
    elements.checked_mul(size)
}

/// All bytes of a tag, or of a member of it, as the export shows them: decorated, as L5K, or raw. An error says what of
/// it cannot be read.
pub(super) fn bytes(tag: Node<'_, '_>, whole: Node<'_, '_>) -> Result<Vec<u8>, String> {
    let name = whole.attribute("DataType").unwrap_or_default();
    if element_size(name).is_none() {
        return Err(alloc::format!("data of type {name}"));
    }
    let formats = || tag.children().filter(|child| child.has_tag_name("Data"));
    let format = |format: Option<&str>| formats().find(|data| data.attribute("Format") == format);
    let decorated = if whole == tag { format(Some("Decorated")) } else { Some(whole) };
    if let Some(decorated) = decorated {
        return decorated
            .descendants()
            .filter(|node| ["Element", "DataValue", "DataValueMember"].contains(&node.tag_name().name()))
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
    fn an_operand_is_a_tag_its_members_and_an_index() {
        let read = |text: &'static str| Operand::read(text).map(|it| (it.tag, it.members, it.index));
        assert_eq!(read("Req[3]"), Some(("Req", alloc::vec![], 3)));
        assert_eq!(read("Cmd.Data[2]"), Some(("Cmd", alloc::vec!["Data"], 2)));
        assert_eq!((read("Req[i]"), read("Req[1,2]"), read("Req[0].x")), (None, None, None));
        let behind = |text, alias| Operand::read(text).unwrap().behind(Operand::read(alias).unwrap());
        assert_eq!(behind("A[3]", "Req"), Operand::read("Req[3]"));
        assert_eq!(behind("A", "Req.Data[3]"), Operand::read("Req.Data[3]"));
        assert_eq!(behind("A.Data[1]", "Req"), Operand::read("Req.Data[1]"));
        assert_eq!(behind("A[3]", "Req[2]"), None);
    }
}
