//! Inputs that nobody would send, the same ones at every run.

/// A generator of numbers (SplitMix64, by Sebastiano Vigna, public domain).
#[derive(Clone, Debug)]
pub struct Random(u64);

impl Random {
    /// The same seed gives the same numbers.
    pub fn new(seed: u64) -> Self {
        Self(seed)
    }

    /// Any number.
    pub fn number(&mut self) -> u64 {
        self.0 = self.0.wrapping_add(0x9E37_79B9_7F4A_7C15);
        let mixed = (self.0 ^ (self.0 >> 30)).wrapping_mul(0xBF58_476D_1CE4_E5B9);
        let mixed = (mixed ^ (mixed >> 27)).wrapping_mul(0x94D0_49BB_1331_11EB);
        mixed ^ (mixed >> 31)
    }

    /// From 0 to `limit` - 1.
    pub fn below(&mut self, limit: usize) -> usize {
        usize::try_from(self.number() % limit as u64).unwrap_or_default()
    }

    /// One of these.
    pub fn pick<'a, T: ?Sized>(&mut self, all: &[&'a T]) -> &'a T {
        all[self.below(all.len())]
    }

    /// So many bytes.
    pub fn bytes(&mut self, count: usize) -> Vec<u8> {
        std::iter::repeat_with(|| self.number().to_le_bytes()[0]).take(count).collect()
    }

    /// The bytes with one to four changes: other, missing, additional, doubled, cut off.
    pub fn mutated(&mut self, bytes: &[u8]) -> Vec<u8> {
        let mut bytes = bytes.to_vec();
        for _ in 0..=self.below(4) {
            let at = self.below(bytes.len() + 1);
            let end = at + self.below(bytes.len() - at + 1);
            match self.below(6) {
                0 => bytes.insert(at, self.bytes(1)[0]),
                1 if at < bytes.len() => bytes[at] ^= 1 << self.below(8),
                2 => drop(bytes.drain(at..end)),
                3 if bytes.len() < 4096 => {
                    let slice = bytes[at..end].to_vec();
                    bytes.splice(at..at, slice);
                }
                4 => bytes.truncate(at),
                _ => {
                    let word = self.pick(&[
                        &b"\""[..],
                        b"{",
                        b"}",
                        b"[",
                        b"null",
                        b"1e999",
                        b"\\u0000",
                        b"-1",
                        b":",
                    ]);
                    bytes.splice(at..at, word.iter().copied());
                }
            }
        }
        bytes
    }

    /// JSON that is hard to read: deep, huge, long.
    pub fn hard(&mut self) -> Vec<u8> {
        let count = self.below(20_000);
        match self.below(5) {
            0 => vec![b'['; count],
            1 => b"{\"name\":".repeat(count / 8),
            2 => [&b"{\"name\":"[..], &vec![b'9'; count], b"}"].concat(),
            3 => [&b"{\"name\":\""[..], &vec![b'x'; count], b"\"}"].concat(),
            _ => b"{\"block\":1e308,\"id\":-1e-999,\"type\":18446744073709551616}".to_vec(),
        }
    }
}
