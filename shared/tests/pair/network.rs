//! What can happen to the frames of a device on their way.

use cipdeck_shared::engine::Instant;
use cipdeck_shared::sim::SimConnection;
use cipdeck_shared::wire::{Deframer, HEADER_SIZE};

/// What happens to one frame of a device. TCP keeps the order, and loses nothing but its end: whoever sends a frame
/// twice or changes it is a device, or something that speaks for one.
#[derive(Clone, Debug)]
pub(crate) enum Fate {
    /// It arrives after so many ms, in pieces of so many bytes.
    Pass(u64, usize),
    /// It never arrives.
    Lose,
    /// It arrives at once, and once more after so many ms.
    Twice(u64),
    /// A byte of what tells replies apart is changed: session, context, connection id, sequence count.
    Spoil(usize, u8),
    /// An older frame of the same device comes first, perhaps one of another TCP connection.
    Replay(usize),
    /// So many bytes arrive, then the TCP connection breaks.
    Cut(usize),
}

/// A direction of a TCP connection that breaks after some bytes.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Cut {
    ToDevice(usize),
    ToEngine(usize),
}

/// One TCP connection.
#[derive(Debug)]
pub(crate) struct Cable {
    pub(crate) device: usize,
    /// The device's end, while it is there.
    pub(crate) end: Option<SimConnection>,
    /// What has arrived at the device, cut into frames again.
    pub(crate) arrived: Deframer,
    /// When the last bytes of each direction arrive: what is sent later arrives later.
    pub(crate) to_device: Instant,
    pub(crate) to_engine: Instant,
    /// Bytes that have been sent in each direction.
    pub(crate) sent_to_device: usize,
    pub(crate) sent_to_engine: usize,
    /// The device has stopped in the middle of a frame.
    pub(crate) halved: bool,
}

impl Cable {
    pub(crate) fn new(device: usize) -> Self {
        Self {
            device,
            end: Some(SimConnection::new()),
            arrived: Deframer::new(),
            to_device: Instant::ZERO,
            to_engine: Instant::ZERO,
            sent_to_device: 0,
            sent_to_engine: 0,
            halved: false,
        }
    }
}

/// The frames in some bytes; what is left over is the last.
pub(crate) fn split(mut bytes: &[u8]) -> Vec<Vec<u8>> {
    let mut frames = Vec::new();
    while !bytes.is_empty() {
        let (frame, rest) = bytes.split_at(length(bytes).min(bytes.len()));
        frames.push(frame.to_vec());
        bytes = rest;
    }
    frames
}

/// Whether this is a frame and not the beginning of one.
pub(crate) fn is_whole(frame: &[u8]) -> bool {
    frame.len() == length(frame)
}

/// What the header says.
fn length(bytes: &[u8]) -> usize {
    match bytes {
        [_, _, low, high, ..] => HEADER_SIZE + usize::from(u16::from_le_bytes([*low, *high])),
        _ => usize::MAX,
    }
}

/// Changes one byte of the envelope, never one of the message: a changed value in a right envelope is a right answer.
pub(crate) fn spoil(frame: &mut [u8], at: usize, with: u8) {
    const REGISTER: u8 = 0x65;
    const SEND_UNIT_DATA: u8 = 0x70;
    let unconnected = [4, 5, 6, 7, 12, 13, 14, 15, 16, 17, 18, 19];
    let connected = [4, 5, 6, 7, 36, 37, 38, 39, 44, 45];
    let places = match frame.first() {
        Some(&SEND_UNIT_DATA) => &connected[..],
        // Another session handle is a right one before the first request.
        Some(&REGISTER) => &unconnected[4..],
        _ => &unconnected[..],
    };
    if let Some(byte) = frame.get_mut(places[at % places.len()]) {
        *byte ^= with.max(1);
    }
}
