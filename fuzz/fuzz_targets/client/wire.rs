//! What goes over the wire, seen from outside, and the rules that hold there:
//!
//! * a message is written after permission, once for each permission, and not before the one in front of it on the
//!   same connection has been answered;
//! * a block succeeds only when its own message was written and a reply has come since that carries the number of
//!   that request, or comes from a target that has shown with its first reply that it does not repeat numbers.
//!
//! Frames are read and built by hand here: a mistake of the product's own codec must not hide itself.

use std::collections::{BTreeMap, BTreeSet};

use cipdeck_shared::config::BlockId;
use cipdeck_shared::engine::{LinkId, Wants};

use crate::input::Input;

const LIST_IDENTITY: u16 = 0x63;
const REGISTER: u16 = 0x65;
const UNREGISTER: u16 = 0x66;
const UNCONNECTED: u16 = 0x6F;
const CONNECTED: u16 = 0x70;

type Shot = (BlockId, u64);

/// All connections.
#[derive(Debug, Default)]
pub struct Wire {
    links: BTreeMap<LinkId, Line>,
    /// Written messages of blocks, and whether a reply to them has come.
    written: BTreeMap<Shot, bool>,
    /// Messages that have ended: nothing may be written for them any more.
    ended: BTreeSet<Shot>,
}

/// One connection.
#[derive(Debug, Default)]
struct Line {
    permitted: Option<Shot>,
    request: Option<Request>,
    /// What came and is not a whole frame yet.
    partial: Vec<u8>,
    /// What the engine wants to be called in replies over its class 3 connection.
    own_id: [u8; 4],
    /// The first reply to a message repeated its number; unknown before it.
    repeats: BTreeMap<u16, bool>,
}

/// The newest request.
#[derive(Clone, Debug)]
struct Request {
    frame: Vec<u8>,
    /// Whose message it is; `None` for what the engine sends for itself.
    shot: Option<Shot>,
    answered: bool,
}

impl Request {
    fn command(&self) -> u16 {
        u16_at(&self.frame, 0)
    }

    /// By what the reply is recognised: the context, or the sequence count.
    fn number(&self) -> Vec<u8> {
        number(&self.frame)
    }
}

impl Wire {
    /// The engine has been told that it may write this.
    pub fn permitted(&mut self, wants: &Wants) {
        let shot = (wants.block, wants.shot);
        // Permission may come too late, or be for a connection.
        if !wants.opens && !self.ended.contains(&shot) {
            self.links.entry(wants.link).or_default().permitted = Some(shot);
        }
    }

    /// The engine has written this.
    pub fn wrote(&mut self, link: LinkId, mut bytes: &[u8]) {
        while !bytes.is_empty() {
            assert!(bytes.len() >= 24, "whole frames");
            let (frame, rest) = bytes.split_at(24 + usize::from(u16_at(bytes, 2)));
            self.request(link, frame);
            bytes = rest;
        }
    }

    fn request(&mut self, link: LinkId, frame: &[u8]) {
        let line = self.links.entry(link).or_default();
        let command = u16_at(frame, 0);
        if matches!(command, UNREGISTER | LIST_IDENTITY) {
            // The one has no reply. The other acts on nothing, and its reply cannot be taken for another's: the engine
            // does not wait for it long.
            return;
        }
        if let Some(before) = &line.request {
            assert!(before.answered, "two requests at once: {before:x?} and {frame:x?}");
            // Connections count each for themselves.
            let connection =
                |frame: &[u8]| frame.get(36..40).filter(|_| command == CONNECTED).map(<[u8]>::to_vec);
            assert!(
                command == REGISTER
                    || before.command() != command
                    || connection(&before.frame) != connection(frame)
                    || before.number() != number(frame),
                "the same number again: {frame:x?}"
            );
        }
        let of_a_block = command == CONNECTED || (command == UNCONNECTED && !manages_connections(frame));
        if let (false, Some(id)) = (of_a_block, frame.get(52..56)) {
            line.own_id.copy_from_slice(id);
        }
        let shot = of_a_block.then(|| line.permitted.take().expect("nothing is written without permission"));
        if let Some(shot) = shot {
            assert!(!self.ended.contains(&shot), "written after its end: {shot:?}");
            self.written.insert(shot, false);
        }
        line.request = Some(Request { frame: frame.to_vec(), shot, answered: false });
    }

    /// The target has sent this.
    pub fn read(&mut self, link: LinkId, bytes: &[u8]) {
        let line = self.links.entry(link).or_default();
        line.partial.extend_from_slice(bytes);
        while line.partial.len() >= 24 {
            let length = 24 + usize::from(u16_at(&line.partial, 2));
            if line.partial.len() < length {
                break;
            }
            let frame: Vec<u8> = line.partial.drain(..length).collect();
            let Some(request) =
                line.request.as_mut().filter(|request| request.command() == u16_at(&frame, 0))
            else {
                continue;
            };
            // An error says nothing about numbers inside.
            let same = number(&frame) == request.number() || frame[8..12] != [0; 4];
            let repeats = *line.repeats.entry(request.command()).or_insert(same);
            if same || !repeats {
                request.answered = true;
                if let Some(shot) = request.shot {
                    self.written.insert(shot, true);
                }
            }
        }
    }

    /// A message has ended.
    pub fn finished(&mut self, block: BlockId, shot: u64, well: bool) {
        let answered = self.written.remove(&(block, shot));
        assert!(
            !well || answered == Some(true),
            "{block:?} {shot} succeeded, written and answered: {answered:?}"
        );
        self.ended.insert((block, shot));
    }

    /// The socket has been dropped.
    pub fn gone(&mut self, link: LinkId) {
        self.links.remove(&link);
    }

    /// What a target might say to the newest request: mostly right, sometimes wrong in one way.
    pub fn answer(&self, link: LinkId, input: &mut Input<'_>) -> Vec<u8> {
        let Some(line) = self.links.get(&link) else { return Vec::new() };
        let Some(request) = &line.request else { return Vec::new() };
        let mut frame = reply(&request.frame, line.own_id);
        let (fault, value) = (input.number(), input.number());
        match fault % 16 {
            8 => frame[12] ^= value,
            9 => frame[4] ^= value,
            10 => frame[8] = if value == 1 { 0x64 } else { value },
            11 => frame.truncate(usize::from(value)),
            12 => {
                let at = usize::from(value) % frame.len();
                frame[at] ^= input.number();
            }
            13 => frame.extend(frame.clone()),
            // The status of the message itself.
            14 if frame.len() > 42 => frame[42] = value,
            15 if frame.len() > 46 => frame[44] ^= value,
            _ => {}
        }
        frame
    }
}

/// Context, or sequence count.
fn number(frame: &[u8]) -> Vec<u8> {
    match u16_at(frame, 0) {
        CONNECTED => frame.get(44..46).unwrap_or_default().to_vec(),
        _ => frame[12..20].to_vec(),
    }
}

/// Forward_Open, Large_Forward_Open or Forward_Close.
fn manages_connections(frame: &[u8]) -> bool {
    frame.get(40..46).is_some_and(|message| {
        matches!(message[0], 0x54 | 0x5B | 0x4E) && message[1..] == [0x02, 0x20, 0x06, 0x24, 0x01]
    })
}

/// As a target that does everything right.
fn reply(request: &[u8], own_id: [u8; 4]) -> Vec<u8> {
    let mut frame = request.get(..24).unwrap_or_default().to_vec();
    let body = request.get(24..).unwrap_or_default();
    match u16_at(request, 0) {
        REGISTER => {
            frame[4] = 7;
            frame.extend_from_slice(body);
        }
        UNCONNECTED => {
            let message = request.get(40..).unwrap_or_default();
            let inner = if message.first() == Some(&0x52) { message.get(10..) } else { Some(message) };
            let answer = answer(inner.unwrap_or_default());
            frame.extend_from_slice(&[0, 0, 0, 0, 0, 0, 2, 0, 0, 0, 0, 0, 0xB2, 0]);
            frame.extend_from_slice(&length(&answer));
            frame.extend_from_slice(&answer);
        }
        _ => {
            let answer = answer(request.get(46..).unwrap_or_default());
            let sequence = request.get(44..46).unwrap_or(&[0, 0]);
            frame.extend_from_slice(&[0, 0, 0, 0, 0, 0, 2, 0, 0xA1, 0, 4, 0]);
            frame.extend_from_slice(&own_id);
            frame.extend_from_slice(&[0xB1, 0]);
            frame.extend_from_slice(&length(&[sequence, &answer].concat()));
            frame.extend_from_slice(sequence);
            frame.extend_from_slice(&answer);
        }
    }
    let length = length(&frame[24..]);
    frame[2..4].copy_from_slice(&length);
    frame
}

fn answer(message: &[u8]) -> Vec<u8> {
    let service = message.first().copied().unwrap_or(0);
    let mut answer = vec![service | 0x80, 0, 0, 0];
    match service {
        // O->T id, one for each connection, then T->O id, triad and intervals as asked.
        0x54 | 0x5B => {
            let id = message.get(12..16).unwrap_or(&[0; 4]);
            answer.extend(id.iter().map(|byte| byte ^ 0x55));
            answer.extend_from_slice(id);
            answer.extend_from_slice(message.get(16..24).unwrap_or(&[0; 8]));
            answer.extend_from_slice(&[0x80, 0x84, 0x1E, 0, 0x80, 0x84, 0x1E, 0, 0, 0]);
        }
        0x4E => {
            answer.extend_from_slice(message.get(8..16).unwrap_or(&[0; 8]));
            answer.extend_from_slice(&[0, 0]);
        }
        _ => answer.extend_from_slice(b"\x04fuzz"),
    }
    answer
}

fn length(bytes: &[u8]) -> [u8; 2] {
    u16::try_from(bytes.len()).unwrap_or(u16::MAX).to_le_bytes()
}

fn u16_at(bytes: &[u8], at: usize) -> u16 {
    bytes.get(at..at + 2).map_or(0, |two| u16::from_le_bytes([two[0], two[1]]))
}
