//! The device at the end of the TCP connections, with everything around it.

use alloc::vec::Vec;

use crate::engine::time::Instant;
use crate::wire::{
    ClassCode, ConnectedItem, ConnectionId, EncapsulationStatus, GeneralStatus, Header,
    MAX_CONNECTED_MESSAGE, SenderContext, ServiceCode, SessionHandle,
};

use super::config::{Quirk, SimConfig};
use super::connections::Connections;
use super::counters::{Count, Counters};
use super::fault::Fault;
use super::module::SimModule;
use super::objects::Objects;
use super::profile::SimProfile;
use super::request::{Answer, Head, Refusal, Request, service_of};
use super::tags::Call;

/// A simulated device, its chassis, and the connections to all of it. See the [module](super) for what is in it.
#[derive(Clone, Debug)]
pub struct Device {
    pub(super) config: SimConfig,
    /// The device itself first.
    pub(super) modules: Vec<Objects>,
    pub(super) connections: Connections,
    pub(super) counters: Counters,
    last_session: u32,
    answered: usize,
}

/// Index of the device itself among the modules.
pub(super) const FRONT: usize = 0;

/// Who asks, and how.
#[derive(Clone, Copy, Debug)]
pub(super) struct Caller {
    pub(super) session: SessionHandle,
    /// How many Unconnected_Sends are around the request.
    pub(super) depth: u8,
    /// Whether it came over a connection.
    pub(super) connected: bool,
    /// The longest reply, in bytes.
    pub(super) room: usize,
}

impl Caller {
    /// The reply to what is wrapped could not be used: the connection would begin at the last router.
    const fn may_open(self) -> bool {
        self.depth == 0 && !self.connected
    }
}

impl Default for Device {
    fn default() -> Self {
        Self::new(SimConfig::default())
    }
}

impl Device {
    /// A device just switched on.
    pub fn new(config: SimConfig) -> Self {
        let own = SimModule {
            slot: config.profile.slot(),
            ip: Some(config.address.ip),
            identity: config.identity.clone(),
        };
        let modules = [own].into_iter().chain(config.modules.iter().cloned()).map(Objects::new);
        let mut modules: Vec<_> = modules.collect();
        if let Some(own) = modules.first_mut() {
            own.registers.clone_from(&config.registers);
        }
        Self {
            config,
            modules,
            connections: Connections::default(),
            counters: Counters::default(),
            last_session: 0,
            answered: 0,
        }
    }

    /// Answers an unconnected message router request. Any bytes get an answer: what cannot be understood is refused.
    pub fn answer(&mut self, request: &[u8], now: Instant) -> Vec<u8> {
        self.unconnected(SessionHandle(0), request, None, now).message
    }

    /// What the device has done so far.
    pub const fn counters(&self) -> Counters {
        self.counters
    }

    /// When a connection will have been silent for too long.
    pub fn poll_timeout(&self) -> Option<Instant> {
        self.connections.next_expiry()
    }

    /// Closes the connections that have been silent for too long. Requests do so, too; calling it late changes only
    /// when [`Self::counters`] says so.
    pub fn handle_timeout(&mut self, now: Instant) {
        for connection in self.connections.expire(now) {
            self.counters.timed_out += 1;
            count(&mut self.modules, FRONT, connection.module, Count::Timeout);
        }
    }

    /// Answers a request of a session, or refuses it without looking.
    pub(super) fn unconnected(
        &mut self,
        session: SessionHandle,
        request: &[u8],
        refuse: Option<GeneralStatus>,
        now: Instant,
    ) -> Answer {
        self.handle_timeout(now);
        self.counters.unconnected += u64::from(!opens_or_closes(request));
        let service = service_of(request);
        if let Some(status) = refuse {
            return Answer::refusal(service, status);
        }
        let room = self.config.profile.max_unconnected();
        let answer = self.ask(FRONT, request, Caller { session, depth: 0, connected: false, room }, now);
        within(room, service, answer)
    }

    /// Answers a connected request; with the id for the reply. None: there is no such connection.
    pub(super) fn connected(
        &mut self,
        session: SessionHandle,
        item: &ConnectedItem<'_>,
        refuse: Option<GeneralStatus>,
        now: Instant,
    ) -> Option<(ConnectionId, Answer)> {
        let connection = self.connections.by_id(session, item.id)?;
        connection.touch(now);
        let (t_o_id, module) = (connection.t_o_id, connection.module);
        let [o_t_max, t_o_max] = [connection.o_t_size, connection.t_o_size].map(message_size);
        if let Some((_, answer)) = connection.last.as_ref().filter(|last| last.0 == item.sequence) {
            self.counters.repeated += 1;
            return Some((t_o_id, answer.clone()));
        }
        self.counters.connected += 1;
        let service = service_of(item.message);
        let too_long = (item.message.len() > o_t_max).then_some(GeneralStatus::TooMuchData);
        let caller = Caller { session, depth: 0, connected: true, room: t_o_max };
        let answer = match refuse.or(too_long) {
            Some(status) => Answer::refusal(service, status),
            None => self.ask(module, item.message, caller, now),
        };
        let answer = within(t_o_max, service, answer);
        if let Some(connection) = self.connections.by_id(session, item.id) {
            connection.last = Some((item.sequence, answer.clone()));
        }
        Some((t_o_id, answer))
    }

    /// Whether [`Self::connected`] has an answer; counted if it has none.
    pub(super) fn is_connected(&mut self, session: SessionHandle, id: ConnectionId, now: Instant) -> bool {
        self.handle_timeout(now);
        let there = self.connections.by_id(session, id).is_some();
        self.counters.dropped += u64::from(!there);
        there
    }

    /// Asks one module.
    pub(super) fn ask(&mut self, module: usize, request: &[u8], caller: Caller, now: Instant) -> Answer {
        let service = service_of(request);
        let head = match Head::decode(request) {
            Ok(head) => head,
            Err(status) => return Answer::refusal(service, status),
        };
        let (manager, data) = (is_connection_manager(&head), head.data);
        let profile = self.config.profile;
        // What is around a message that is handed on is not counted.
        let is_wrapper = manager && service == ServiceCode::UnconnectedSend;
        let is_too_long = profile != SimProfile::Generic && request.len() > profile.max_unconnected();
        if is_too_long && !caller.connected && !is_wrapper {
            return Answer::refusal(service, GeneralStatus::TooMuchData);
        }
        let outcome = match service {
            ServiceCode::UnconnectedSend if manager && profile.routes() => {
                return self.forward(module, data, caller, now);
            }
            ServiceCode::MultipleServicePacket
                if profile.packs() && head.is_to(ClassCode::MessageRouter, 1) =>
            {
                self.packet(module, data, caller, now)
            }
            ServiceCode::ForwardOpen if manager && caller.may_open() => {
                self.open(module, false, data, caller.session, now)
            }
            ServiceCode::LargeForwardOpen if manager && caller.may_open() && self.config.large => {
                self.open(module, true, data, caller.session, now)
            }
            ServiceCode::ForwardClose if manager && caller.may_open() => self.close(module, data),
            _ => self.carry_out(module, &head, caller, now),
        };
        Answer::new(service, outcome)
    }

    /// Asks the tags, then the objects.
    fn carry_out(
        &mut self,
        module: usize,
        head: &Head<'_>,
        caller: Caller,
        now: Instant,
    ) -> Result<Vec<u8>, Refusal> {
        if module == FRONT
            && let Some(tags) = &mut self.config.tags
        {
            let room = caller.room.saturating_sub(Answer::HEAD);
            let call = Call { head, room, connected: caller.connected, now };
            if let Some(outcome) = tags.answer(&call, &mut self.counters) {
                return outcome;
            }
        }
        let request = Request::of(head)?;
        let objects = self.modules.get_mut(module).ok_or(GeneralStatus::PathDestinationUnknown)?;
        objects.carry_out(&request, now)
    }

    /// A session handle that no other connection has. Never 0.
    pub(super) fn open_session(&mut self) -> SessionHandle {
        self.last_session = self.last_session.checked_add(1).unwrap_or(1);
        SessionHandle(self.last_session)
    }

    /// The session was unregistered: its connections end, too.
    pub(super) fn close_session(&mut self, session: SessionHandle) {
        let closed = self.connections.close_session(session);
        self.counters.unregistered += u64::try_from(closed).unwrap_or(u64::MAX);
    }

    /// What is to go wrong with the next reply.
    pub(super) fn next_fault(&mut self) -> Fault {
        let count = self.config.faults.len();
        let fault = self.answered.checked_rem(count).and_then(|turn| self.config.faults.get(turn));
        self.answered = self.answered.wrapping_add(1);
        fault.copied().unwrap_or(Fault::Ok)
    }

    pub(super) fn has(&self, quirk: Quirk) -> bool {
        self.config.quirks.contains(&quirk)
    }

    /// The header of a reply.
    pub(super) fn reply_header(&self, request: Header, status: EncapsulationStatus) -> Header {
        let reply = request.reply(status);
        if self.has(Quirk::NoContext) { Header { context: SenderContext::default(), ..reply } } else { reply }
    }
}

/// Counts something in the Connection Managers at both ends of a route.
pub(super) fn count(modules: &mut [Objects], from: usize, to: usize, what: Count) {
    for (index, objects) in modules.iter_mut().enumerate() {
        if index == from || index == to {
            objects.counts.add(what);
        }
    }
}

fn is_connection_manager(head: &Head<'_>) -> bool {
    head.is_to(ClassCode::ConnectionManager, 1)
}

fn opens_or_closes(request: &[u8]) -> bool {
    let service = service_of(request);
    let asked = [ServiceCode::ForwardOpen, ServiceCode::LargeForwardOpen, ServiceCode::ForwardClose]
        .contains(&service);
    asked && Head::decode(request).is_ok_and(|head| is_connection_manager(&head))
}

/// A connection size counts the sequence count.
fn message_size(connection_size: u16) -> usize {
    usize::from(connection_size).saturating_sub(2).min(MAX_CONNECTED_MESSAGE)
}

fn within(max: usize, service: ServiceCode, answer: Answer) -> Answer {
    if answer.message.len() <= max {
        return answer;
    }
    Answer::refusal(service, GeneralStatus::ReplyDataTooLarge)
}
