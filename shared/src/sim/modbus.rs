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

/// The registers, and a request to them.
type CarryOut = fn(&mut [u16], ServiceCode, &[u8]) -> Result<Vec<u8>, GeneralStatus>;

/// Holding registers 0 to 999: each holds its own number at first. Behind a pointer, so that a program whose simulated
/// devices have none does not carry the code of the object.
#[derive(Clone, Debug)]
pub struct Registers {
    values: Vec<u16>,
    carry_out: CarryOut,
}

impl Default for Registers {
    fn default() -> Self {
        Self { values: (0..).take(REGISTERS).collect(), carry_out }
    }
}

impl Registers {
    pub(super) fn carry_out(&mut self, service: ServiceCode, data: &[u8]) -> Result<Vec<u8>, Refusal> {
        Ok((self.carry_out)(&mut self.values, service, data)?)
    }
}

fn carry_out(values: &mut [u16], service: ServiceCode, data: &[u8]) -> Result<Vec<u8>, GeneralStatus> {
    let mut reader = Reader::new(data);
    match service {
        READ_HOLDING_REGISTERS => {
            let registers = part(values, &mut reader)?;
            reader.finish().map_err(|_| GeneralStatus::TooMuchData)?;
            Ok(registers.iter().flat_map(|register| register.to_le_bytes()).collect())
        }
        WRITE_HOLDING_REGISTERS => {
            let registers = part(values, &mut reader)?;
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
            Ok(Vec::new())
        }
        _ => Err(GeneralStatus::ServiceNotSupported),
    }
}

/// The registers that a request is about.
fn part<'a>(values: &'a mut [u16], reader: &mut Reader<'_>) -> Result<&'a mut [u16], GeneralStatus> {
    let mut next = || reader.u16().map_err(|_| GeneralStatus::NotEnoughData);
    let (start, quantity) = (usize::from(next()?), next()?);
    (1..=MAX_QUANTITY)
        .contains(&quantity)
        .then(|| values.get_mut(start..start + usize::from(quantity)))
        .flatten()
        .ok_or(GeneralStatus::InvalidParameter)
}
