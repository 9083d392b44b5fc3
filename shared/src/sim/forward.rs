//! Unconnected_Send: messages that are handed on along a route.

use crate::engine::time::{Instant, Millis};
use crate::wire::{
    ConnectionTriad, DecodeError, GeneralStatus, Reader, RequestTimeout, RouterRefusal, ServiceCode,
};

use super::device::{Caller, Device};
use super::request::{Answer, Refusal};
use super::route::{INVALID_SEGMENT, Stuck, TIMED_OUT, follow, words};

/// How many Unconnected_Sends may be around a message: each is carried out inside of the one before.
const MAX_DEPTH: u8 = 8;

/// No buffer memory available.
const NO_BUFFER: u16 = 0x0301;

impl Device {
    /// The reply is that of the message; what goes wrong on the way is a reply of Unconnected_Send.
    pub(super) fn forward(&mut self, module: usize, data: &[u8], caller: Caller, now: Instant) -> Answer {
        let refuse = |refusal| Answer::new(ServiceCode::UnconnectedSend, Err(refusal));
        let mut send = match Send::read(data) {
            Ok(send) => send,
            Err(status) => return refuse(status.into()),
        };
        let empty = send.route.is_empty();
        let result = follow(&self.modules, module, &mut send.route).and_then(|target| {
            let remaining = words(&send.route);
            if empty || remaining > 0 {
                return Err(Stuck { status: INVALID_SEGMENT, remaining });
            }
            if caller.depth == MAX_DEPTH {
                return Err(Stuck { status: NO_BUFFER, remaining });
            }
            Ok(target)
        });
        match result {
            Ok(target) => self.ask(target, send.message, Caller { depth: caller.depth + 1, ..caller }, now),
            Err(stuck) => refuse(stuck.refusal(None, send.timeout)),
        }
    }
}

/// The parts of the request. The route is not decoded as a whole, because a router looks at the next hop only.
#[derive(Clone, Debug)]
struct Send<'a> {
    timeout: RequestTimeout,
    message: &'a [u8],
    route: Reader<'a>,
}

impl<'a> Send<'a> {
    fn read(data: &'a [u8]) -> Result<Self, GeneralStatus> {
        let mut reader = Reader::new(data);
        let mut parts = || -> Result<Self, DecodeError> {
            let timeout = RequestTimeout::read(&mut reader)?;
            let length = usize::from(reader.u16()?);
            let message = reader.take(length)?;
            if !length.is_multiple_of(2) {
                reader.u8()?;
            }
            let [size, _reserved] = reader.array()?;
            let route = reader.sub(2 * usize::from(size))?;
            Ok(Self { timeout, message, route })
        };
        let send = parts().map_err(|_| GeneralStatus::NotEnoughData)?;
        reader.finish().map_err(|_| GeneralStatus::TooMuchData)?;
        // Service and path size are the least that a message has.
        if send.message.len() < 2 {
            return Err(GeneralStatus::InvalidParameter);
        }
        Ok(send)
    }
}

impl Stuck {
    /// What the router says. When nobody answers it says so after the time that it was given.
    pub(super) fn refusal(self, triad: Option<ConnectionTriad>, timeout: RequestTimeout) -> Refusal {
        let wait = if self.status == TIMED_OUT { Millis::from(timeout.millis()) } else { Millis(0) };
        let mut refusal = Refusal::from(GeneralStatus::ConnectionFailure);
        refusal.additional.extend_from_slice(&self.status.to_le_bytes());
        RouterRefusal { triad, remaining_path: Some(self.remaining) }.encode(&mut refusal.data);
        Refusal { wait, ..refusal }
    }
}
