//! The time that a router gives an unconnected request: `USINT time tick | USINT timeout ticks`.
//!
//! `2^(tick & 0x0F) x ticks` ms. Source: Wireshark packet-cip.c; bits 4..7 of the tick are priority and reserved.

use super::cursor::{DecodeError, Reader};

/// A timeout as the wire can say it.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct RequestTimeout {
    tick: u8,
    ticks: u8,
}

impl RequestTimeout {
    /// The shortest timeout that is not shorter than `millis`, with the finest tick; at most 8,355,840 ms.
    pub fn at_least(millis: u32) -> Self {
        (0..=MAX_TICK)
            .find_map(|tick| {
                let ticks = u8::try_from(millis.div_ceil(1 << tick)).ok()?;
                Some(Self { tick, ticks })
            })
            .unwrap_or(Self { tick: MAX_TICK, ticks: u8::MAX })
    }

    /// Milliseconds.
    pub const fn millis(self) -> u32 {
        (self.ticks as u32) << (self.tick & MAX_TICK)
    }

    /// Reads both bytes.
    pub fn read(reader: &mut Reader<'_>) -> Result<Self, DecodeError> {
        Ok(Self { tick: reader.u8()?, ticks: reader.u8()? })
    }

    /// Tick and ticks.
    pub const fn bytes(self) -> [u8; 2] {
        [self.tick, self.ticks]
    }
}

/// 32,768 ms.
const MAX_TICK: u8 = 0x0F;

#[cfg(test)]
mod tests {
    use super::*;

    /// The fact sheet's table: the smallest tick whose ticks fit, rounded up.
    #[test]
    fn timeouts_are_rounded_up_with_the_finest_tick() {
        for (millis, bytes, rounded) in [
            (250, [0x00, 0xFA], 250),
            (255, [0x00, 0xFF], 255),
            (256, [0x01, 0x80], 256),
            (257, [0x01, 0x81], 258),
            (1_000, [0x02, 0xFA], 1_000),
            (3_000, [0x04, 0xBC], 3_008),
            (10_000, [0x06, 0x9D], 10_048),
            (u32::MAX, [0x0F, 0xFF], 8_355_840),
        ] {
            let timeout = RequestTimeout::at_least(millis);
            assert_eq!((timeout.bytes(), timeout.millis()), (bytes, rounded), "{millis} ms");
        }
    }

    #[test]
    fn the_articles_timeout_is_over_four_minutes() {
        // Omron NX over EtherNet/IP, cnblogs xiketang 13664904: 0A F0
        let timeout = RequestTimeout::read(&mut Reader::new(&[0x0A, 0xF0])).unwrap();
        assert_eq!(timeout.millis(), 245_760);
    }
}
