//! XML documents of programming tools: bounded, without a document type definition, and with places.

use alloc::boxed::Box;
use alloc::format;
use alloc::string::ToString;
use alloc::vec::Vec;

use roxmltree::{Document, Error, ParsingOptions};

use super::remark::{Remark, RemarkKind};

/// Nodes of a document.
const MAX_NODES: u32 = 100_000;

/// A document, or what is wrong with it.
pub(super) fn parse(text: &str) -> Result<Document<'_>, Box<Remark>> {
    let options = ParsingOptions { allow_dtd: false, nodes_limit: MAX_NODES, entity_resolver: None };
    Document::parse_with_options(text, options).map_err(|error| Box::new(not_xml(text, &error)))
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
