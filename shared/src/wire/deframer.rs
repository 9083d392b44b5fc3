//! Bytes of a TCP stream → whole frames. Memory is bounded by one frame and one read.

use alloc::vec::Vec;

use super::cursor::{DecodeError, DecodeErrorKind, Reader};
use super::encapsulation::{Command, Encapsulation};

/// Collects bytes until a frame is whole. After an error the stream cannot be resynchronised: drop it.
#[derive(Debug, Default)]
pub struct Deframer {
    buffer: Vec<u8>,
    /// Bytes at the front that have been handed out already.
    used: usize,
}

impl Deframer {
    /// An empty deframer.
    pub const fn new() -> Self {
        Self { buffer: Vec::new(), used: 0 }
    }

    /// Adds what was read from the socket.
    pub fn push(&mut self, bytes: &[u8]) {
        self.buffer.drain(..self.used);
        self.used = 0;
        self.buffer.extend_from_slice(bytes);
    }

    /// The next whole frame, if it is there.
    ///
    /// # Errors
    /// When the length field is over the maximum: nothing after it can be trusted.
    pub fn next_frame(&mut self) -> Result<Option<Encapsulation<'_>>, DecodeError> {
        let pending = self.buffer.get(self.used..).unwrap_or_default();
        let mut reader = Reader::new(pending);
        match Encapsulation::read(&mut reader) {
            Ok(frame) => {
                self.used += reader.at();
                Ok(Some(frame))
            }
            Err(DecodeError { kind: DecodeErrorKind::Truncated { .. }, .. }) => Ok(None),
            Err(error) => Err(error),
        }
    }

    /// The command of a frame that has begun, even if the rest is still on the way.
    pub fn peek_command(&self) -> Option<Command> {
        Reader::new(self.pending_bytes()).u16().ok().map(Command)
    }

    /// The bytes of an unfinished frame, or those that make no sense.
    pub fn pending_bytes(&self) -> &[u8] {
        self.buffer.get(self.used..).unwrap_or_default()
    }

    /// How many bytes of an unfinished frame are waiting.
    pub const fn pending(&self) -> usize {
        self.buffer.len() - self.used
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use hex_literal::hex;

    const TWO: [u8; 54] = hex!(
        "6F 00 02 00 01 00 00 00 00 00 00 00 00 00 00 00 00 00 00 00 00 00 00 00 AA BB"
        "65 00 04 00 02 00 00 00 00 00 00 00 00 00 00 00 00 00 00 00 00 00 00 00 01 00 00 00"
    );

    #[test]
    fn frames_arrive_whole_however_the_stream_is_cut() {
        for size in 1..TWO.len() {
            let mut deframer = Deframer::new();
            let mut frames = Vec::new();
            for part in TWO.chunks(size) {
                deframer.push(part);
                while let Some(frame) = deframer.next_frame().unwrap() {
                    let mut bytes = Vec::new();
                    frame.encode(&mut bytes);
                    frames.push(bytes);
                }
            }
            assert_eq!(frames, [TWO[..26].to_vec(), TWO[26..].to_vec()], "parts of {size} bytes");
            assert_eq!(deframer.pending(), 0);
        }
    }

    #[test]
    fn an_impossible_length_is_an_error_as_soon_as_it_is_read() {
        let mut deframer = Deframer::new();
        deframer.push(&[0x6F, 0x00, 0xFF, 0xFF]);
        assert!(deframer.next_frame().is_err());
    }
}
