//! A message router request as an object sees it, and what it may be told instead of an answer.

use alloc::vec::Vec;

use crate::engine::time::Millis;
use crate::wire::{
    AdditionalStatus, ClassCode, Epath, GeneralStatus, LogicalKind, MessageRouterReply, Reader, Segment,
    ServiceCode,
};

/// A request with its path taken apart.
#[derive(Clone, Debug)]
pub(super) struct Head<'a> {
    pub(super) service: ServiceCode,
    pub(super) path: Epath,
    pub(super) data: &'a [u8],
}

/// A request to class, instance and attribute; a missing number is 0.
#[derive(Clone, Copy, Debug)]
pub(super) struct Request<'a> {
    pub(super) service: ServiceCode,
    pub(super) class: ClassCode,
    pub(super) instance: u32,
    pub(super) attribute: u16,
    pub(super) data: &'a [u8],
}

impl<'a> Head<'a> {
    pub(super) fn decode(bytes: &'a [u8]) -> Result<Self, GeneralStatus> {
        let mut reader = Reader::new(bytes);
        let service = reader.u8().map_err(|_| GeneralStatus::NotEnoughData)?;
        let words = reader.u8().map_err(|_| GeneralStatus::NotEnoughData)?;
        if service >= ServiceCode::REPLY {
            return Err(GeneralStatus::ServiceNotSupported);
        }
        let path = reader.take(2 * usize::from(words)).map_err(|_| GeneralStatus::PathSizeInvalid)?;
        let path = Epath::decode(path).map_err(|_| GeneralStatus::PathSegmentError)?;
        Ok(Self { service: ServiceCode(service), path, data: reader.rest() })
    }

    /// Whether the path is that of one object, and nothing more.
    pub(super) fn is_to(&self, class: ClassCode, instance: u32) -> bool {
        Request::of(self).is_ok_and(|request| (request.class, request.instance) == (class, instance))
    }
}

impl<'a> Request<'a> {
    /// Of a request to an object.
    pub(super) fn of(head: &Head<'a>) -> Result<Self, GeneralStatus> {
        let path = &head.path;
        let understood = path.segments().iter().all(|segment| {
            matches!(segment, Segment::Logical(logical) if matches!(
                logical.kind,
                LogicalKind::Class | LogicalKind::Instance | LogicalKind::Attribute
            ))
        });
        if !understood {
            return Err(GeneralStatus::PathSegmentError);
        }
        let number = |kind| path.logical(kind).unwrap_or(0);
        let small = |kind, status| u16::try_from(number(kind)).map_err(|_| status);
        Ok(Self {
            service: head.service,
            class: ClassCode(small(LogicalKind::Class, GeneralStatus::PathDestinationUnknown)?),
            instance: number(LogicalKind::Instance),
            attribute: small(LogicalKind::Attribute, GeneralStatus::AttributeNotSupported)?,
            data: head.data,
        })
    }
}

/// The service of any bytes: that of the reply to them.
pub(super) fn service_of(request: &[u8]) -> ServiceCode {
    ServiceCode(request.first().map_or(0, |byte| byte & !ServiceCode::REPLY))
}

/// A status other than success, with what goes with it.
#[derive(Clone, Debug, PartialEq, Eq)]
pub(super) struct Refusal {
    pub(super) status: GeneralStatus,
    /// Additional status words, little endian.
    pub(super) additional: Vec<u8>,
    pub(super) data: Vec<u8>,
    /// How long the device was busy finding out.
    pub(super) wait: Millis,
}

impl From<GeneralStatus> for Refusal {
    fn from(status: GeneralStatus) -> Self {
        Self { status, additional: Vec::new(), data: Vec::new(), wait: Millis(0) }
    }
}

/// A message router reply, and how long it is held back.
#[derive(Clone, Debug, PartialEq, Eq)]
pub(super) struct Answer {
    pub(super) message: Vec<u8>,
    pub(super) wait: Millis,
}

impl Answer {
    /// Bytes of a reply before its data, without additional status.
    pub(super) const HEAD: usize = 4;

    pub(super) fn new(service: ServiceCode, outcome: Result<Vec<u8>, Refusal>) -> Self {
        let mut message = Vec::new();
        match outcome {
            Ok(data) => {
                MessageRouterReply::success(service, &data).encode(&mut message);
                Self { message, wait: Millis(0) }
            }
            Err(Refusal { status, additional, data, wait }) => {
                let additional = AdditionalStatus::new(&additional).unwrap_or_default();
                MessageRouterReply { service, status, additional, data: &data }.encode(&mut message);
                Self { message, wait }
            }
        }
    }

    pub(super) fn refusal(service: ServiceCode, status: GeneralStatus) -> Self {
        Self::new(service, Err(status.into()))
    }
}
