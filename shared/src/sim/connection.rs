//! One TCP connection to a simulated device.

use alloc::collections::VecDeque;
use alloc::vec::Vec;

use crate::engine::time::Instant;
use crate::wire::{
    Command, Deframer, Encapsulation, EncapsulationStatus, Header, ItemType, MessageRouterReply,
    PROTOCOL_VERSION, RegisterSession, SendRrData, SenderContext, ServiceCode, SessionHandle,
    UnconnectedMessage,
};

use super::datagram::list_reply;
use super::device::Device;
use super::fault::Fault;

/// The device's end of one TCP connection. Give it what arrives; send what it hands out; close when it says so.
///
/// Memory is bounded: an unfinished frame, one read, and 256 KiB of replies that nobody fetches, after which
/// the connection is given up.
#[derive(Debug, Default)]
pub struct SimConnection {
    deframer: Deframer,
    session: Session,
}

/// Everything behind the deframer.
#[derive(Debug, Default)]
struct Session {
    handle: Option<SessionHandle>,
    replies: VecDeque<Reply>,
    /// Bytes in `replies`.
    waiting: usize,
    /// When the last reply goes out: the next one cannot overtake it.
    busy_until: Instant,
    closing: bool,
    /// After half a frame nothing else is sent.
    mute: bool,
}

#[derive(Debug)]
struct Reply {
    due: Instant,
    bytes: Vec<u8>,
}

const MAX_WAITING: usize = 256 * 1024;

impl SimConnection {
    /// A connection that has just been accepted.
    pub fn new() -> Self {
        Self::default()
    }

    /// Takes what arrived, cut in any way.
    pub fn handle_input(&mut self, device: &mut Device, bytes: &[u8], now: Instant) {
        if self.session.closing {
            return;
        }
        self.deframer.push(bytes);
        while !self.session.closing {
            match self.deframer.next_frame() {
                Ok(Some(frame)) => self.session.handle_frame(device, &frame, now),
                Ok(None) => return,
                // The length cannot be trusted, so nothing after it can.
                Err(_) => self.session.closing = true,
            }
        }
    }

    /// Appends the replies that are due, in the order of their requests; false if there are none.
    pub fn poll_transmit(&mut self, out: &mut Vec<u8>, now: Instant) -> bool {
        let before = out.len();
        while let Some(reply) = self.session.replies.pop_front_if(|reply| reply.due <= now) {
            self.session.waiting -= reply.bytes.len();
            out.extend_from_slice(&reply.bytes);
        }
        out.len() > before
    }

    /// When [`Self::poll_transmit`] has something next.
    pub fn poll_timeout(&self) -> Option<Instant> {
        self.session.replies.front().map(|reply| reply.due)
    }

    /// Whether the device closes the socket now: everything it had to say has been handed out.
    pub fn is_closed(&self) -> bool {
        self.session.closing && self.session.replies.is_empty()
    }
}

impl Session {
    fn handle_frame(&mut self, device: &mut Device, frame: &Encapsulation<'_>, now: Instant) {
        let header = frame.header;
        if header.options != 0 {
            // The specification: options that are not understood, so the frame is discarded.
            return;
        }
        match header.command {
            Command::ListIdentity | Command::ListServices | Command::ListInterfaces => {
                if let Some(reply) = list_reply(device, header) {
                    self.send(reply, now);
                }
            }
            Command::RegisterSession => self.register(device, frame, now),
            Command::UnRegisterSession => self.closing |= self.handle == Some(header.session),
            Command::SendRRData | Command::SendUnitData if self.handle != Some(header.session) => {
                self.refuse(header, EncapsulationStatus::InvalidSessionHandle, now);
            }
            Command::SendRRData => self.request(device, frame, now),
            // Connected data: there is no connection it could belong to, so it is dropped as on the network.
            Command::Nop | Command::SendUnitData => {}
            _ => self.refuse(header, EncapsulationStatus::InvalidCommand, now),
        }
    }

    fn register(&mut self, device: &mut Device, frame: &Encapsulation<'_>, now: Instant) {
        let (session, status) = match RegisterSession::decode(frame.data()) {
            _ if self.handle.is_some() => (None, EncapsulationStatus::InvalidCommand),
            Err(_) => return self.refuse(frame.header, EncapsulationStatus::InvalidLength, now),
            Ok(asked) if asked.version != PROTOCOL_VERSION || asked.options != 0 => {
                (None, EncapsulationStatus::UnsupportedProtocolVersion)
            }
            Ok(_) => (Some(device.open_session()), EncapsulationStatus::Success),
        };
        self.handle = self.handle.or(session);
        let header = Header { session: session.unwrap_or(frame.header.session), ..frame.header };
        self.reply(header.reply(status), &RegisterSession::CURRENT.bytes(), now);
    }

    fn request(&mut self, device: &mut Device, frame: &Encapsulation<'_>, now: Instant) {
        let message = match message(frame) {
            Ok(message) => message,
            Err(status) => return self.refuse(frame.header, status, now),
        };
        let fault = device.next_fault();
        let header = frame.header.reply(EncapsulationStatus::Success);
        let answer = match fault {
            Fault::EncapsulationStatus(status) => {
                self.busy(device, now);
                return self.refuse(header, status, now);
            }
            Fault::ErrorStatus(status) => {
                let service = message.first().map_or(0, |service| service & !ServiceCode::REPLY);
                let mut out = Vec::new();
                MessageRouterReply::refusal(ServiceCode(service), status).encode(&mut out);
                out
            }
            _ => device.answer(message, now),
        };
        self.busy(device, now);
        match fault {
            Fault::Drop => {}
            Fault::Close => self.closing = true,
            // A length that cannot be.
            Fault::Garbage => self.send([0xFF; 48].to_vec(), now),
            Fault::HalfFrame => {
                let mut whole = send_rr_data(header, &answer);
                whole.truncate(whole.len() / 2);
                self.send(whole, now);
                self.mute = true;
            }
            Fault::WrongContext => {
                let context = SenderContext(header.context.0.map(|byte| !byte));
                self.send(send_rr_data(Header { context, ..header }, &answer), now);
            }
            Fault::WrongSession => {
                let session = SessionHandle(!header.session.0);
                self.send(send_rr_data(Header { session, ..header }, &answer), now);
            }
            Fault::WrongService => {
                let mut answer = answer;
                if let Some(service) = answer.first_mut() {
                    *service ^= 1;
                }
                self.send(send_rr_data(header, &answer), now);
            }
            Fault::Ok | Fault::ErrorStatus(_) | Fault::EncapsulationStatus(_) => {
                self.send(send_rr_data(header, &answer), now);
            }
        }
    }

    /// Works on a request for as long as the configuration says.
    fn busy(&mut self, device: &Device, now: Instant) {
        self.busy_until = self.busy_until.max(now) + device.config.delay;
    }

    fn refuse(&mut self, header: Header, status: EncapsulationStatus, now: Instant) {
        self.reply(header.reply(status), &[], now);
    }

    fn reply(&mut self, header: Header, data: &[u8], now: Instant) {
        let Ok(frame) = Encapsulation::new(header, data) else { return };
        let mut bytes = Vec::new();
        frame.encode(&mut bytes);
        self.send(bytes, now);
    }

    fn send(&mut self, bytes: Vec<u8>, now: Instant) {
        if self.mute {
            return;
        }
        self.waiting += bytes.len();
        self.closing |= self.waiting > MAX_WAITING;
        self.busy_until = self.busy_until.max(now);
        self.replies.push_back(Reply { due: self.busy_until, bytes });
    }
}

/// The message router request in a frame, or why there is none.
fn message<'a>(frame: &Encapsulation<'a>) -> Result<&'a [u8], EncapsulationStatus> {
    let data = SendRrData::decode(frame.data()).map_err(|_| EncapsulationStatus::InvalidLength)?;
    let item = data.unconnected().map_err(|_| EncapsulationStatus::IncorrectData)?;
    if data.interface_handle != 0 || data.packet.find(ItemType::NullAddress).is_none() {
        return Err(EncapsulationStatus::IncorrectData);
    }
    Ok(item.data)
}

fn send_rr_data(header: Header, message: &[u8]) -> Vec<u8> {
    let mut out = Vec::new();
    if let Ok(message) = UnconnectedMessage::new(message) {
        message.encode(&header, 0, &mut out);
    }
    out
}
