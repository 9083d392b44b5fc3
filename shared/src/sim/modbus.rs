//! Modbus object, class 68 (0x44): holding registers, read and written by two services of its own.
//!
//! Source: Schneider EIO0000001601 p. 67. What a device answers to a write is not in it: nothing is answered here.

use alloc::vec::Vec;

use crate::wire::{GeneralStatus, Reader, ServiceCode};

use super::request::Refusal;

/// UINT zero-based start, UINT quantity.
const READ_HOLDING_REGISTERS: ServiceCode = ServiceCode(0x4E);

/// UINT zero-based start, UINT quantity, the registers.
const WRITE_HOLDING_REGISTERS: ServiceCode = ServiceCode(0x50);

/// Registers of one request.
const MAX_QUANTITY: u16 = 123;

/// Registers that are there.
const REGISTERS: usize = 1_000;

/// The registers: each holds its own number at first.
#[derive(Clone, Debug)]
pub(super) struct Registers(Vec<u16>);

impl Default for Registers {
    fn default() -> Self {
        Self((0..).take(REGISTERS).collect())
    }
}

impl Registers {
    pub(super) fn carry_out(&mut self, service: ServiceCode, data: &[u8]) -> Result<Vec<u8>, Refusal> {
        match service {
            READ_HOLDING_REGISTERS => Ok(self.read(data)?),
            WRITE_HOLDING_REGISTERS => {
                self.write(data)?;
                Ok(Vec::new())
            }
            _ => Err(GeneralStatus::ServiceNotSupported.into()),
        }
    }

    fn read(&mut self, data: &[u8]) -> Result<Vec<u8>, GeneralStatus> {
        let mut reader = Reader::new(data);
        let registers = self.part(&mut reader)?;
        reader.finish().map_err(|_| GeneralStatus::TooMuchData)?;
        Ok(registers.iter().flat_map(|register| register.to_le_bytes()).collect())
    }

    fn write(&mut self, data: &[u8]) -> Result<(), GeneralStatus> {
        let mut reader = Reader::new(data);
        let registers = self.part(&mut reader)?;
        let given = reader.rest();
        if given.len() < 2 * registers.len() {
            return Err(GeneralStatus::NotEnoughData);
        }
        if given.len() > 2 * registers.len() {
            return Err(GeneralStatus::TooMuchData);
        }
        for (register, bytes) in registers.iter_mut().zip(given.as_chunks::<2>().0) {
            *register = u16::from_le_bytes(*bytes);
        }
        Ok(())
    }

    /// The registers that a request is about.
    fn part(&mut self, reader: &mut Reader<'_>) -> Result<&mut [u16], GeneralStatus> {
        let mut next = || reader.u16().map_err(|_| GeneralStatus::NotEnoughData);
        let (start, quantity) = (next()?, next()?);
        let from = usize::from(start);
        (1..=MAX_QUANTITY)
            .contains(&quantity)
            .then(|| self.0.get_mut(from..from + usize::from(quantity)))
            .flatten()
            .ok_or(GeneralStatus::InvalidParameter)
    }
}
