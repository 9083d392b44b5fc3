//! The bytes of a request for the message router, in any of the spellings that people paste.
//!
//! One request in each line; a line that ends with a comma goes on in the next one, and the lines of a dump with
//! offsets belong together.

mod line;

use alloc::format;
use alloc::string::String;
use alloc::vec::Vec;
use core::ops::Range;

use super::change::{Change, Grade, Why};
use super::convert::to_msg::object;
use super::dialect::Dialect;
use super::header::comment;
use super::message::{Message, Tells, spaced};
use super::remark::{Remark, RemarkKind};
use super::{Code, Found, Imported};
use crate::config::{BlockConfig, MsgCipGeneric, write_hex};
use crate::plan::MessagePlan;
use crate::wire::MessageRouterRequest;

pub(super) use self::line::is_hex;
use self::line::{Line, read};

/// The bytes, and what they are in a comment.
pub(super) fn export(block: &BlockConfig) -> Code {
    let message = match Message::of(block) {
        Ok(message) => message,
        Err(code) => return code,
    };
    let mut changes = message.untold(Tells::default());
    let target = &message.config.target_cfg;
    let mut lost = |is_set: bool, member: &str, from: String| {
        if is_set {
            changes.push(Change::new(&member, &from, &"", Grade::Lost, Why::NoSuchMember));
        }
    };
    lost(message.endpoint().is_some(), "TargetCfg.Path", target.path.clone());
    let connection = message.plan.connection();
    lost(connection.is_some(), "TargetCfg.CipConnMode", "1".into());
    let ucmm = message.plan.ucmm_timeout_ms();
    lost(ucmm != 3000, "TargetCfg.UcmmTimeout", format!("{ucmm}"));
    if let Some(connection) = connection {
        lost(
            connection.timeout_ms != 10_000,
            "TargetCfg.ConnMsgTimeout",
            format!("{}", connection.timeout_ms),
        );
        lost(connection.close, "TargetCfg.ConnClose", "TRUE".into());
    }
    let app = &message.config.app_cfg;
    let about = format!(
        "{}: service {}, class {}, instance {}, attribute {}, {} bytes of data",
        block.name(),
        message.service_words(),
        message.class_words(),
        app.instance,
        app.attribute,
        message.data().len(),
    );
    Code { text: format!("{}{}\n", comment(Dialect::Hex, &about), spaced(message.plan.bytes())), changes }
}

/// Whether a line is a whole request to an object.
pub(super) fn is_request(text: &str) -> bool {
    let Line::Bytes { bytes, .. } = read(text, 0, false) else { return false };
    MessageRouterRequest::decode(&bytes).is_ok_and(|request| {
        request.service().0 != 0 && object(request.path(), &mut MsgCipGeneric::product_name(""))
    })
}

/// Blocks from lines of bytes.
pub(super) fn import(text: &str) -> Imported {
    let mut imported = Imported::default();
    let mut open = Request::default();
    for (line, content) in (1..).zip(text.lines()) {
        match read(content, open.bytes.len(), open.goes_on) {
            Line::Nothing => open.close(&mut imported),
            Line::Wrong(column, what) => {
                open.close(&mut imported);
                imported.remarks.push(Remark::error(line, column, content, what));
            }
            Line::Bytes { bytes, offset, goes_on } => {
                // The first line of a dump, and every line without an offset, is a request of its own.
                if !(open.goes_on || offset.is_some_and(|offset| offset > 0)) {
                    open.close(&mut imported);
                }
                open.add(line, content, &bytes);
                open.goes_on = goes_on;
                if offset.is_none() && !goes_on {
                    open.close(&mut imported);
                }
            }
        }
        if imported.is_full() {
            break;
        }
    }
    open.close(&mut imported);
    imported
}

/// The bytes so far, and their lines.
#[derive(Default)]
struct Request {
    bytes: Vec<u8>,
    lines: Range<usize>,
    excerpt: String,
    goes_on: bool,
}

impl Request {
    fn add(&mut self, line: usize, content: &str, bytes: &[u8]) {
        if self.bytes.is_empty() {
            self.lines.start = line;
            self.excerpt = content.into();
        }
        self.lines.end = line + 1;
        self.bytes.extend_from_slice(bytes);
    }

    fn close(&mut self, imported: &mut Imported) {
        let Self { bytes, lines, excerpt, .. } = core::mem::take(self);
        if bytes.is_empty() {
            return;
        }
        let number = imported.blocks.len() + 1;
        match block(&bytes, lines.start, &excerpt, number) {
            Ok((config, remarks)) => {
                imported.blocks.push(Found { config: config.into(), dialect: Dialect::Hex, lines, remarks });
            }
            Err(what) => imported.remarks.push(Remark::error(lines.start, 1, &excerpt, what)),
        }
    }
}

/// A block that sends these bytes, and how far it does.
fn block(
    bytes: &[u8],
    line: usize,
    excerpt: &str,
    number: usize,
) -> Result<(MsgCipGeneric, Vec<Remark>), RemarkKind> {
    let request = MessageRouterRequest::decode(bytes)
        .map_err(|error| RemarkKind::Told(format!("no request for a message router: {error}")))?;
    let mut config = MsgCipGeneric::product_name("0,0");
    config.name = format!("request-{number}");
    config.app_cfg.service = request.service().0.into();
    config.req_data = write_hex(request.data());
    let mut remarks = Vec::new();
    let told = object(request.path(), &mut config);
    let sent = MessagePlan::parse(&config).0.map(|plan| plan.bytes().to_vec());
    match sent {
        Some(sent) if sent == bytes => {}
        Some(sent) if told => {
            let why = Why::SegmentWidths;
            let change = Change::new(&"request", &spaced(bytes), &spaced(&sent), Grade::Request, why);
            remarks.push(Remark::warning(line, 1, excerpt, RemarkKind::Change(change)));
        }
        _ if !told => {
            let words = "a MSG_CIPGENERIC sends to a class, an instance, an attribute and up to 3 members, in this order";
            return Err(RemarkKind::told(&words));
        }
        // The block has findings of its own.
        _ => {}
    }
    remarks.push(Remark::warning(line, 1, excerpt, RemarkKind::NoDevice));
    Ok((config, remarks))
}

#[cfg(test)]
mod tests;
