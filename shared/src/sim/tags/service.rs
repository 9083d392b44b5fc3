//! Which requests are about tags.

use alloc::boxed::Box;
use alloc::vec::Vec;
use core::fmt;

use crate::engine::time::Instant;
use crate::sim::counters::Counters;
use crate::sim::request::{Head, Refusal};
use crate::tag::Dialect;
use crate::wire::{ClassCode, GeneralStatus, ServiceCode};

use super::address::{Address, Part};
use super::memory::TagMemory;
use super::object::Object;
use super::refusal::Wrong;
use super::write::Place;

/// The tags of a device. Behind a pointer, so that a program that simulates no controller does not carry the code of
/// one.
pub struct Tags(Box<dyn Answers>);

/// A request, and what is around it.
#[derive(Clone, Copy, Debug)]
pub(in crate::sim) struct Call<'a> {
    pub(in crate::sim) head: &'a Head<'a>,
    /// Bytes that the data of the reply may have.
    pub(in crate::sim) room: usize,
    /// Whether it came over a connection.
    pub(in crate::sim) connected: bool,
    pub(in crate::sim) now: Instant,
}

trait Answers: fmt::Debug + Send {
    fn answer(&mut self, call: &Call<'_>, counters: &mut Counters) -> Option<Result<Vec<u8>, Refusal>>;
    fn copy(&self) -> Box<dyn Answers>;
}

impl From<TagMemory> for Tags {
    fn from(memory: TagMemory) -> Self {
        Self(Box::new(memory))
    }
}

impl Clone for Tags {
    fn clone(&self) -> Self {
        Self(self.0.copy())
    }
}

impl fmt::Debug for Tags {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        self.0.fmt(f)
    }
}

impl Tags {
    /// `None`: the request is about something else.
    pub(in crate::sim) fn answer(
        &mut self,
        call: &Call<'_>,
        counters: &mut Counters,
    ) -> Option<Result<Vec<u8>, Refusal>> {
        self.0.answer(call, counters)
    }
}

impl Answers for TagMemory {
    fn copy(&self) -> Box<dyn Answers> {
        Box::new(self.clone())
    }

    fn answer(&mut self, call: &Call<'_>, counters: &mut Counters) -> Option<Result<Vec<u8>, Refusal>> {
        if let Some(object) = Object::of(call.head, self.dialect) {
            return Some(self.object(call, &object));
        }
        let address = Address::of(&call.head.path)?;
        Some(self.tag(call, &address, counters))
    }
}

/// What the program in the simulated Logix is called.
const PROJECT: &[u8] = b"cipdeck_demo";

impl TagMemory {
    /// A request to an object that describes tags.
    fn object(&self, call: &Call<'_>, object: &Object<'_>) -> Result<Vec<u8>, Refusal> {
        match (self.dialect, object.class) {
            (Dialect::Omron, _) => self.variable_object(call.head, object, call.room),
            (Dialect::Micro800, _) if !call.connected => Err(Wrong::Service.refusal(self.dialect)),
            (_, ClassCode::Symbol) => self.symbol(call.head, object, call.room),
            (_, ClassCode::Template) => self.template(call.head, object, call.room),
            _ if (object.instance, call.head.service) == (1, ServiceCode::GetAttributesAll) => {
                let length = u16::try_from(PROJECT.len()).unwrap_or_default();
                Ok([&length.to_le_bytes()[..], PROJECT].concat())
            }
            _ => Err(GeneralStatus::ServiceNotSupported.into()),
        }
    }

    /// A request to a tag.
    fn tag(
        &mut self,
        call: &Call<'_>,
        address: &Address<'_>,
        counters: &mut Counters,
    ) -> Result<Vec<u8>, Refusal> {
        let dialect = self.dialect;
        let refuse = |wrong: Wrong| wrong.refusal(dialect);
        // libplctag: a Micro800 needs a connection for its tags. What it says without one is our guess.
        if dialect == Dialect::Micro800 && !call.connected {
            return Err(refuse(Wrong::Service));
        }
        let (service, data) = (call.head.service, call.head.data);
        match service {
            ServiceCode::ReadTag | ServiceCode::READ_TAG_FRAGMENTED => counters.tag_reads += 1,
            ServiceCode::WriteTag | ServiceCode::WriteTagFragmented | ServiceCode::READ_MODIFY_WRITE_TAG => {
                counters.tag_writes += 1;
            }
            _ => {}
        }
        let tag = self.find(&address.base).ok_or_else(|| refuse(Wrong::Missing))?;
        tag.refresh(dialect, call.now);
        let place = Place { steps: &address.steps, bytes: address.bytes };
        let fragments = dialect != Dialect::Omron;
        match service {
            ServiceCode::ReadTag => {
                let part = Part::find(&tag.kind, dialect, place.steps).map_err(refuse)?;
                tag.read(dialect, part, place.bytes, data, call.room)
            }
            ServiceCode::READ_TAG_FRAGMENTED if fragments => {
                let part = Part::find(&tag.kind, dialect, place.steps).map_err(refuse)?;
                tag.read_fragment(dialect, part, data, call.room)
            }
            ServiceCode::WriteTag => tag.write(dialect, &place, data).map(|()| Vec::new()).map_err(refuse),
            ServiceCode::WriteTagFragmented if fragments => {
                tag.write_fragment(dialect, &place, data).map(|()| Vec::new()).map_err(refuse)
            }
            ServiceCode::READ_MODIFY_WRITE_TAG if dialect == Dialect::Logix => {
                tag.modify(dialect, &place, data).map(|()| Vec::new()).map_err(refuse)
            }
            ServiceCode::GetAttributesAll if dialect == Dialect::Omron => {
                let part = Part::find(&tag.kind, dialect, place.steps).map_err(refuse)?;
                let kind = part.kind.clone();
                self.variable(&kind).ok_or_else(|| refuse(Wrong::Missing))
            }
            _ => Err(refuse(Wrong::Service)),
        }
    }
}
