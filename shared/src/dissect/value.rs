//! Typed values in the data of a message: from the attribute tables, or guessed and called so.

use alloc::borrow::Cow;
use alloc::string::{String, ToString};
use alloc::vec::Vec;

use serde::{Deserialize, Serialize};

use crate::table::{self, Field};
use crate::tag::DataFields;
use crate::wire::{CipType, GeneralStatus, MessageRouterReply, Reader, ServiceCode};

use super::path::Address;
use super::words::{ascii, hex};

/// One value in data. Guesses may cover the same bytes: they are alternatives.
#[derive(Clone, Debug, PartialEq, Eq, Serialize, Deserialize)]
#[cfg_attr(feature = "openapi", derive(utoipa::ToSchema))]
pub struct Decoded {
    /// The first byte, counted from the start of the data.
    pub from: usize,
    /// The byte after the last.
    pub to: usize,
    /// CIP type; `bytes` or `ASCII` in a guess.
    #[serde(rename = "type")]
    #[cfg_attr(feature = "openapi", schema(value_type = String))]
    pub type_name: Cow<'static, str>,
    /// What it is, such as `product name`; `data` in a guess.
    #[cfg_attr(feature = "openapi", schema(value_type = String))]
    pub name: Cow<'static, str>,
    /// The value.
    pub text: String,
    /// Whether the type is only guessed from the bytes.
    #[serde(default, skip_serializing_if = "is_false")]
    pub guess: bool,
}

#[expect(clippy::trivially_copy_pass_by_ref, reason = "serde's signature")]
const fn is_false(guess: &bool) -> bool {
    !*guess
}

/// The values in the data of a successful reply, as far as the request says what they are. A refusal, and a reply
/// that cannot be decoded, has none.
pub fn decode(request: &[u8], reply: &[u8]) -> Vec<Decoded> {
    let Ok(reply) = MessageRouterReply::decode(reply) else { return Vec::new() };
    let layout = layout_of_reply(&About::of(request), reply.service, reply.status);
    match reply.status {
        GeneralStatus::Success => values(layout, reply.data),
        _ => Vec::new(),
    }
}

/// The values in the data of a successful reply, with the layout that somebody has given for it. Bytes that it leaves
/// over are guessed.
pub fn decode_as(layout: &DataFields, reply: &[u8]) -> Vec<Decoded> {
    match MessageRouterReply::decode(reply) {
        Ok(reply) if reply.status == GeneralStatus::Success => fields(layout, reply.data),
        _ => Vec::new(),
    }
}

/// What data is by a layout: its fields, as far as the data goes, then guesses for what is left.
pub fn fields(layout: &DataFields, data: &[u8]) -> Vec<Decoded> {
    let mut end = 0;
    let each = layout.each().iter().map_while(|field| {
        let text = field.text(data)?;
        end = field.to(data);
        let type_name = Cow::Owned(field.type_name());
        Some(Decoded {
            from: field.from,
            to: end,
            type_name,
            name: Cow::Owned(field.name.clone()),
            text,
            guess: false,
        })
    });
    let mut found: Vec<_> = each.collect();
    let rest = data.get(end..).unwrap_or_default();
    let shifted = |guess: Decoded| Decoded { from: guess.from + end, to: guess.to + end, ..guess };
    if !rest.is_empty() {
        found.extend(values(None, rest).into_iter().map(shifted));
    }
    found
}

/// Service and address of a request, as far as they can be read.
#[derive(Clone, Copy, Debug, Default)]
pub(super) struct About {
    pub(super) service: Option<ServiceCode>,
    pub(super) address: Address,
}

impl About {
    pub(super) fn of(request: &[u8]) -> Self {
        let mut reader = Reader::new(request);
        let service = reader.u8().ok().map(ServiceCode);
        let size = reader.u8().map_or(0, |words| 2 * usize::from(words));
        let path = reader.take(size.min(reader.remaining())).unwrap_or_default();
        Self { service, address: Address::of(path) }
    }

    /// The layout of the attribute that a service reads or writes.
    fn layout(&self, service: ServiceCode) -> Option<&'static [Field]> {
        let Address { class, instance, attribute } = self.address;
        match service {
            ServiceCode::GetAttributesAll => table::attribute(class?, instance, 0),
            ServiceCode::GetAttributeSingle | ServiceCode::SetAttributeSingle if attribute != 0 => {
                table::attribute(class?, instance, attribute)
            }
            _ => None,
        }
    }
}

/// The layout of the data of a request: only writes carry an attribute.
pub(super) fn layout_of_request(about: &About) -> Option<&'static [Field]> {
    match about.service {
        Some(service @ ServiceCode::SetAttributeSingle) => about.layout(service),
        _ => None,
    }
}

/// The layout of the data of a reply: only successful reads carry an attribute.
pub(super) fn layout_of_reply(
    about: &About,
    service: ServiceCode,
    status: GeneralStatus,
) -> Option<&'static [Field]> {
    let reads = matches!(service, ServiceCode::GetAttributesAll | ServiceCode::GetAttributeSingle);
    if reads && status == GeneralStatus::Success && about.service == Some(service) {
        about.layout(service)
    } else {
        None
    }
}

/// The fields of the layout, then guesses for what is left.
pub(super) fn values(layout: Option<&'static [Field]>, data: &[u8]) -> Vec<Decoded> {
    let mut reader = Reader::new(data);
    let mut values = Vec::new();
    for field in layout.unwrap_or_default() {
        let mut ahead = reader.clone();
        let Ok(text) = field.kind.read(&mut ahead) else { break };
        values.push(Decoded {
            from: reader.at(),
            to: ahead.at(),
            type_name: field.kind.type_name().into(),
            name: field.name.into(),
            text,
            guess: false,
        });
        reader = ahead;
    }
    let from = reader.at();
    values.extend(guesses(from, reader.rest()));
    values
}

/// The plain readings of bytes of which nothing is known.
fn guesses(from: usize, bytes: &[u8]) -> Vec<Decoded> {
    let mut readings: Vec<(&'static str, String)> = match bytes {
        [] => return Vec::new(),
        [_] => numbers(bytes, &[CipType::Usint]),
        [_, _] => numbers(bytes, &[CipType::Uint, CipType::Int]),
        &[a, b, c, d] => {
            let mut readings = numbers(bytes, &[CipType::Dint, CipType::Udint]);
            // The shortest form: a number that is no REAL tends to be tiny or huge as one.
            let real = f32::from_le_bytes([a, b, c, d]);
            readings.push((CipType::Real.name(), zmij::Buffer::new().format(real).to_string()));
            readings
        }
        _ => alloc::vec![("bytes", hex(bytes))],
    };
    let short_string = bytes.split_first().filter(|(length, rest)| usize::from(**length) == rest.len());
    if let Some(text) = short_string.filter(|(_, rest)| !rest.is_empty()).and_then(|(_, rest)| ascii(rest)) {
        readings.push((CipType::ShortString.name(), text.to_string()));
    } else if let Some(text) = ascii(bytes).filter(|text| text.len() > 4) {
        readings.push(("ASCII", text.to_string()));
    }
    let to = from + bytes.len();
    let guess = |(kind, text): (&'static str, _)| Decoded {
        from,
        to,
        type_name: kind.into(),
        name: "data".into(),
        text,
        guess: true,
    };
    readings.into_iter().map(guess).collect()
}

fn numbers(bytes: &[u8], kinds: &[CipType]) -> Vec<(&'static str, String)> {
    let read = |kind: &CipType| Some((kind.name(), kind.read(&mut Reader::new(bytes)).ok()?.to_string()));
    kinds.iter().filter_map(read).collect()
}
