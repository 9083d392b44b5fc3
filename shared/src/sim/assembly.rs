//! Assembly object, class 4: input that moves, output that is remembered. The instances are those of OpENer's sample.

use crate::engine::time::Instant;

use super::wave::wave;

/// Instance of the input: read only.
pub const INPUT_ASSEMBLY: u32 = 100;

/// Instance of the output: writable.
pub const OUTPUT_ASSEMBLY: u32 = 150;

/// Bytes of attribute 3 of either.
pub const ASSEMBLY_SIZE: usize = 32;

/// Attribute 3 of the input: 0..4 UDINT milliseconds, 4..6 UINT counter at 10 a second, 6..8 INT sine of 4 s from
/// -1000 to 1000, 8 a running light at 4 steps a second, 9..16 zero, 16..32 the first half of the output.
pub(super) fn input(output: &[u8; ASSEMBLY_SIZE], now: Instant) -> [u8; ASSEMBLY_SIZE] {
    let millis = now.0 / 1_000;
    let [m0, m1, m2, m3, ..] = millis.to_le_bytes();
    let [c0, c1, ..] = (millis / 100).to_le_bytes();
    let [s0, s1] = wave(now, 4_000).to_le_bytes();
    let light = 1_u8 << (millis / 250 % 8);
    let mut input = [0; ASSEMBLY_SIZE];
    let own = [m0, m1, m2, m3, c0, c1, s0, s1, light, 0, 0, 0, 0, 0, 0, 0];
    for (byte, value) in input.iter_mut().zip(own.iter().chain(output)) {
        *byte = *value;
    }
    input
}
