//! A device with variables, and with as many ways to refuse as there are.

use std::collections::BTreeMap;

use cipdeck_shared::tag::{Dialect, Elementary, Step, TagHead, Type, Value};
use cipdeck_shared::wire::{
    Epath, GeneralStatus, LogicalKind, MessageRouterReply, MessageRouterRequest, MultipleServicePacket,
    MultipleServiceReply, Segment, ServiceCode, SimpleDataSegment,
};

#[expect(clippy::struct_excessive_bools, reason = "each is a way of its own to differ")]
pub(crate) struct Device {
    pub(crate) dialect: Dialect,
    pub(crate) tags: BTreeMap<String, (Type, Value)>,
    /// By the name that is asked for.
    pub(crate) refuses: BTreeMap<String, (u8, Option<u16>)>,
    pub(crate) packs: bool,
    pub(crate) fragments: bool,
    /// BOOLs of an array one by one, as cpppo has them.
    pub(crate) plain_bools: bool,
    pub(crate) request_max: usize,
    pub(crate) reply_max: usize,
    /// What does not fit into a packet's reply is refused alone, not the whole.
    pub(crate) cuts_parts: bool,
    /// What was asked, message by message.
    pub(crate) log: Vec<Vec<String>>,
}

impl Device {
    pub(crate) fn new(dialect: Dialect) -> Self {
        Self {
            dialect,
            tags: BTreeMap::new(),
            refuses: BTreeMap::new(),
            packs: dialect != Dialect::Micro800,
            fragments: dialect == Dialect::Logix,
            plain_bools: false,
            request_max: 504,
            reply_max: 504,
            cuts_parts: dialect == Dialect::Logix,
            log: Vec::new(),
        }
    }

    pub(crate) fn with(mut self, name: &str, kind: &str, value: &str) -> Self {
        let kind: Type = kind.parse().unwrap();
        let value = kind.parse_value(value).unwrap();
        self.tags.insert(name.to_owned(), (kind, value));
        self
    }

    pub(crate) fn set(&mut self, name: &str, value: &str) {
        let (kind, old) = self.tags.get_mut(name).unwrap();
        *old = kind.parse_value(value).unwrap();
    }

    pub(crate) fn answer(&mut self, request: &[u8]) -> Vec<u8> {
        let decoded = MessageRouterRequest::decode(request).expect("a request");
        let mut out = Vec::new();
        if decoded.service() != ServiceCode::MultipleServicePacket {
            self.log.push(vec![name_of(decoded.path()).0]);
            let room = self.reply_max;
            return self.one(&decoded, room);
        }
        let packet = MultipleServicePacket::decode(decoded.data()).expect("a packet");
        let parts: Vec<_> =
            packet.parts().iter().map(|part| MessageRouterRequest::decode(part).unwrap()).collect();
        self.log.push(parts.iter().map(|part| name_of(part.path()).0).collect());
        let refuse = |status| {
            let mut out = Vec::new();
            MessageRouterReply::refusal(decoded.service(), status).encode(&mut out);
            out
        };
        if !self.packs {
            return refuse(GeneralStatus::ServiceNotSupported);
        }
        if request.len() > self.request_max {
            return refuse(GeneralStatus::TooMuchData);
        }
        let mut length = 6 + 2 * parts.len();
        let mut failed = false;
        let mut replies = Vec::new();
        for part in &parts {
            let mut reply = self.one(part, usize::MAX);
            if self.cuts_parts && length + reply.len() > self.reply_max {
                reply.clear();
                MessageRouterReply::refusal(part.service(), GeneralStatus::ReplyDataTooLarge)
                    .encode(&mut reply);
            }
            failed |= reply[2] != 0;
            length += reply.len();
            replies.push(reply);
        }
        if length > self.reply_max && !self.cuts_parts {
            return refuse(GeneralStatus::ReplyDataTooLarge);
        }
        let data = MultipleServiceReply::data(&replies).unwrap();
        let status = if failed { GeneralStatus::EmbeddedServiceError } else { GeneralStatus::Success };
        MessageRouterReply { status, ..MessageRouterReply::success(decoded.service(), &data) }
            .encode(&mut out);
        out
    }

    fn one(&self, request: &MessageRouterRequest, room: usize) -> Vec<u8> {
        let service = request.service();
        let mut out = Vec::new();
        match self.read(request, room) {
            Ok((status, data)) => {
                MessageRouterReply { status, ..MessageRouterReply::success(service, &data) }.encode(&mut out);
            }
            Err((status, word)) => {
                let words = word.map(u16::to_le_bytes);
                let additional = words.as_ref().map_or(&[][..], |word| &word[..]);
                let additional = cipdeck_shared::wire::AdditionalStatus::new(additional).unwrap();
                let status = GeneralStatus(status);
                MessageRouterReply { service, status, additional, data: &[] }.encode(&mut out);
            }
        }
        out
    }

    fn read(
        &self,
        request: &MessageRouterRequest,
        room: usize,
    ) -> Result<(GeneralStatus, Vec<u8>), (u8, Option<u16>)> {
        let (name, steps, part) = name_of(request.path());
        if let Some(refusal) = self.refuses.get(&name) {
            return Err(*refusal);
        }
        let fragment = request.service() == ServiceCode::READ_TAG_FRAGMENTED;
        if fragment && !self.fragments {
            return Err((0x08, None));
        }
        let number = |range: core::ops::Range<usize>| {
            request.data()[range].iter().rev().fold(0_usize, |sum, byte| (sum << 8) | usize::from(*byte))
        };
        let (head, bytes) = self.bytes(&steps, number(0..2))?;
        let mut data = Vec::new();
        head.encode(&mut data);
        let room = room.saturating_sub(4 + data.len());
        if let Some(part) = part {
            let from = usize::try_from(part.offset).unwrap();
            let is_text = head.code == 0xD0;
            let bytes = if is_text { &bytes[2..] } else { &bytes[..] };
            let to = from + usize::from(part.size);
            let to = if is_text { to.min(bytes.len()) } else { to };
            let part = bytes.get(from..to).ok_or((0x20, Some(0x8029)))?;
            if part.len() + 2 * usize::from(is_text) > room {
                return Err((0x11, None));
            }
            data.extend(
                is_text.then(|| u16::try_from(part.len()).unwrap().to_le_bytes()).into_iter().flatten(),
            );
            data.extend_from_slice(part);
            return Ok((GeneralStatus::Success, data));
        }
        let offset = if fragment { number(2..6) } else { 0 };
        let rest = bytes.get(offset..).ok_or((0xFF, Some(0x2105)))?;
        if rest.len() <= room {
            data.extend_from_slice(rest);
            return Ok((GeneralStatus::Success, data));
        }
        if self.dialect != Dialect::Logix {
            return Err((0x11, None));
        }
        data.extend_from_slice(&rest[..room / 4 * 4]);
        Ok((GeneralStatus::PartialTransfer, data))
    }

    fn bytes(&self, steps: &[Step], count: usize) -> Result<(TagHead, Vec<u8>), (u8, Option<u16>)> {
        let unknown = (0x05, None);
        let Some((Step::Member(base), mut inner)) = steps.split_first() else { return Err(unknown) };
        let (kind, value) = self.tags.get(base).ok_or(unknown)?;
        let mut first = None;
        if let Some((Step::Index(indices), before)) = inner.split_last() {
            (first, inner) = (Some(indices), before);
        }
        let kind_here = kind.step(inner).ok_or(unknown)?;
        let value_here = value.step(kind, inner).ok_or(unknown)?;
        let Type::Array(element, dimensions) = kind_here else {
            let is_fine = first.is_none() && count == 1;
            let head = kind_here.head(self.dialect).unwrap_or(TagHead { code: 0xA0, handle: Some(0x1234) });
            let bytes = kind_here.encode(self.dialect, value_here).unwrap();
            return if is_fine { Ok((head, bytes)) } else { Err((0xFF, Some(0x2105))) };
        };
        let is_bool = **element == Type::Elementary(Elementary::Bool);
        if is_bool && self.dialect == Dialect::Logix && !self.plain_bools {
            let all = kind_here.encode(self.dialect, value_here).unwrap();
            let from = first.map_or(0, |indices| usize::try_from(indices[0]).unwrap());
            let part = all.get(4 * from..4 * (from + count)).ok_or((0xFF, Some(0x2105)))?;
            return Ok((kind_here.head(self.dialect).unwrap(), part.to_vec()));
        }
        let Value::List(values) = value_here else { panic!("a list") };
        let from = first.map_or(Some(0), |indices| dimensions.position(indices)).ok_or((0x05, None))?;
        let all = first.is_none() && self.dialect == Dialect::Omron;
        let count = if all { values.len() } else { count };
        let some = values.get(from..from + count).ok_or((0xFF, Some(0x2105)))?;
        let head = element.head(self.dialect).unwrap_or(TagHead { code: 0xA0, handle: Some(0x1234) });
        let bytes = if count == 1 {
            element.encode(self.dialect, &some[0]).unwrap()
        } else {
            let kind: Type = format!("{element}[{count}]").parse().unwrap();
            kind.encode(self.dialect, &Value::List(some.to_vec())).unwrap()
        };
        Ok((head, bytes))
    }
}

fn name_of(path: &Epath) -> (String, Vec<Step>, Option<SimpleDataSegment>) {
    let mut steps = Vec::new();
    let mut part = None;
    for segment in path.segments() {
        match segment {
            Segment::Symbol(symbol) => {
                steps.push(Step::Member(String::from_utf8(symbol.name().to_vec()).unwrap()));
            }
            Segment::Logical(logical) => {
                assert_eq!(logical.kind, LogicalKind::Member);
                match steps.last_mut() {
                    Some(Step::Index(indices)) => indices.push(logical.value),
                    _ => steps.push(Step::Index(vec![logical.value])),
                }
            }
            Segment::SimpleData(simple) => part = Some(*simple),
            Segment::Port(_) => panic!("a hop"),
        }
    }
    let text = steps.iter().fold(String::new(), |text, step| match step {
        Step::Member(name) if text.is_empty() => name.clone(),
        Step::Member(name) => format!("{text}.{name}"),
        Step::Index(indices) => {
            format!("{text}[{}]", indices.iter().map(u32::to_string).collect::<Vec<_>>().join(","))
        }
    });
    (text, steps, part)
}
