//! One EtherNet/IP session on one TCP connection: registers, sends, and takes what comes in.

use alloc::collections::VecDeque;
use alloc::vec::Vec;
use core::ops::Range;

use crate::wire::{
    Command, ConnectedMessage, ConnectionId, DecodeError, DecodeErrorKind, Deframer, Encapsulation,
    EncapsulationStatus, Header, ListIdentityItem, RegisterSession, SenderContext, SessionHandle,
    UnconnectedMessage,
};

use super::connection::Connection;
use super::matching::{Expected, Matching};
use super::time::Instant;

/// What came in.
#[derive(Debug, PartialEq, Eq)]
pub(super) enum Received {
    /// The session is there.
    Registered,
    /// RegisterSession was refused.
    Refused(EncapsulationStatus),
    /// Who the device is, if it can be read.
    Identity(Option<ListIdentityItem>),
    /// The reply to the outstanding request: the whole frame, and where its message router bytes are.
    Reply { frame: Vec<u8>, message: Range<usize>, id: Option<ConnectionId> },
    /// The target answered the outstanding request with an encapsulation status.
    Status { status: EncapsulationStatus, frame: Vec<u8> },
    /// A frame that answers nothing.
    Dropped,
    /// The stream makes no sense from here on.
    Malformed { error: DecodeError, frame: Vec<u8> },
}

/// The state of one connection.
#[derive(Debug)]
pub(super) struct Session {
    deframer: Deframer,
    handle: Option<SessionHandle>,
    expected: Expected,
    received: VecDeque<Received>,
    /// The first frame of the socket is still to come.
    fresh: bool,
    /// The target answers with a context of zeros.
    no_context: bool,
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
            expected: Expected::Registration(context),
            received: VecDeque::new(),
            fresh: true,
            no_context: false,
        }
    }

    /// Whether the target answers with a context of zeros.
    pub(super) const fn has_no_context(&self) -> bool {
        self.no_context
    }

    /// Appends a request. `timeout_s` is the target's own time limit in seconds.
    pub(super) fn send_unconnected(
        &self,
        message: UnconnectedMessage<'_>,
        context: SenderContext,
        timeout_s: u16,
        out: &mut Vec<u8>,
    ) {
        message.encode(&self.request(Command::SendRRData, context), timeout_s, out);
    }

    /// Appends a request over a connection, which fits into a frame. Returns what its reply will carry.
    pub(super) fn send_connected(
        &self,
        request: &[u8],
        context: SenderContext,
        connection: &mut Connection,
        now: Instant,
        out: &mut Vec<u8>,
    ) -> Expected {
        let sequence = connection.next_sequence(now);
        if let Ok(message) = ConnectedMessage::new(request) {
            let header = self.request(Command::SendUnitData, context);
            message.encode(&header, connection.ids.o_t, sequence, out);
        }
        Expected::Connected(context, connection.ids, sequence)
    }

    /// Appends ListIdentity.
    pub(super) fn ask_identity(&self, context: SenderContext, out: &mut Vec<u8>) {
        Encapsulation::empty(self.request(Command::ListIdentity, context)).encode(out);
    }

    /// Appends UnRegisterSession.
    pub(super) fn unregister(&self, context: SenderContext, out: &mut Vec<u8>) {
        Encapsulation::empty(self.request(Command::UnRegisterSession, context)).encode(out);
    }

    fn request(&self, command: Command, context: SenderContext) -> Header {
        Header::request(command, self.handle.unwrap_or_default(), context)
    }

    /// The request with this reply has been written. Contexts can be guessed: what comes earlier is no reply.
    pub(super) const fn expect(&mut self, expected: Expected) {
        self.expected = expected;
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
            let matching = Matching {
                handle: self.handle,
                expected: self.expected,
                no_context: self.no_context,
                fresh: core::mem::take(&mut self.fresh),
            };
            match self.deframer.next_frame() {
                Ok(Some(frame)) => {
                    let header = frame.header;
                    let received = matching.answer(&frame);
                    match &received {
                        Received::Registered => {
                            self.handle = Some(header.session);
                            self.no_context = !matching.echoes(header.context);
                            self.expected = Expected::Nothing;
                        }
                        Received::Dropped => {}
                        _ => self.expected = Expected::Nothing,
                    }
                    self.received.push_back(received);
                }
                Ok(None) => {
                    self.fresh = matching.fresh;
                    return;
                }
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
}
