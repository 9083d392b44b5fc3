//! Blocks as they are stored, one or an array of them. Ids and revisions belong to the relay that gave them: they are
//! neither written nor read.

use alloc::format;
use alloc::string::{String, ToString};
use alloc::vec::Vec;
use core::ops::Range;

use serde_json::{Map, Value};

use super::dialect::Dialect;
use super::remark::{Remark, RemarkKind};
use super::{Code, Found, Imported};
use crate::config::{BlockConfig, project};

/// A block as JSON, in the order of its members.
pub(super) fn export(block: &BlockConfig) -> Code {
    let mut block = block.clone();
    let extra = match &mut block {
        BlockConfig::MsgCipGeneric(config) => &mut config.extra,
        BlockConfig::SendReq(config) => &mut config.extra,
    };
    extra.remove("id");
    extra.remove("revision");
    // A block has neither maps with other keys than texts nor numbers that JSON does not know.
    let mut text = serde_json::to_string_pretty(&block).unwrap_or_default();
    text.push('\n');
    Code { text, changes: Vec::new() }
}

/// Blocks from JSON. A block that cannot be read does not keep those beside it from being read.
pub(super) fn import(text: &str) -> Imported {
    let mut imported = Imported::default();
    if let Err(error) = serde_json::from_str::<serde::de::IgnoredAny>(text) {
        imported.remarks.push(unreadable(text, &error));
        return imported;
    }
    let mut lines = Lines { text, at: 0, line: 1 };
    for range in elements(text) {
        let element = text.get(range.clone()).unwrap_or_default();
        let (first, last) = (lines.at(range.start), lines.at(range.end));
        match read(element) {
            Ok(config) => imported.blocks.push(Found {
                config,
                dialect: Dialect::Json,
                lines: first..last + 1,
                remarks: Vec::new(),
            }),
            Err(words) => {
                let words = format!("not a block: {words}");
                imported.remarks.push(Remark::error(first, 1, element, RemarkKind::Told(words)));
            }
        }
        if imported.is_full() {
            break;
        }
    }
    if imported.blocks.is_empty() && imported.remarks.is_empty() {
        let words = "a block is an object: { \"name\": …, \"kind\": …, … }";
        imported.remarks.push(Remark::error(1, 1, text, RemarkKind::told(&words)));
    }
    imported
}

fn read(element: &str) -> Result<BlockConfig, String> {
    if !element.starts_with('{') {
        return Err("it is no object".to_string());
    }
    // Which of two members counts is not for a machine to decide.
    if let Some(name) = project::twice(element) {
        return Err(format!("the member `{name}` is there twice"));
    }
    let mut members: Map<String, Value> = serde_json::from_str(element).map_err(|error| error.to_string())?;
    members.remove("id");
    members.remove("revision");
    BlockConfig::from_members(members)
}

/// What is in the outermost array, or all of the text if it is none. The text is JSON.
fn elements(text: &str) -> Vec<Range<usize>> {
    let whole = text.len() - text.trim_start().len()..text.trim_end().len();
    if !text.trim_start().starts_with('[') {
        return alloc::vec![whole];
    }
    let mut elements = Vec::new();
    let mut add = |range: Range<usize>| {
        let inside = text.get(range.clone()).unwrap_or_default();
        let start = range.start + inside.len() - inside.trim_start().len();
        elements.extend((!inside.trim().is_empty()).then(|| start..start + inside.trim().len()));
    };
    let (mut depth, mut start) = (0_usize, 0);
    let (mut in_string, mut escaped) = (false, false);
    for (at, byte) in text.bytes().enumerate() {
        match byte {
            _ if escaped => escaped = false,
            b'\\' if in_string => escaped = true,
            b'"' => in_string = !in_string,
            _ if in_string => {}
            b'{' | b'[' => {
                depth += 1;
                start = if depth == 1 { at + 1 } else { start };
            }
            b'}' | b']' => {
                depth = depth.saturating_sub(1);
                if depth == 0 {
                    add(start..at);
                }
            }
            b',' if depth == 1 => {
                add(start..at);
                start = at + 1;
            }
            _ => {}
        }
    }
    elements
}

/// The lines of places that come one after the other.
struct Lines<'a> {
    text: &'a str,
    at: usize,
    line: usize,
}

impl Lines<'_> {
    /// From 1; of a place that is not before the last one.
    fn at(&mut self, at: usize) -> usize {
        self.line += self.text.get(self.at..at).unwrap_or_default().matches('\n').count();
        self.at = at.max(self.at);
        self.line
    }
}

/// With the place that the error names.
fn unreadable(text: &str, error: &serde_json::Error) -> Remark {
    let excerpt = text.lines().nth(error.line().saturating_sub(1)).unwrap_or_default();
    let words = error.to_string();
    let words = words.split(" at line ").next().unwrap_or_default();
    let what = RemarkKind::Told(format!("not JSON: {words}"));
    Remark::error(error.line().max(1), error.column().max(1), excerpt, what)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::config::MsgCipGeneric;

    #[test]
    fn a_block_with_a_member_that_is_there_twice_is_none() {
        let text = export(&MsgCipGeneric::product_name("4,10.0.0.1").into()).text;
        let twice = text.replace("\"Class\": 1,", "\"Class\": 147,\n    \"Class\": 1,");
        let imported = import(&format!("[\n{text},\n{twice}]"));
        let told: Vec<String> = imported.remarks.iter().map(ToString::to_string).collect();
        assert_eq!(told.len(), 1, "{told:?}");
        assert!(told[0].contains("not a block: the member `Class` is there twice: "), "{told:?}");
        assert_eq!(imported.blocks.len(), 1);
    }

    #[test]
    fn a_block_goes_out_without_its_id_and_comes_back() {
        let mut config = MsgCipGeneric::product_name("4,10.0.0.1");
        config.extra.insert("Colour".into(), "red".into());
        config.extra.insert("id".into(), "b7".into());
        let text = export(&config.clone().into()).text;
        assert!(text.ends_with("}\n") && !text.contains("b7"), "{text}");
        config.extra.remove("id");
        let read = import(&text);
        assert_eq!((read.blocks[0].config.clone(), read.blocks[0].lines.start), (config.into(), 1));
        assert_eq!(read.remarks, []);
    }

    #[test]
    fn several_blocks_are_read_beside_one_that_is_none() {
        let one = export(&MsgCipGeneric::product_name("0,0").into()).text;
        let marked = one.replacen('{', "{\"id\":\"b1\",\"revision\":7,", 1);
        let text = format!("[\n{one},\n{{\"name\": [\"}}]\\\"\"]}},\n{marked}\n]");
        let read = import(&text);
        assert_eq!(read.blocks.len(), 2);
        assert_eq!(read.blocks[0].config, read.blocks[1].config);
        let line = one.lines().count() + 3;
        assert_eq!((read.remarks.len(), read.remarks[0].line), (1, line), "{:?}", read.remarks);
    }

    #[test]
    fn what_is_beside_a_block_is_told() {
        let one = export(&MsgCipGeneric::product_name("0,0").into()).text;
        let read = import(&format!("[\n{one},\n7, \"a,b\",\n[{one}]\n]"));
        let told: Vec<usize> = read.remarks.iter().map(|remark| remark.line).collect();
        let line = one.lines().count() + 3;
        assert_eq!((read.blocks.len(), told), (1, alloc::vec![line, line, line + 1]));
        assert!(read.remarks[0].to_string().contains("it is no object"), "{}", read.remarks[0]);
    }

    #[test]
    fn what_is_no_json_is_told_where_it_ends_to_be() {
        let read = import("{\n \"name\": x\n}");
        assert_eq!((read.remarks[0].line, read.remarks[0].column), (2, 10), "{}", read.remarks[0]);
        for text in ["", " ", "7", "[]", "[7]", "\"x\"", "{", "[[{}]]"] {
            assert_eq!((import(text).blocks.len(), import(text).remarks.len()), (0, 1), "{text}");
        }
        let deep = "[".repeat(100_000);
        assert_eq!(import(&deep).remarks.len(), 1);
    }
}
