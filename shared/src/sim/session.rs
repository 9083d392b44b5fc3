//! The frames of one TCP connection: its session, and what goes wrong on purpose.

use alloc::vec::Vec;

use crate::engine::time::{Instant, Millis};
use crate::wire::{
    Command, ConnectedMessage, ConnectionId, Encapsulation, EncapsulationStatus, Header, ItemType,
    PROTOCOL_VERSION, RegisterSession, SendRrData, SenderContext, SessionHandle, UnconnectedMessage,
};

use super::config::Quirk;
use super::datagram::list_reply;
use super::device::Device;
use super::fault::Fault;
use super::outbox::Outbox;
use super::request::Answer;

/// Everything behind the deframer.
#[derive(Debug, Default)]
pub(super) struct Session {
    handle: Option<SessionHandle>,
    pub(super) outbox: Outbox,
}

/// What is around a message.
#[derive(Clone, Copy, Debug)]
enum Envelope {
    Unconnected,
    Connected { id: ConnectionId, sequence: u16 },
}

impl Session {
    pub(super) fn handle_frame(&mut self, device: &mut Device, frame: &Encapsulation<'_>, now: Instant) {
        let header = frame.header;
        if header.options != 0 {
            // The specification: options that are not understood, so the frame is discarded.
            return;
        }
        match header.command {
            Command::ListIdentity | Command::ListServices | Command::ListInterfaces => {
                if let Some(reply) = list_reply(device, header) {
                    self.outbox.send(reply, Millis(0), now);
                }
            }
            Command::RegisterSession => self.register(device, frame, now),
            Command::UnRegisterSession => self.unregister(device, header, now),
            Command::SendRRData | Command::SendUnitData if self.handle != Some(header.session) => {
                self.refuse(device, header, EncapsulationStatus::InvalidSessionHandle, now);
            }
            Command::SendRRData => self.unconnected(device, frame, now),
            Command::SendUnitData => self.connected(device, frame, now),
            Command::Nop => {}
            _ => self.refuse(device, header, EncapsulationStatus::InvalidCommand, now),
        }
    }

    fn register(&mut self, device: &mut Device, frame: &Encapsulation<'_>, now: Instant) {
        let (session, status) = match RegisterSession::decode(frame.data()) {
            _ if self.handle.is_some() => (None, EncapsulationStatus::InvalidCommand),
            Err(_) => {
                return self.refuse(device, frame.header, EncapsulationStatus::InvalidLength, now);
            }
            Ok(asked) if asked.version != PROTOCOL_VERSION || asked.options != 0 => {
                (None, EncapsulationStatus::UnsupportedProtocolVersion)
            }
            Ok(_) => (Some(device.open_session()), EncapsulationStatus::Success),
        };
        self.handle = self.handle.or(session);
        let header = Header { session: session.unwrap_or(frame.header.session), ..frame.header };
        self.reply(device.reply_header(header, status), &RegisterSession::CURRENT.bytes(), now);
    }

    fn unregister(&mut self, device: &mut Device, header: Header, now: Instant) {
        if self.handle == Some(header.session) {
            device.close_session(header.session);
            self.outbox.close(now);
        }
    }

    fn unconnected(&mut self, device: &mut Device, frame: &Encapsulation<'_>, now: Instant) {
        let message = match unconnected_message(frame) {
            Ok(message) => message,
            Err(status) => return self.refuse(device, frame.header, status, now),
        };
        let fault = device.next_fault();
        self.outbox.work(device.config.delay, now);
        if let Fault::EncapsulationStatus(status) = fault {
            return self.refuse(device, frame.header, status, now);
        }
        let answer = device.unconnected(frame.header.session, message, fault.refusal(), now);
        let header = device.reply_header(frame.header, EncapsulationStatus::Success);
        self.deliver(header, Envelope::Unconnected, answer, fault, now);
    }

    fn connected(&mut self, device: &mut Device, frame: &Encapsulation<'_>, now: Instant) {
        let item =
            match SendRrData::decode(frame.data()).map(|data| (data.interface_handle, data.connected())) {
                Ok((0, Ok(item))) => item,
                Ok(_) => return self.refuse(device, frame.header, EncapsulationStatus::IncorrectData, now),
                Err(_) => return self.refuse(device, frame.header, EncapsulationStatus::InvalidLength, now),
            };
        let session = frame.header.session;
        if !device.is_connected(session, item.id, now) {
            // Nobody consumes this id, as on the network.
            return;
        }
        let fault = device.next_fault();
        self.outbox.work(device.config.delay, now);
        if let Fault::EncapsulationStatus(status) = fault {
            return self.refuse(device, frame.header, status, now);
        }
        let Some((t_o_id, answer)) = device.connected(session, &item, fault.refusal(), now) else { return };
        let id = if device.has(Quirk::OwnConnectionId) { item.id } else { t_o_id };
        let header = device.reply_header(frame.header, EncapsulationStatus::Success);
        self.deliver(header, Envelope::Connected { id, sequence: item.sequence }, answer, fault, now);
    }

    fn deliver(
        &mut self,
        mut header: Header,
        mut envelope: Envelope,
        answer: Answer,
        fault: Fault,
        now: Instant,
    ) {
        let Answer { mut message, wait } = answer;
        match fault {
            Fault::Drop => return,
            Fault::Close => return self.outbox.close(now),
            // A length that cannot be.
            Fault::Garbage => return self.outbox.send([0xFF; 48].to_vec(), wait, now),
            Fault::HalfFrame => {
                let mut whole = envelope.frame(header, &message);
                whole.truncate(whole.len() / 2);
                return self.outbox.send_last(whole, now);
            }
            Fault::WrongContext => header.context = SenderContext(header.context.0.map(|byte| !byte)),
            Fault::WrongSession => header.session = SessionHandle(!header.session.0),
            Fault::WrongService => {
                if let Some(service) = message.first_mut() {
                    *service ^= 1;
                }
            }
            Fault::WrongConnectionId => {
                if let Envelope::Connected { id, .. } = &mut envelope {
                    *id = ConnectionId(!id.0);
                }
            }
            Fault::WrongSequence => {
                if let Envelope::Connected { sequence, .. } = &mut envelope {
                    *sequence = !*sequence;
                }
            }
            Fault::Ok | Fault::ErrorStatus(_) | Fault::EncapsulationStatus(_) => {}
        }
        self.outbox.send(envelope.frame(header, &message), wait, now);
    }

    fn refuse(&mut self, device: &Device, header: Header, status: EncapsulationStatus, now: Instant) {
        self.reply(device.reply_header(header, status), &[], now);
    }

    fn reply(&mut self, header: Header, data: &[u8], now: Instant) {
        let Ok(frame) = Encapsulation::new(header, data) else { return };
        let mut bytes = Vec::new();
        frame.encode(&mut bytes);
        self.outbox.send(bytes, Millis(0), now);
    }
}

impl Envelope {
    /// A whole frame. The device answers nothing that is too long for one.
    fn frame(self, header: Header, message: &[u8]) -> Vec<u8> {
        let mut out = Vec::new();
        match self {
            Self::Unconnected => {
                if let Ok(message) = UnconnectedMessage::new(message) {
                    message.encode(&header, 0, &mut out);
                }
            }
            Self::Connected { id, sequence } => {
                if let Ok(message) = ConnectedMessage::new(message) {
                    message.encode(&header, id, sequence, &mut out);
                }
            }
        }
        out
    }
}

/// The message router request in a frame, or why there is none.
fn unconnected_message<'a>(frame: &Encapsulation<'a>) -> Result<&'a [u8], EncapsulationStatus> {
    let data = SendRrData::decode(frame.data()).map_err(|_| EncapsulationStatus::InvalidLength)?;
    let item = data.unconnected().map_err(|_| EncapsulationStatus::IncorrectData)?;
    if data.interface_handle != 0 || data.packet.find(ItemType::NullAddress).is_none() {
        return Err(EncapsulationStatus::IncorrectData);
    }
    Ok(item.data)
}
