//! XML documents of programming tools: bounded, without a document type definition, and with places.

use alloc::boxed::Box;
use alloc::format;
use alloc::string::{String, ToString};
use alloc::vec::Vec;

use roxmltree::{Document, Error, ParsingOptions};

use super::remark::{Remark, RemarkKind};

/// Nodes of a document.
const MAX_NODES: u32 = 100_000;

/// Attributes of one element. The reader compares each with all others.
const MAX_ATTRIBUTES: usize = 1_000;

/// Declarations of name spaces in a document; no export of a programming tool has more than a few. The reader copies
/// them for every element inside.
const MAX_NAMESPACES: usize = 100;

/// A document, or what is wrong with it.
pub(super) fn parse(text: &str) -> Result<Document<'_>, Box<Remark>> {
    if let Some((at, words)) = crowded(text) {
        let (line, column) = Lines::new(text).place(at);
        let excerpt = text.get(at..).unwrap_or_default();
        return Err(Box::new(Remark::error(line, column, excerpt, RemarkKind::Told(words))));
    }
    let options = ParsingOptions { allow_dtd: false, nodes_limit: MAX_NODES, entity_resolver: None };
    Document::parse_with_options(text, options).map_err(|error| Box::new(not_xml(text, &error)))
}

/// The first element that would take too long to read, and why.
fn crowded(text: &str) -> Option<(usize, String)> {
    if let Some((at, _)) = text.match_indices("xmlns").nth(MAX_NAMESPACES) {
        let words = format!("a document has at most {MAX_NAMESPACES} name spaces; nothing of it was read");
        return Some((at, words));
    }
    let mut at = 0;
    while let Some(found) = text.get(at..).and_then(|rest| rest.find('<')) {
        let start = at + found;
        let rest = text.get(start..).unwrap_or_default();
        let special = [("<!--", "-->"), ("<![CDATA[", "]]>"), ("<?", "?>")];
        if let Some((_, close)) = special.into_iter().find(|(open, _)| rest.starts_with(open)) {
            at = start + rest.find(close)? + close.len();
            continue;
        }
        let (mut quote, mut attributes, mut length) = (None, 0, rest.len());
        for (place, byte) in rest.bytes().enumerate() {
            match byte {
                _ if quote == Some(byte) => quote = None,
                _ if quote.is_some() => {}
                b'"' | b'\'' => quote = Some(byte),
                b'=' => attributes += 1,
                b'>' => {
                    length = place + 1;
                    break;
                }
                _ => {}
            }
        }
        if attributes > MAX_ATTRIBUTES {
            let words = format!("an element has at most {MAX_ATTRIBUTES} attributes; nothing of it was read");
            return Some((start, words));
        }
        at = start + length;
    }
    None
}

/// Where the document ends to be XML, or to be of a bearable size.
fn not_xml(text: &str, error: &Error) -> Remark {
    let place = [error.pos().row, error.pos().col].map(|it| usize::try_from(it).unwrap_or(usize::MAX));
    let [line, column] = match error {
        // This error has no place of its own.
        Error::DtdDetected => [1 + text.lines().take_while(|line| !line.contains("<!DOCTYPE")).count(), 1],
        _ => place,
    };
    let excerpt = text.lines().nth(line.saturating_sub(1)).unwrap_or_default();
    let words = match error {
        Error::NodesLimitReached => {
            format!("a document has at most {MAX_NODES} nodes; nothing of it was read")
        }
        Error::DtdDetected => {
            "a document type definition (DTD) is not read, nor anything behind it".to_string()
        }
        error => format!("this is not XML: {error}"),
    };
    Remark::error(line, column, excerpt, RemarkKind::Told(words))
}

/// Where the lines of a text begin.
pub(super) struct Lines<'a> {
    text: &'a str,
    starts: Vec<usize>,
}

impl<'a> Lines<'a> {
    pub(super) fn new(text: &'a str) -> Self {
        let ends = text.bytes().enumerate().filter(|(_, byte)| *byte == b'\n').map(|(at, _)| at + 1);
        Self { text, starts: core::iter::once(0).chain(ends).collect() }
    }

    /// Line and column of a byte, both from 1.
    pub(super) fn place(&self, at: usize) -> (usize, usize) {
        let line = self.starts.partition_point(|start| *start <= at);
        let start = line.checked_sub(1).and_then(|line| self.starts.get(line)).copied().unwrap_or(0);
        let column = self.text.get(start..at).unwrap_or_default().chars().count();
        (line, column + 1)
    }

    /// How many there are.
    pub(super) fn count(&self) -> usize {
        self.starts.len()
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn what_would_take_minutes_to_read_is_refused_with_its_place() {
        let attributes: Vec<String> = (0..=MAX_ATTRIBUTES).map(|at| format!("a{at}='='")).collect();
        let text = format!("<!-- < {0} -->\n<a><![CDATA[< {0}]]><b {0}/></a>", attributes.join(" "));
        let remark = parse(&text).unwrap_err();
        assert_eq!(remark.line, 2);
        assert!(remark.to_string().contains("1000 attributes"), "{remark}");
        let text = text.replace("<b ", "<b/><!-- ").replace("/></a>", "--></a>");
        assert!(parse(&text).is_ok());
        let spaces: Vec<String> = (0..=MAX_NAMESPACES).map(|at| format!("<a xmlns:n{at}='u'>")).collect();
        assert!(parse(&spaces.concat()).unwrap_err().to_string().contains("100 name spaces"));
    }
}
