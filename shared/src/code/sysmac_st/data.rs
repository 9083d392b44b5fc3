//! What is sent, and where the answer goes.

use alloc::format;
use alloc::string::String;
use alloc::vec::Vec;

use super::block::Block;
use crate::code::remark::RemarkKind;
use crate::code::text::{Declared, Expression, Reference, Step};
use crate::config::{MsgCipGeneric, write_hex};
use crate::plan::Severity;

impl Block<'_, '_, '_> {
    /// `ServiceDat := Req[0], Size := 4`: so many elements from there, each as wide as its type.
    pub(super) fn data(&mut self, config: &mut MsgCipGeneric) {
        let size = self.elements("Size").or_else(|| self.integer("Size", 65_535));
        let count = usize::try_from(self.needed("Size", size)).unwrap_or(0);
        if count == 0 {
            return;
        }
        let Some((root, from)) = self.start("ServiceDat") else {
            self.reading.say(Severity::Error, RemarkKind::Expected("a variable for ServiceDat".into()));
            return;
        };
        let kind = self.types.get(&root).map_or("BYTE", |kind| kind.name).to_ascii_uppercase();
        let (width, low, high): (usize, i64, i64) = match kind.as_str() {
            "BYTE" | "USINT" => (1, 0, 0xFF),
            "SINT" => (1, -0x80, 0x7F),
            "WORD" | "UINT" => (2, 0, 0xFFFF),
            "INT" => (2, -0x8000, 0x7FFF),
            "DWORD" | "UDINT" => (4, 0, 0xFFFF_FFFF),
            "DINT" => (4, -0x8000_0000, 0x7FFF_FFFF),
            "LINT" | "LWORD" | "ULINT" => (8, i64::MIN, i64::MAX),
            _ => {
                let words = format!("bytes, words or whole numbers for ServiceDat instead of {kind}");
                self.reading.say(Severity::Error, RemarkKind::Expected(words));
                return;
            }
        };
        let values = if let Some(from) = from {
            self.reading.elements(&root, "ServiceDat", from, count, (low, high))
        } else {
            let value = self.reading.integer(&root, "ServiceDat", low, high);
            if value.is_none() && !self.reading.has(&root) {
                self.reading.say(Severity::Error, RemarkKind::NotConstant("ServiceDat".into()));
            }
            [value.unwrap_or_default()].into()
        };
        let bytes = values.iter().flat_map(|value| value.to_le_bytes().into_iter().take(width));
        config.req_data = write_hex(&bytes.collect::<Vec<u8>>());
    }

    /// `SizeOfAry(Data)` of a declared array.
    fn elements(&self, name: &str) -> Option<i64> {
        let Some(Expression::Call(call)) = self.site.value(name) else { return None };
        let array = call.argument(0, "In").filter(|_| call.is("SizeOfAry"))?.value.as_ref()?.reference()?;
        let kind = self.types.get(&array.key()?).filter(|kind| !kind.bounds.is_empty())?;
        i64::try_from(kind.elements()).ok()
    }

    /// The variable and the index of `Req[0]`; no index: not an array.
    fn start(&self, name: &str) -> Option<(String, Option<i128>)> {
        let reference: &Reference<'_> = self.site.value(name)?.reference()?;
        let Some((Step::Index(indexes), before)) = reference.steps.split_last() else {
            return Some((reference.key()?, None));
        };
        let [index] = indexes.as_slice() else { return None };
        let array = Reference { root: reference.root, steps: before.to_vec(), place: reference.place };
        Some((array.key()?, Some(index.integer()?)))
    }

    pub(super) fn reply(&mut self, config: &mut MsgCipGeneric) {
        let elements = self.start("RespServiceDat").and_then(|(root, _)| self.types.get(&root).copied());
        let is_bytes = |kind: &&Declared<'_>| ["BYTE", "USINT", "SINT"].iter().any(|name| kind.is(name));
        let size = elements.filter(is_bytes).map(Declared::elements);
        config.res_data_size =
            size.and_then(|size| i64::try_from(size).ok()).map_or(490, |size| size.clamp(1, 490));
    }
}
