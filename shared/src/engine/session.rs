//! One EtherNet/IP session on one TCP connection: registers, sends, and matches replies to requests.

use alloc::collections::VecDeque;
use alloc::vec::Vec;

use crate::wire::{
    Command, DecodeError, DecodeErrorKind, Deframer, Encapsulation, EncapsulationStatus, Header,
    RegisterSession, SendRrData, SenderContext, SessionHandle, UnconnectedMessage,
};

/// What came in.
#[derive(Debug, PartialEq, Eq)]
pub(super) enum Received {
    /// The session is there.
    Registered,
    /// RegisterSession was refused.
    Refused(EncapsulationStatus),
    /// The reply to the outstanding request: message router bytes, and the whole frame.
    Reply { message: Vec<u8>, at: usize, frame: Vec<u8> },
    /// The target answered the outstanding request with an encapsulation status.
    Status { status: EncapsulationStatus, frame: Vec<u8> },
    /// The stream makes no sense from here on.
    Malformed { error: DecodeError, frame: Vec<u8> },
}

/// The state of one connection.
#[derive(Debug)]
pub(super) struct Session {
    deframer: Deframer,
    handle: Option<SessionHandle>,
    /// The context that the next reply must carry.
    expected: Option<SenderContext>,
    received: VecDeque<Received>,
    dropped: u64,
}

impl Session {
    /// Appends RegisterSession.
    pub(super) fn register(context: SenderContext, out: &mut Vec<u8>) -> Self {
        let header = Header::request(Command::RegisterSession, SessionHandle::default(), context);
        let data = RegisterSession::CURRENT.bytes();
        if let Ok(frame) = Encapsulation::new(header, &data) {
            frame.encode(out);
        }
        Self {
            deframer: Deframer::new(),
            handle: None,
            expected: Some(context),
            received: VecDeque::new(),
            dropped: 0,
        }
    }

    /// Appends a request. `timeout_s` is the target's own time limit in seconds.
    pub(super) fn send(
        &self,
        message: UnconnectedMessage<'_>,
        context: SenderContext,
        timeout_s: u16,
        out: &mut Vec<u8>,
    ) {
        let header = Header::request(Command::SendRRData, self.handle.unwrap_or_default(), context);
        message.encode(&header, timeout_s, out);
    }

    /// The request with this context has been written. Contexts can be guessed: what comes earlier is no reply.
    pub(super) const fn expect(&mut self, context: SenderContext) {
        self.expected = Some(context);
    }

    /// Appends UnRegisterSession.
    pub(super) fn unregister(&self, context: SenderContext, out: &mut Vec<u8>) {
        let header = Header::request(Command::UnRegisterSession, self.handle.unwrap_or_default(), context);
        Encapsulation::empty(header).encode(out);
    }

    /// Takes what was read from the socket.
    pub(super) fn receive(&mut self, bytes: &[u8]) {
        self.deframer.push(bytes);
        loop {
            // A target that does not speak EtherNet/IP shows in its first bytes: do not wait for its "length".
            if let Some(command) = self.deframer.peek_command()
                && command.name().is_none()
            {
                let kind = DecodeErrorKind::Unexpected { field: "command", found: command.0.into() };
                return self.malformed(DecodeError { at: 0, kind });
            }
            match self.deframer.next_frame() {
                Ok(Some(frame)) => {
                    let received = match self.handle {
                        None => registering(&frame, self.expected),
                        Some(handle) => replying(&frame, handle, self.expected),
                    };
                    match received {
                        Some(Received::Registered) => {
                            self.handle = Some(frame.header.session);
                            self.expected = None;
                            self.received.push_back(Received::Registered);
                        }
                        Some(received) => {
                            self.expected = None;
                            self.received.push_back(received);
                        }
                        None => self.dropped += 1,
                    }
                }
                Ok(None) => return,
                Err(error) => return self.malformed(error),
            }
        }
    }

    fn malformed(&mut self, error: DecodeError) {
        let frame = self.deframer.pending_bytes().to_vec();
        self.received.push_back(Received::Malformed { error, frame });
    }

    /// What came in, in order.
    pub(super) fn poll(&mut self) -> Option<Received> {
        self.received.pop_front()
    }

    /// How many new frames answered nothing: a foreign context, a foreign session, or nothing was asked.
    pub(super) const fn take_dropped(&mut self) -> u64 {
        core::mem::replace(&mut self.dropped, 0)
    }
}

fn registering(frame: &Encapsulation<'_>, expected: Option<SenderContext>) -> Option<Received> {
    let header = frame.header;
    if header.command != Command::RegisterSession || Some(header.context) != expected {
        return None;
    }
    if header.status != EncapsulationStatus::Success {
        return Some(Received::Refused(header.status));
    }
    if header.session == SessionHandle::default() {
        let kind = DecodeErrorKind::Unexpected { field: "session handle", found: 0 };
        return Some(Received::Malformed { error: DecodeError { at: 4, kind }, frame: bytes(frame) });
    }
    match RegisterSession::decode(frame.data()) {
        Ok(_) => Some(Received::Registered),
        Err(error) => Some(Received::Malformed { error, frame: bytes(frame) }),
    }
}

fn replying(
    frame: &Encapsulation<'_>,
    handle: SessionHandle,
    expected: Option<SenderContext>,
) -> Option<Received> {
    let header = frame.header;
    if header.command != Command::SendRRData || expected != Some(header.context) {
        return None;
    }
    // Targets that refuse a session handle do not always echo it: the context has matched already.
    if header.status != EncapsulationStatus::Success {
        return Some(Received::Status { status: header.status, frame: bytes(frame) });
    }
    if header.session != handle {
        return None;
    }
    let message = SendRrData::decode(frame.data()).and_then(|data| data.unconnected());
    Some(match message {
        Ok(item) => Received::Reply { message: item.data.to_vec(), at: item.at, frame: bytes(frame) },
        Err(error) => Received::Malformed { error, frame: bytes(frame) },
    })
}

fn bytes(frame: &Encapsulation<'_>) -> Vec<u8> {
    let mut out = Vec::new();
    frame.encode(&mut out);
    out
}
