//! DPI Parameter object, class 147 (0x93): attribute 9 is the value. Numbers and types are borrowed from
//! PowerFlex drives, so that examples from their manuals can be tried; the list is in the module above.

use alloc::vec::Vec;

use crate::engine::time::Instant;
use crate::wire::{CipType, CipValue, GeneralStatus, Reader};

use super::wave::wave;

/// The parameters that can be written.
#[derive(Clone, Debug)]
pub(super) struct Parameters {
    acceleration: CipValue,
    deceleration: CipValue,
    reference: CipValue,
}

impl Default for Parameters {
    fn default() -> Self {
        Self {
            acceleration: CipValue::Int(1_000),
            deceleration: CipValue::Int(1_000),
            reference: CipValue::Real(30.0),
        }
    }
}

/// Whether a parameter of this number is there.
pub(super) const fn exists(number: u32) -> bool {
    matches!(number, 1 | 7 | 41..=43)
}

impl Parameters {
    pub(super) fn read(&self, number: u32, now: Instant) -> Option<Vec<u8>> {
        let value = match number {
            1 => CipValue::Int(3_000 + wave(now, 8_000) / 2),
            7 => CipValue::Real(4.2 + f32::from(wave(now, 5_000)) / 1_000.0),
            41 => self.acceleration.clone(),
            42 => self.deceleration.clone(),
            43 => self.reference.clone(),
            _ => return None,
        };
        let mut out = Vec::new();
        value.encode(&mut out);
        Some(out)
    }

    pub(super) fn write(&mut self, number: u32, data: &[u8]) -> Result<(), GeneralStatus> {
        let (kind, place) = match number {
            41 => (CipType::Int, &mut self.acceleration),
            42 => (CipType::Int, &mut self.deceleration),
            43 => (CipType::Real, &mut self.reference),
            _ => return Err(GeneralStatus::AttributeNotSettable),
        };
        let mut reader = Reader::new(data);
        let value = kind.read(&mut reader).map_err(|_| GeneralStatus::NotEnoughData)?;
        reader.finish().map_err(|_| GeneralStatus::TooMuchData)?;
        *place = value;
        Ok(())
    }
}
