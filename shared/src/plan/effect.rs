//! What a request does, wherever it hides it.
//!
//! Some requests carry others: Unconnected_Send hands one on along a route, Multiple_Service_Packet holds several. A
//! list of what is allowed has to judge the services that an object gets in the end, so these two are opened, also
//! inside of each other. The same number means different things by the path: 0x52 is Unconnected_Send for class 6 and
//! reads a tag elsewhere, 0x4E closes a connection for class 6 and writes bits of a tag elsewhere.
//!
//! Whatever two readers could understand differently counts as not understood, and that counts as a write.

use alloc::vec::Vec;

use crate::table::{self, Access};
use crate::wire::{
    ClassCode, Epath, LogicalKind, LogicalSegment, MessageRouterRequest, MultipleServicePacket, Segment,
    ServiceCode, UnconnectedSend,
};

/// How many requests may lie inside of each other. Real ones need two: a packet of requests on a route.
const MAX_DEPTH: usize = 4;

/// One service that an object gets.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Effect {
    /// The ports behind the device that gets the request: from the Unconnected_Send around the service, if there is
    /// one. Not the route that a block's own `Path` names.
    pub route: Epath,
    /// The service.
    pub service: ServiceCode,
    /// `None` for a tag's name, and for a path that is not understood.
    pub class: Option<u16>,
    /// `None` if the path names none.
    pub instance: Option<u32>,
    /// `None` if the path names none; services of a list of attributes name them in their data.
    pub attribute: Option<u16>,
    /// What it does.
    pub access: Access,
}

impl Effect {
    /// Whether this is a service that carries others, which could not be read: nobody knows what it does, so that no
    /// list can name it.
    pub fn carries(&self) -> bool {
        let class = self.class.map(ClassCode);
        matches!(
            (self.service, class),
            (ServiceCode::UnconnectedSend, Some(ClassCode::ConnectionManager))
                | (ServiceCode::MultipleServicePacket, Some(ClassCode::MessageRouter))
        )
    }
}

/// Everything that the bytes of a message router request do: at least one effect, in the order of the bytes. Any bytes
/// are taken; what cannot be understood is one effect that is [`Access::Unknown`].
pub fn effects(request: &[u8]) -> Vec<Effect> {
    let mut found = Vec::new();
    look(request, &Epath::default(), 0, &mut found);
    found
}

fn look(bytes: &[u8], route: &Epath, depth: usize, found: &mut Vec<Effect>) {
    let read = MessageRouterRequest::decode(bytes);
    let Some((request, object)) = read.ok().and_then(|request| {
        let object = Object::of(request.path())?;
        Some((request, object))
    }) else {
        let service = ServiceCode(bytes.first().copied().unwrap_or_default());
        found.push(unknown(service, route));
        return;
    };
    match inside(&request, object) {
        Inside::Nothing => found.push(object.gets(request.service(), route, found.last())),
        Inside::Requests(hops, parts) if depth < MAX_DEPTH => {
            let route = route.clone().join(&hops);
            for part in parts {
                look(part, &route, depth + 1, found);
            }
        }
        Inside::Requests(..) | Inside::Unreadable => {
            found.push(Effect { access: Access::Unknown, ..object.gets(request.service(), route, None) });
        }
    }
}

fn unknown(service: ServiceCode, route: &Epath) -> Effect {
    let route = route.clone();
    Effect { route, service, class: None, instance: None, attribute: None, access: Access::Unknown }
}

/// What a request carries.
enum Inside<'a> {
    Nothing,
    /// Along which further hops, and what.
    Requests(Epath, Vec<&'a [u8]>),
    Unreadable,
}

fn inside(request: &MessageRouterRequest, object: Object) -> Inside<'_> {
    let class = object.class.map(ClassCode);
    match (request.service(), class) {
        (ServiceCode::UnconnectedSend, Some(ClassCode::ConnectionManager)) => {
            let send = UnconnectedSend::decode(request.data()).ok();
            let send = send.filter(|send| send.route.segments().iter().all(is_hop));
            send.map_or(Inside::Unreadable, |send| Inside::Requests(send.route, alloc::vec![send.message]))
        }
        (ServiceCode::MultipleServicePacket, Some(ClassCode::MessageRouter)) => {
            let packet = MultipleServicePacket::decode(request.data());
            packet.map_or(Inside::Unreadable, |packet| {
                Inside::Requests(Epath::default(), packet.parts().to_vec())
            })
        }
        _ => Inside::Nothing,
    }
}

const fn is_hop(segment: &Segment) -> bool {
    matches!(segment, Segment::Port(_))
}

/// What a path addresses.
#[derive(Clone, Copy)]
struct Object {
    class: Option<u16>,
    instance: Option<u32>,
    attribute: Option<u16>,
}

impl Object {
    /// Class, instance, attribute in this order, or a name; then members. Of a path that names something twice or in
    /// another order nobody knows what the device makes of it.
    fn of(path: &Epath) -> Option<Self> {
        let mut segments = path.segments();
        let mut next = |kind| {
            let (first, rest) = segments.split_first()?;
            let Segment::Logical(LogicalSegment { kind: found, value }) = *first else { return None };
            (found == kind).then(|| {
                segments = rest;
                value
            })
        };
        let numbers = [LogicalKind::Class, LogicalKind::Instance, LogicalKind::Attribute].map(&mut next);
        let [class, instance, attribute] = numbers;
        let named = matches!(segments.first(), Some(Segment::Symbol(_)));
        if class.is_none() && (numbers != [None; 3] || !named) {
            return None;
        }
        // A part of a variable is the last thing about it.
        if let Some((Segment::SimpleData(_), before)) = segments.split_last()
            && class.is_none()
        {
            segments = before;
        }
        // The tags of a program: its name, then the class of all tags. No list can name them by their number.
        if let [names @ .., Segment::Logical(class_of), Segment::Logical(tag)] = segments
            && class.is_none()
            && *class_of == (LogicalSegment { kind: LogicalKind::Class, value: ClassCode::Symbol.0.into() })
            && tag.kind == LogicalKind::Instance
            && names.iter().all(|name| matches!(name, Segment::Symbol(_)))
        {
            segments = names;
        }
        let rest_is_clear = segments.iter().all(|segment| match segment {
            Segment::Symbol(_) => class.is_none(),
            Segment::Logical(logical) => logical.kind == LogicalKind::Member,
            Segment::Port(_) | Segment::SimpleData(_) => false,
        });
        let small = |number: Option<u32>| number.map(u16::try_from).transpose().ok();
        rest_is_clear.then_some(Self { class: small(class)?, instance, attribute: small(attribute)? })
    }

    /// `before`: the effect before it. A packet of reads is hundreds of the same: what the table says of the same
    /// service of the same class is not looked up again.
    fn gets(self, service: ServiceCode, route: &Epath, before: Option<&Effect>) -> Effect {
        let Self { class, instance, attribute } = self;
        // What is not understood has no class either, and is unknown.
        let same = |before: &&Effect| {
            before.service == service && before.class == class && before.access != Access::Unknown
        };
        let access = match before.filter(same) {
            Some(before) => before.access,
            // Names are those of tags.
            None => table::classify(service, class.unwrap_or(ClassCode::Symbol.0)),
        };
        Effect { route: route.clone(), service, class, instance, attribute, access }
    }
}

#[cfg(test)]
mod tests;
