//! A text without its comments, by rules of its own: nothing of what is tested is used here.

use cipdeck_shared::code::Dialect;

/// What begins and ends a comment, and which quotes keep one from beginning.
struct Rules {
    line: &'static [&'static str],
    block: &'static [(&'static str, &'static str)],
    quotes: &'static [char],
    escape: char,
}

pub(crate) fn without_comments(dialect: Dialect, text: &str) -> String {
    let rules = match dialect {
        Dialect::Json => return text.to_owned(),
        Dialect::L5x => return without_xml_comments(text),
        Dialect::CcwSt
        | Dialect::SendReqEtc100
        | Dialect::SendReqEtc101
        | Dialect::DataExch
        | Dialect::SysmacSt => {
            Rules { line: &["//"], block: &[("(*", "*)"), ("/*", "*/")], quotes: &['\'', '"'], escape: '$' }
        }
        Dialect::Rust => Rules { line: &["//"], block: &[("/*", "*/")], quotes: &['"'], escape: '\\' },
        Dialect::Pycomm3 => Rules { line: &["#"], block: &[], quotes: &['\'', '"'], escape: '\\' },
        Dialect::Cli => Rules { line: &["#"], block: &[], quotes: &['\'', '"'], escape: '\0' },
        Dialect::Hex => Rules { line: &["#", "//"], block: &[], quotes: &[], escape: '\0' },
    };
    let mut plain = String::new();
    let mut rest = text;
    let mut quote = None;
    while let Some(c) = rest.chars().next() {
        let mut length = c.len_utf8();
        if let Some(open) = quote {
            if c == rules.escape {
                length += rest[length..].chars().next().map_or(0, char::len_utf8);
            } else if c == open {
                quote = None;
            }
            plain.push_str(&rest[..length]);
        } else if rules.line.iter().any(|open| rest.starts_with(open)) {
            length = rest.find('\n').unwrap_or(rest.len());
        } else if let Some((open, close)) = rules.block.iter().find(|(open, _)| rest.starts_with(open)) {
            length = rest[open.len()..].find(close).map_or(rest.len(), |end| open.len() + end + close.len());
            plain.push(' ');
        } else {
            if rules.quotes.contains(&c) {
                quote = Some(c);
            }
            plain.push(c);
        }
        rest = &rest[length..];
    }
    plain
}

/// `<!-- … -->`, and what Studio 5000 keeps for people: descriptions of tags and comments of rungs.
fn without_xml_comments(text: &str) -> String {
    const CDATA: (&str, &str) = ("<![CDATA[", "]]>");
    let mut plain = String::new();
    let mut rest = text;
    let mut closing: Option<&str> = None;
    while let Some(c) = rest.chars().next() {
        let to = |close: &str| rest.find(close).map_or(rest.len(), |end| end + close.len());
        let mut length = c.len_utf8();
        let mut keep = closing.is_none();
        if rest.starts_with(CDATA.0) {
            length = to(CDATA.1);
        } else if let Some(close) = closing {
            if rest.starts_with(close) {
                (length, closing) = (close.len(), None);
            }
        } else if rest.starts_with("<!--") {
            (length, keep) = (to("-->"), false);
        } else if rest.starts_with("<Description>") {
            (closing, keep) = (Some("</Description>"), false);
        } else if rest.starts_with("<Comment>") {
            (closing, keep) = (Some("</Comment>"), false);
        }
        if keep {
            plain.push_str(&rest[..length]);
        }
        rest = &rest[length..];
    }
    plain
}
