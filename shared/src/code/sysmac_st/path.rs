//! Request paths.

use alloc::format;
use alloc::string::{String, ToString};
use alloc::vec::Vec;

use super::block::Block;
use super::{SEGMENTS, width};
use crate::code::change::{Change, Grade, Why};
use crate::code::message::spaced;
use crate::code::remark::RemarkKind;
use crate::config::MsgCipGeneric;
use crate::plan::{MessagePlan, Severity};
use crate::wire::LogicalKind;

/// What a segment is, its number, and how wide that is.
pub(super) type Segment = (LogicalKind, u32, String);

impl Block<'_, '_, '_> {
    /// Class, instance and attribute; and the widths of their segments, if they are known.
    pub(super) fn path(&mut self, config: &mut MsgCipGeneric) -> Vec<Segment> {
        let app = &mut config.app_cfg;
        (app.class, app.instance, app.attribute) = (0, 0, 0);
        let Some(key) = self.site.key("RqPath") else { return Vec::new() };
        let reading = &mut self.reading;
        let known: Vec<&str> = SEGMENTS.iter().flat_map(|(n, f)| [*n, *f]).chain(["isAttributeID"]).collect();
        reading.unknown(&key, &known);
        let kind = self.types.get(&key).map(|kind| kind.name.to_ascii_lowercase());
        let formats =
            SEGMENTS.iter().any(|(_, format)| reading.has(&format!("{key}.{}", format.to_ascii_lowercase())));
        let extended = kind.map_or(formats, |kind| kind == "_srequest_path_ex");
        let has_attribute =
            reading.truth(&format!("{key}.isattributeid"), "isAttributeID").unwrap_or_default();
        let unused = reading.integer(&format!("{key}.attributeid"), "RqPath.AttributeID", 0, 65_535);
        if !has_attribute && unused.is_some_and(|attribute| attribute != 0) {
            let words = "RqPath.AttributeID is not sent: isAttributeID is not TRUE";
            reading.say(Severity::Warning, RemarkKind::told(&words));
        }
        let kinds = [LogicalKind::Class, LogicalKind::Instance, LogicalKind::Attribute];
        let mut widths = Vec::new();
        let mut values = [0_i64; 3];
        for (((name, format), kind), slot) in SEGMENTS.iter().zip(kinds).zip(&mut values) {
            if kind == LogicalKind::Attribute && !has_attribute {
                continue;
            }
            let value_key = format!("{key}.{}", name.to_ascii_lowercase());
            if !reading.has(&value_key) {
                reading.say(Severity::Error, RemarkKind::Missing(format!("RqPath.{name}")));
            }
            let high = if kind == LogicalKind::Instance { 4_294_967_295 } else { 65_535 };
            let value = reading.integer(&value_key, &format!("RqPath.{name}"), 0, high).unwrap_or_default();
            *slot = value;
            let value = u32::try_from(value).unwrap_or(0);
            let told = reading.word(&format!("{key}.{}", format.to_ascii_lowercase()));
            let width = match told {
                Some(told) => told.rsplit('#').next().unwrap_or_default().to_ascii_uppercase(),
                None if extended => {
                    let words = format!("RqPath.{format} is not set: taken as _8BIT");
                    reading.say(Severity::Warning, RemarkKind::Told(words));
                    "_8BIT".to_string()
                }
                None => "_16BIT".to_string(),
            };
            if !matches!(width.as_str(), "_8BIT" | "_16BIT" | "_32BIT") {
                reading.say(Severity::Error, RemarkKind::NotConstant(format!("RqPath.{format}")));
            }
            if width == "_8BIT" && value > 0xFF || width == "_16BIT" && value > 0xFFFF {
                let words = format!(
                    "RqPath.{name} {value} does not fit into {width}: it is sent in {}",
                    self::width(value)
                );
                reading.say(Severity::Warning, RemarkKind::Told(words));
            }
            widths.push((kind, value, width));
        }
        [app.class, app.instance, app.attribute] = values;
        widths
    }

    /// Segments of other widths are other bytes.
    pub(super) fn compare(&mut self, config: &MsgCipGeneric, widths: Vec<Segment>) {
        let Some(plan) = MessagePlan::parse(config).0 else { return };
        let mut path = Vec::new();
        for (kind, value, width) in widths {
            let bytes = value.to_le_bytes();
            match width.as_str() {
                "_8BIT" => path.extend([kind.code(), bytes[0]]),
                "_16BIT" => path.extend([kind.code() | 1, 0, bytes[0], bytes[1]]),
                _ => path.extend([kind.code() | 2, 0, bytes[0], bytes[1], bytes[2], bytes[3]]),
            }
        }
        if path != plan.request().path().bytes() {
            let (from, to) = (spaced(&path), spaced(&plan.request().path().bytes()));
            let change = Change::new(&"path", &from, &to, Grade::Request, Why::SegmentWidths);
            self.reading.say(Severity::Warning, RemarkKind::Change(change));
        }
    }
}
