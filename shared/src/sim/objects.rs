//! The objects of one module: which instance answers, and what.

use alloc::vec::Vec;

use crate::engine::time::Instant;
use crate::wire::{ClassCode, GeneralStatus, ServiceCode};

use super::assembly::{self, ASSEMBLY_SIZE, INPUT_ASSEMBLY, OUTPUT_ASSEMBLY};
use super::attribute::{self, Class};
use super::counters::ManagerCounts;
use super::modbus::Registers;
use super::module::SimModule;
use super::network;
use super::parameter::{self, Parameters};
use super::request::{Refusal, Request};

/// One module with the values of its own.
#[derive(Clone, Debug)]
pub(super) struct Objects {
    pub(super) module: SimModule,
    pub(super) counts: ManagerCounts,
    output: [u8; ASSEMBLY_SIZE],
    parameters: Parameters,
    pub(super) registers: Option<Registers>,
}

/// What a request can be about.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum Object {
    /// Instance 0.
    Class(Class),
    Identity,
    MessageRouter,
    ConnectionManager,
    Input,
    Output,
    Parameter(u32),
    Modbus,
    TcpIp([u8; 4]),
    EthernetLink,
}

/// The attribute that holds the data of an assembly.
const ASSEMBLY_DATA: u16 = 3;

/// The attribute that holds the value of a DPI parameter.
const PARAMETER_VALUE: u16 = 9;

impl Objects {
    pub(super) fn new(module: SimModule) -> Self {
        Self {
            module,
            counts: ManagerCounts::default(),
            output: [0; ASSEMBLY_SIZE],
            parameters: Parameters::default(),
            registers: None,
        }
    }

    /// Everything but the services of the Connection Manager.
    pub(super) fn carry_out(&mut self, request: &Request<'_>, now: Instant) -> Result<Vec<u8>, Refusal> {
        let object = self.find(request.class, request.instance)?;
        let attribute = request.attribute;
        let there = || self.read(object, attribute, now).ok_or(GeneralStatus::AttributeNotSupported);
        match (request.service, object) {
            (ServiceCode::GetAttributesAll, Object::Identity) => Ok(self.module.identity.all()),
            (ServiceCode::GetAttributesAll, Object::ConnectionManager) => {
                let all = ManagerCounts::ATTRIBUTES.filter_map(|attribute| self.counts.read(attribute));
                Ok(all.flatten().collect())
            }
            (ServiceCode::GetAttributeSingle, _) => Ok(there()?),
            (ServiceCode::GetAttributeList, _) => {
                attribute::list(request.data, |attribute| self.read(object, attribute, now))
            }
            (ServiceCode::SetAttributeSingle, _) => {
                there()?;
                self.write(object, request.data)?;
                Ok(Vec::new())
            }
            (service, Object::Modbus) => match &mut self.registers {
                Some(registers) => registers.carry_out(service, request.data),
                None => Err(GeneralStatus::PathDestinationUnknown.into()),
            },
            _ => Err(GeneralStatus::ServiceNotSupported.into()),
        }
    }

    fn read(&self, object: Object, attribute: u16, now: Instant) -> Option<Vec<u8>> {
        match (object, attribute) {
            (Object::Class(class), _) => class.read(attribute),
            (Object::Identity, _) => self.module.identity.read(attribute),
            (Object::ConnectionManager, _) => self.counts.read(attribute).map(|count| count.to_vec()),
            (Object::Input, ASSEMBLY_DATA) => Some(assembly::input(&self.output, now).to_vec()),
            (Object::Output, ASSEMBLY_DATA) => Some(self.output.to_vec()),
            (Object::Parameter(number), PARAMETER_VALUE) => self.parameters.read(number, now),
            (Object::TcpIp(ip), _) => network::tcp_ip(attribute, ip),
            (Object::EthernetLink, _) => network::ethernet_link(attribute, self.module.identity.serial),
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

    fn find(&self, class: ClassCode, instance: u32) -> Result<Object, GeneralStatus> {
        let unknown = GeneralStatus::PathDestinationUnknown;
        let object = match (class, instance) {
            (_, 0) => Object::Class(self.class(class).ok_or(unknown)?),
            (ClassCode::Identity, 1) => Object::Identity,
            (ClassCode::MessageRouter, 1) => Object::MessageRouter,
            (ClassCode::ConnectionManager, 1) => Object::ConnectionManager,
            (ClassCode::Assembly, INPUT_ASSEMBLY) => Object::Input,
            (ClassCode::Assembly, OUTPUT_ASSEMBLY) => Object::Output,
            (ClassCode::DpiParameter, number) if parameter::exists(number) => Object::Parameter(number),
            (ClassCode::Modbus, 1) if self.registers.is_some() => Object::Modbus,
            (ClassCode::TcpIpInterface, 1) => Object::TcpIp(self.module.ip.ok_or(unknown)?),
            (ClassCode::EthernetLink, 1) if self.module.ip.is_some() => Object::EthernetLink,
            _ => return Err(unknown),
        };
        Ok(object)
    }

    /// The classes of which there are instances. Only what is on the Ethernet has objects of it.
    fn class(&self, class: ClassCode) -> Option<Class> {
        let (revision, max_instance, instances) = match class {
            ClassCode::Identity | ClassCode::MessageRouter | ClassCode::ConnectionManager => (1, 1, 1),
            ClassCode::Modbus if self.registers.is_some() => (1, 1, 1),
            ClassCode::Assembly => (2, 150, 2),
            ClassCode::DpiParameter => (1, 43, 5),
            ClassCode::TcpIpInterface | ClassCode::EthernetLink if self.module.ip.is_some() => (1, 1, 1),
            _ => return None,
        };
        Some(Class { revision, max_instance, instances })
    }
}
