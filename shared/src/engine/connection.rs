//! Class 3 connections: how one is opened, and what is known of an open one.

use alloc::vec::Vec;

use crate::config::Profile;
use crate::plan::MessagePlan;
use crate::wire::{
    ClassCode, ConnectionId, ConnectionParameters, ConnectionTriad, Epath, ForwardClose, ForwardOpen,
    ForwardOpenReply, GeneralStatus, MAX_CLASSIC_SIZE, MessageRouterReply, RequestTimeout, ServiceCode,
    TimeoutMultiplier, TooLong,
};

use super::matching::Ids;
use super::time::{Instant, Millis};

/// What we ask for unless more is needed. libplctag: 0x43F8, 504 bytes.
const USUAL_SIZE: u16 = 504;

/// Large connections of Logix controllers. libplctag.
const LOGIX_SIZE: u16 = 4_002;

/// Large connections of Omron controllers. libplctag.
const OMRON_SIZE: u16 = 1_994;

/// Requested packet interval. Class 3 has no packets of its own accord: it only sets the watchdog.
const RPI_US: u32 = 2_000_000;

/// 2 s x 8: longer than any idle connection is kept (10 s), and short enough that a target is soon free of one that
/// we have lost.
const MULTIPLIER: TimeoutMultiplier = TimeoutMultiplier(1);

/// How long a target keeps a connection without a request.
const WATCHDOG: Millis = Millis(MULTIPLIER.watchdog_us(RPI_US) / 1_000);

/// A request may need so long to its target that a connection which is silent for longer is not written to.
const MAX_SILENCE: Millis = Millis(WATCHDOG.0 - 2_000);

/// A connection that is kept alive is read over at least this often, so that one read may come late.
pub(super) const MAX_KEEP_ALIVE: Millis = Millis(WATCHDOG.0 / 2);

/// The router's own time for Forward_Close.
const ROUTER_TIME_MS: u32 = 1_000;

/// How often Forward_Open is tried with other parameters.
const ATTEMPTS: u8 = 4;

/// "Connection in use or duplicate Forward Open".
const IN_USE: u16 = 0x0100;

/// "Invalid connection size"; the next word is the size that the target takes.
const INVALID_SIZE: u16 = 0x0109;

/// Who we are in the names of connections, and the numbers that are used next.
#[derive(Clone, Copy, Debug)]
pub struct Originator {
    /// Tells this program from all others with the same vendor id.
    serial: u32,
    connection: u16,
    id: u32,
}

impl Originator {
    /// No vendor has this id.
    const VENDOR: u16 = u16::MAX;

    /// From a number that differs from start to start: a target may still know the connections of an earlier one.
    pub const fn new(seed: u64) -> Self {
        let [serial @ .., c0, c1, i0, i1] = seed.to_le_bytes();
        Self {
            serial: u32::from_le_bytes(serial),
            connection: u16::from_le_bytes([c0, c1]),
            id: u32::from_le_bytes([0, i0, i1, 0]),
        }
    }

    fn next_triad(&mut self) -> ConnectionTriad {
        self.connection = self.connection.wrapping_add(1);
        ConnectionTriad { serial: self.connection, vendor: Self::VENDOR, originator: self.serial }
    }

    fn next_id(&mut self) -> ConnectionId {
        // 0 is what targets say that have no connection.
        self.id = self.id.checked_add(1).unwrap_or(1);
        ConnectionId(self.id)
    }
}

/// A Forward_Open under way.
#[derive(Clone, Debug)]
pub(super) struct Opening {
    route: Epath,
    triad: ConnectionTriad,
    t_o: ConnectionId,
    size: u16,
    /// The request does not fit into less than this.
    needed: u16,
    /// How long the connection stays open without being used.
    idle: Millis,
    large: bool,
    attempts: u8,
}

/// What became of a Forward_Open.
#[derive(Debug)]
pub(super) enum Opened {
    Yes(Connection),
    /// With other parameters.
    Again(Opening),
    No,
}

impl Opening {
    pub(super) fn new(plan: &MessagePlan, profile: Profile, originator: &mut Originator) -> Self {
        let needed = needed_size(plan);
        let usual = match profile {
            Profile::Logix => LOGIX_SIZE,
            Profile::Omron => OMRON_SIZE,
            Profile::Auto | Profile::Generic | Profile::Micro800 => USUAL_SIZE,
        };
        let size = usual.max(needed);
        Self {
            route: plan.routed(profile).route().clone(),
            triad: originator.next_triad(),
            t_o: originator.next_id(),
            size,
            needed,
            idle: plan.idle_ms().into(),
            large: size > MAX_CLASSIC_SIZE,
            attempts: 1,
        }
    }

    pub(super) fn request(&self, timeout: RequestTimeout) -> Result<Vec<u8>, TooLong> {
        let open = ForwardOpen {
            timeout,
            o_t_id: ConnectionId(0),
            t_o_id: self.t_o,
            triad: self.triad,
            multiplier: MULTIPLIER,
            o_t_rpi_us: RPI_US,
            o_t: ConnectionParameters::explicit(self.size),
            t_o_rpi_us: RPI_US,
            t_o: ConnectionParameters::explicit(self.size),
            transport: ForwardOpen::CLASS_3,
            path: path(&self.route),
        };
        Ok(open.request(self.large)?.bytes())
    }

    /// The service that the reply has to be of.
    pub(super) const fn service(&self) -> ServiceCode {
        if self.large { ServiceCode::LargeForwardOpen } else { ServiceCode::ForwardOpen }
    }

    /// Closes what may have been opened although nobody has heard of it.
    pub(super) fn close_request(&self) -> Option<Vec<u8>> {
        close_request(self.triad, &self.route)
    }

    /// Whether the target's answer is about this connection at all.
    pub(super) fn answered(
        mut self,
        reply: &MessageRouterReply<'_>,
        originator: &mut Originator,
        now: Instant,
    ) -> Opened {
        if reply.status == GeneralStatus::Success {
            return match ForwardOpenReply::decode(reply.data) {
                Ok(open) if open.triad == self.triad => Opened::Yes(Connection::new(self, open.o_t_id, now)),
                _ => Opened::No,
            };
        }
        let mut words = reply.additional.words();
        let (first, second) = (words.next(), words.next());
        self.attempts += 1;
        if self.attempts > ATTEMPTS {
            return Opened::No;
        }
        match (reply.status, first) {
            (GeneralStatus::ServiceNotSupported, _) if self.large && self.needed <= MAX_CLASSIC_SIZE => {
                (self.large, self.size) = (false, USUAL_SIZE.max(self.needed));
            }
            (GeneralStatus::ConnectionFailure, Some(INVALID_SIZE)) => match second {
                Some(size) if (self.needed..self.size).contains(&size) => {
                    (self.large, self.size) = (size > MAX_CLASSIC_SIZE, size);
                }
                _ => return Opened::No,
            },
            (GeneralStatus::ConnectionFailure, Some(IN_USE)) => {
                (self.triad, self.t_o) = (originator.next_triad(), originator.next_id());
            }
            _ => return Opened::No,
        }
        Opened::Again(self)
    }
}

/// An open connection.
#[derive(Clone, Debug)]
pub(super) struct Connection {
    pub(super) route: Epath,
    pub(super) triad: ConnectionTriad,
    pub(super) ids: Ids,
    pub(super) size: u16,
    sequence: u16,
    pub(super) last_used: Instant,
    /// When the last request went out: the target's watchdog runs from its arrival, not from the reply.
    pub(super) last_sent: Instant,
    /// How long it stays open without being used.
    pub(super) idle: Millis,
    /// Closed as soon as no message wants it.
    pub(super) close_wanted: bool,
    pub(super) requests: u64,
}

impl Connection {
    fn new(opening: Opening, o_t: ConnectionId, now: Instant) -> Self {
        Self {
            ids: Ids { o_t, t_o: opening.t_o, echoed: None },
            route: opening.route,
            triad: opening.triad,
            size: opening.size,
            sequence: 0,
            last_used: now,
            last_sent: now,
            idle: opening.idle,
            close_wanted: false,
            requests: 0,
        }
    }

    /// For a request that is sent now. Never 0: that is what a target remembers before the first request.
    pub(super) const fn next_sequence(&mut self, now: Instant) -> u16 {
        self.last_sent = now;
        self.sequence = self.sequence.wrapping_add(1);
        if self.sequence == 0 {
            self.sequence = 1;
        }
        self.sequence
    }

    pub(super) fn close_request(&self) -> Option<Vec<u8>> {
        close_request(self.triad, &self.route)
    }

    /// The target may have given it up.
    pub(super) fn is_stale(&self, now: Instant) -> bool {
        self.last_sent + MAX_SILENCE <= now
    }

    /// Whether this message fits. A reply that does not is refused by the target, with 0x11.
    pub(super) fn fits(&self, plan: &MessagePlan) -> bool {
        self.size >= needed_size(plan)
    }
}

/// Sequence count and request. The longest reply, 2 + 4 + 490 bytes, fits into the usual size; `ResData` is mostly far
/// larger than what comes, so that a target with smaller connections need not be given up.
fn needed_size(plan: &MessagePlan) -> u16 {
    u16::try_from(2 + plan.bytes().len()).unwrap_or(u16::MAX)
}

/// Its parts are short: there is always one.
fn close_request(triad: ConnectionTriad, route: &Epath) -> Option<Vec<u8>> {
    let timeout = RequestTimeout::at_least(ROUTER_TIME_MS);
    let request = ForwardClose { timeout, triad, path: path(route) }.request().ok()?;
    Some(request.bytes())
}

/// Explicit messages end at the Message Router.
fn path(route: &Epath) -> Epath {
    route.clone().join(&Epath::object(ClassCode::MessageRouter.0, 1))
}
