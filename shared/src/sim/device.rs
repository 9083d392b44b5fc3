//! The device: which object answers, and what.

use alloc::vec::Vec;

use crate::engine::time::{Instant, Millis};
use crate::wire::{
    ClassCode, Epath, GeneralStatus, LogicalKind, MessageRouterReply, Reader, Segment, ServiceCode,
    SessionHandle, SocketAddress,
};

use super::assembly::{self, ASSEMBLY_SIZE, INPUT_ASSEMBLY, OUTPUT_ASSEMBLY};
use super::fault::Fault;
use super::identity::SimIdentity;
use super::network;
use super::parameter::{self, Parameters};

/// What a simulated device is like.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct SimConfig {
    /// Who it says it is.
    pub identity: SimIdentity,
    /// Where it says it is: in ListIdentity and in TCP/IP attribute 5.
    pub address: SocketAddress,
    /// From a `SendRRData` request to its reply; requests are worked on one after the other.
    pub delay: Millis,
    /// The first reply suffers the first, and so on, round and round. Empty: all is well.
    pub faults: Vec<Fault>,
}

impl Default for SimConfig {
    fn default() -> Self {
        Self {
            identity: SimIdentity::default(),
            address: SocketAddress::v4([127, 0, 0, 1], 44_818),
            delay: Millis(0),
            faults: Vec::new(),
        }
    }
}

/// The objects of a simulated device. See the [module](super) for what is in it.
#[derive(Clone, Debug, Default)]
pub struct Device {
    pub(super) config: SimConfig,
    output: [u8; ASSEMBLY_SIZE],
    parameters: Parameters,
    last_session: u32,
    answered: usize,
}

/// An instance that is there.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum Object {
    Identity,
    /// Message Router and Connection Manager: there, but without anything that this device can do.
    Silent,
    Input,
    Output,
    Parameter(u32),
    TcpIp,
    EthernetLink,
}

/// The attribute that holds the data of an assembly.
const ASSEMBLY_DATA: u16 = 3;

/// The attribute that holds the value of a DPI parameter.
const PARAMETER_VALUE: u16 = 9;

impl Device {
    /// A device just switched on.
    pub fn new(config: SimConfig) -> Self {
        Self { config, ..Self::default() }
    }

    /// Answers a message router request. Any bytes get an answer: what cannot be understood is refused.
    pub fn answer(&mut self, request: &[u8], now: Instant) -> Vec<u8> {
        let service = ServiceCode(request.first().map_or(0, |byte| byte & !ServiceCode::REPLY));
        let mut out = Vec::new();
        match self.carry_out(request, now) {
            Ok(data) => MessageRouterReply::success(service, &data).encode(&mut out),
            Err(status) => MessageRouterReply::refusal(service, status).encode(&mut out),
        }
        out
    }

    fn carry_out(&mut self, request: &[u8], now: Instant) -> Result<Vec<u8>, GeneralStatus> {
        let request = Request::decode(request)?;
        let object = find(request.class, request.instance)?;
        let attribute = request.attribute;
        match request.service {
            ServiceCode::GetAttributesAll if object == Object::Identity => Ok(self.config.identity.all()),
            ServiceCode::GetAttributeSingle if object != Object::Silent => {
                self.read(object, attribute, now).ok_or(GeneralStatus::AttributeNotSupported)
            }
            ServiceCode::SetAttributeSingle if object != Object::Silent => {
                let there = self.read(object, attribute, now).is_some();
                if !there {
                    return Err(GeneralStatus::AttributeNotSupported);
                }
                self.write(object, request.data).map(|()| Vec::new())
            }
            _ => Err(GeneralStatus::ServiceNotSupported),
        }
    }

    fn read(&self, object: Object, attribute: u16, now: Instant) -> Option<Vec<u8>> {
        match (object, attribute) {
            (Object::Identity, _) => self.config.identity.read(attribute),
            (Object::Input, ASSEMBLY_DATA) => Some(assembly::input(&self.output, now).to_vec()),
            (Object::Output, ASSEMBLY_DATA) => Some(self.output.to_vec()),
            (Object::Parameter(number), PARAMETER_VALUE) => self.parameters.read(number, now),
            (Object::TcpIp, _) => network::tcp_ip(attribute, self.config.address.ip),
            (Object::EthernetLink, _) => network::ethernet_link(attribute, self.config.identity.serial),
            _ => None,
        }
    }

    /// Writes the attribute that [`Self::read`] has found.
    fn write(&mut self, object: Object, data: &[u8]) -> Result<(), GeneralStatus> {
        match object {
            Object::Output => {
                self.output = <[u8; ASSEMBLY_SIZE]>::try_from(data).map_err(|_| {
                    if data.len() < ASSEMBLY_SIZE {
                        GeneralStatus::NotEnoughData
                    } else {
                        GeneralStatus::TooMuchData
                    }
                })?;
                Ok(())
            }
            Object::Parameter(number) => self.parameters.write(number, data),
            _ => Err(GeneralStatus::AttributeNotSettable),
        }
    }

    /// A session handle that no other connection has. Never 0.
    pub(super) fn open_session(&mut self) -> SessionHandle {
        self.last_session = self.last_session.checked_add(1).unwrap_or(1);
        SessionHandle(self.last_session)
    }

    /// What is to go wrong with the next reply.
    pub(super) fn next_fault(&mut self) -> Fault {
        let count = self.config.faults.len();
        let fault = self.answered.checked_rem(count).and_then(|turn| self.config.faults.get(turn));
        self.answered = self.answered.wrapping_add(1);
        fault.copied().unwrap_or(Fault::Ok)
    }
}

/// Finds the instance. Instance 0, the class itself, is there but has no services.
fn find(class: ClassCode, instance: u32) -> Result<Object, GeneralStatus> {
    let object = match (class, instance) {
        (ClassCode::Identity, 1) => Object::Identity,
        (ClassCode::MessageRouter | ClassCode::ConnectionManager, 1) => Object::Silent,
        (ClassCode::Assembly, INPUT_ASSEMBLY) => Object::Input,
        (ClassCode::Assembly, OUTPUT_ASSEMBLY) => Object::Output,
        (ClassCode::DpiParameter, number) if parameter::exists(number) => Object::Parameter(number),
        (ClassCode::TcpIpInterface, 1) => Object::TcpIp,
        (ClassCode::EthernetLink, 1) => Object::EthernetLink,
        (class, 0) if CLASSES.contains(&class) => return Err(GeneralStatus::ServiceNotSupported),
        _ => return Err(GeneralStatus::PathDestinationUnknown),
    };
    Ok(object)
}

/// The classes of which there are instances.
const CLASSES: [ClassCode; 7] = [
    ClassCode::Identity,
    ClassCode::MessageRouter,
    ClassCode::Assembly,
    ClassCode::ConnectionManager,
    ClassCode::DpiParameter,
    ClassCode::TcpIpInterface,
    ClassCode::EthernetLink,
];

/// A request to class, instance and attribute; a missing number is 0.
#[derive(Clone, Copy, Debug)]
struct Request<'a> {
    service: ServiceCode,
    class: ClassCode,
    instance: u32,
    attribute: u16,
    data: &'a [u8],
}

impl<'a> Request<'a> {
    fn decode(bytes: &'a [u8]) -> Result<Self, GeneralStatus> {
        let mut reader = Reader::new(bytes);
        let service = reader.u8().map_err(|_| GeneralStatus::NotEnoughData)?;
        let words = reader.u8().map_err(|_| GeneralStatus::NotEnoughData)?;
        if service >= ServiceCode::REPLY {
            return Err(GeneralStatus::ServiceNotSupported);
        }
        let path = reader.take(2 * usize::from(words)).map_err(|_| GeneralStatus::PathSizeInvalid)?;
        let path = Epath::decode(path).map_err(|_| GeneralStatus::PathSegmentError)?;
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
            service: ServiceCode(service),
            class: ClassCode(small(LogicalKind::Class, GeneralStatus::PathDestinationUnknown)?),
            instance: number(LogicalKind::Instance),
            attribute: small(LogicalKind::Attribute, GeneralStatus::AttributeNotSupported)?,
            data: reader.rest(),
        })
    }
}
