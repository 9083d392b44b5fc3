//! Which frame answers which request.
//!
//! A reply has to carry what its request carried: the sender context of an unconnected one, connection id and sequence
//! count of a connected one. Some targets do not echo all of it. What they echo instead is taken only where nothing
//! else can have been meant: a context of zeros from the first frame of a socket on, and the id that the connection
//! has in the other direction.

use alloc::vec::Vec;

use crate::wire::{
    Command, ConnectionId, DecodeError, DecodeErrorKind, Encapsulation, EncapsulationStatus,
    ListIdentityItem, RegisterSession, SendRrData, SenderContext, SessionHandle,
};

use super::session::Received;

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

/// What a frame is compared with.
#[derive(Clone, Copy)]
pub(super) struct Matching {
    pub(super) handle: Option<SessionHandle>,
    pub(super) expected: Expected,
    pub(super) no_context: bool,
    /// It is the first frame of its socket.
    pub(super) fresh: bool,
}

impl Matching {
    /// What a frame is.
    pub(super) fn answer(&self, frame: &Encapsulation<'_>) -> Received {
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
    pub(super) fn echoes(&self, context: SenderContext) -> bool {
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
