//! One EtherNet/IP session on one TCP connection: registers, sends, and matches replies to requests.
//!
//! A reply has to carry what its request carried: the sender context of an unconnected one, connection id and sequence
//! count of a connected one. Some targets do not echo all of it. What they echo instead is taken only where nothing
//! else can have been meant: a context of zeros from the first frame of a socket on, and the id that the connection
//! has in the other direction.

use alloc::collections::VecDeque;
use alloc::vec::Vec;
use core::ops::Range;

use crate::wire::{
    Command, ConnectedMessage, ConnectionId, DecodeError, DecodeErrorKind, Deframer, Encapsulation,
    EncapsulationStatus, Header, ListIdentityItem, RegisterSession, SendRrData, SenderContext, SessionHandle,
    UnconnectedMessage,
};

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

/// The reply that is waited for.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub(super) enum Expected {
    #[default]
    Nothing,
    Registration(SenderContext),
    Identity(SenderContext),
    Unconnected(SenderContext),
    /// The context counts only where the target answers with an encapsulation status.
    Connected(SenderContext, Ids, u16),
}

/// The two directions of a connection.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) struct Ids {
    /// Originator to target: what requests carry. The target has picked it.
    pub(super) o_t: ConnectionId,
    /// Target to originator: what replies have to carry. We have picked it.
    pub(super) t_o: ConnectionId,
    /// What the first reply carried.
    pub(super) echoed: Option<ConnectionId>,
}

impl Ids {
    fn answered_by(&self, id: ConnectionId) -> bool {
        match self.echoed {
            Some(echoed) => id == echoed,
            None => id == self.t_o || id == self.o_t,
        }
    }
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

    /// Appends a request over a connection.
    pub(super) fn send_connected(
        &self,
        message: ConnectedMessage<'_>,
        context: SenderContext,
        (id, sequence): (ConnectionId, u16),
        out: &mut Vec<u8>,
    ) {
        message.encode(&self.request(Command::SendUnitData, context), id, sequence, out);
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

/// What a frame is compared with.
#[derive(Clone, Copy)]
struct Matching {
    handle: Option<SessionHandle>,
    expected: Expected,
    no_context: bool,
    fresh: bool,
}

impl Matching {
    fn answer(&self, frame: &Encapsulation<'_>) -> Received {
        let header = frame.header;
        let answer = match self.expected {
            Expected::Registration(_) if header.command == Command::RegisterSession => {
                self.registration(frame)
            }
            Expected::Identity(_) if header.command == Command::ListIdentity => self.identity(frame),
            Expected::Unconnected(_) if header.command == Command::SendRRData => self.unconnected(frame),
            Expected::Connected(_, ids, sequence) if header.command == Command::SendUnitData => {
                self.connected(frame, ids, sequence)
            }
            _ => None,
        };
        answer.unwrap_or(Received::Dropped)
    }

    /// Whether a context is that of the request.
    fn echoes(&self, context: SenderContext) -> bool {
        match self.expected {
            Expected::Nothing => false,
            Expected::Registration(own)
            | Expected::Identity(own)
            | Expected::Unconnected(own)
            | Expected::Connected(own, ..) => context == own,
        }
    }

    fn is_answer(&self, context: SenderContext) -> bool {
        if self.no_context { context == NO_CONTEXT } else { self.echoes(context) }
    }

    fn registration(&self, frame: &Encapsulation<'_>) -> Option<Received> {
        let header = frame.header;
        // Nothing but RegisterSession has been written: a first frame without a context cannot answer anything else.
        let told_nothing = self.fresh && header.context == NO_CONTEXT;
        if !told_nothing && !self.is_answer(header.context) {
            return None;
        }
        if header.status != EncapsulationStatus::Success {
            return Some(Received::Refused(header.status));
        }
        if header.session == SessionHandle::default() {
            let kind = DecodeErrorKind::Unexpected { field: "session handle", found: 0 };
            return Some(Received::Malformed { error: DecodeError { at: 4, kind }, frame: bytes(frame) });
        }
        Some(match RegisterSession::decode(frame.data()) {
            Ok(_) => Received::Registered,
            Err(error) => Received::Malformed { error, frame: bytes(frame) },
        })
    }

    fn identity(&self, frame: &Encapsulation<'_>) -> Option<Received> {
        let header = frame.header;
        if !self.is_answer(header.context) {
            return None;
        }
        let answered = header.status == EncapsulationStatus::Success;
        let item = answered.then(|| ListIdentityItem::decode_reply(frame.data()).ok()).flatten();
        Some(Received::Identity(item))
    }

    fn unconnected(&self, frame: &Encapsulation<'_>) -> Option<Received> {
        let header = frame.header;
        if !self.is_answer(header.context) {
            return None;
        }
        // Targets that refuse a session handle do not always echo it: the context has matched already.
        if header.status != EncapsulationStatus::Success {
            return Some(Received::Status { status: header.status, frame: bytes(frame) });
        }
        if Some(header.session) != self.handle {
            return None;
        }
        let message = SendRrData::decode(frame.data()).and_then(|data| data.unconnected());
        Some(match message {
            Ok(item) => {
                let message = item.at..item.at + item.data.len();
                Received::Reply { frame: bytes(frame), message, id: None }
            }
            Err(error) => Received::Malformed { error, frame: bytes(frame) },
        })
    }

    fn connected(&self, frame: &Encapsulation<'_>, ids: Ids, sequence: u16) -> Option<Received> {
        let header = frame.header;
        if header.status != EncapsulationStatus::Success {
            let frame = || Received::Status { status: header.status, frame: bytes(frame) };
            return self.is_answer(header.context).then(frame);
        }
        if Some(header.session) != self.handle {
            return None;
        }
        match SendRrData::decode(frame.data()).and_then(|data| data.connected()) {
            Ok(item) if item.sequence != sequence || !ids.answered_by(item.id) => None,
            Ok(item) => Some(Received::Reply {
                frame: bytes(frame),
                message: item.at..item.at + item.message.len(),
                id: Some(item.id),
            }),
            Err(error) => Some(Received::Malformed { error, frame: bytes(frame) }),
        }
    }
}

/// What targets send that do not echo the sender context.
const NO_CONTEXT: SenderContext = SenderContext([0; 8]);

fn bytes(frame: &Encapsulation<'_>) -> Vec<u8> {
    let mut out = Vec::new();
    frame.encode(&mut out);
    out
}
