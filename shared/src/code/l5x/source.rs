//! The tags of a `MESSAGE`: what it sends, and how much it takes.

use alloc::format;
use alloc::string::String;
use alloc::vec::Vec;

use roxmltree::Node;

use super::super::remark::RemarkKind;
use super::data::{self, Operand};
use super::parameters::Parameters;
use crate::config::{MsgCipGeneric, write_hex};
use crate::plan::Severity;
use crate::plan::limits::MAX_RESPONSE_DATA;

/// Aliases of aliases.
const MAX_ALIASES: usize = 8;

impl<'a, 'i> Parameters<'_, 'a, 'i> {
    pub(super) fn request(&mut self, config: &mut MsgCipGeneric) {
        let length = self.number("RequestedLength", true);
        let Some(source) = self.attribute("LocalElement").filter(|_| length != 0) else {
            if length != 0 {
                self.say(Severity::Error, RemarkKind::Missing("LocalElement".into()));
                // Not sendable like this, and said so by its findings.
                config.req_length = Some(length);
            }
            return;
        };
        match self.source(source, length) {
            Ok(bytes) => config.req_data = write_hex(&bytes),
            Err(what) => {
                let words = format!("the data of LocalElement {source} is not known ({what}): write ReqData");
                self.told(Severity::Error, &words);
                config.req_length = Some(length);
            }
        }
    }

    /// So many bytes from an element on.
    fn source(&mut self, text: &str, length: i64) -> Result<Vec<u8>, String> {
        let (tag, operand) = self.operand(text)?;
        let whole = data::member(tag, &operand)?;
        let size = data::element_size(whole.attribute("DataType").unwrap_or_default()).unwrap_or(1);
        let bytes = data::bytes(tag, whole)?;
        let from = operand.index.saturating_mul(size);
        let to = from.saturating_add(usize::try_from(length).map_err(|_| "a negative length")?);
        let found = bytes.len().saturating_sub(from);
        bytes.get(from..to).map(<[u8]>::to_vec).ok_or_else(|| format!("{found} bytes of {length}"))
    }

    /// The tag of an operand. An alias stands for another one.
    fn operand<'t>(&mut self, text: &'t str) -> Result<(Node<'a, 'i>, Operand<'t>), String>
    where
        'a: 't,
    {
        let no_tag = "no such tag in this file";
        let mut operand = Operand::read(text).ok_or("not an element of a tag")?;
        let mut tag = self.project.tag(&self.scope, operand.tag).ok_or(no_tag)?;
        for _ in 0..MAX_ALIASES {
            self.used.push(tag.id());
            let Some(alias) = tag.attribute("AliasFor") else { break };
            let other = Operand::read(alias).ok_or("not an element of a tag")?;
            tag = self.project.tag(&self.scope, other.tag).ok_or(no_tag)?;
            operand = operand.behind(other).ok_or("an element of an element")?;
        }
        Ok((tag, operand))
    }

    pub(super) fn res_data_size(&mut self) -> i64 {
        let Some(text) = self.attribute("DestinationTag").filter(|text| !text.is_empty()) else {
            return MAX_RESPONSE_DATA;
        };
        match self.room(text) {
            Some(size @ 1..=MAX_RESPONSE_DATA) => size,
            Some(size) => {
                let words =
                    format!("DestinationTag {text} has {size} bytes: ResDataSize is {MAX_RESPONSE_DATA}");
                self.told(Severity::Note, &words);
                MAX_RESPONSE_DATA
            }
            None => {
                let words = format!(
                    "the size of DestinationTag {text} is not known: ResDataSize is {MAX_RESPONSE_DATA}"
                );
                self.told(Severity::Note, &words);
                MAX_RESPONSE_DATA
            }
        }
    }

    /// Bytes from an element to the end of its array.
    fn room(&mut self, text: &str) -> Option<i64> {
        let (tag, operand) = self.operand(text).ok()?;
        let whole = data::member(tag, &operand).ok()?;
        let element = data::element_size(whole.attribute("DataType")?)?;
        i64::try_from(data::size(whole)?.checked_sub(operand.index.checked_mul(element)?)?).ok()
    }
}
