//! Calls into clients, what they want done, and who may have a session.

use alloc::boxed::Box;

use crate::config::{BlockId, Target};
use crate::engine::channel::{CONTROLLER_CONNECTIONS, CONTROLLER_SESSIONS};
use crate::engine::client::{Client, ClientId, Context, Output};
use crate::engine::event::{Event, Exchange, LinkId};
use crate::engine::time::Instant;
use crate::plan::MessagePlan;

use super::Engine;

impl Engine {
    /// Whether the controller may have a session with this target; an idle one is given up if need be.
    pub(super) fn session_for_controller(&mut self, client: ClientId, now: Instant) -> bool {
        if self.clients.get(&client).is_some_and(Client::counts_for_controller) {
            return true;
        }
        if self.clients.values().filter(|client| client.counts_for_controller()).count() < CONTROLLER_SESSIONS
        {
            return true;
        }
        let idle =
            self.clients.iter().filter(|(_, client)| client.counts_for_controller() && client.is_idle());
        let oldest = idle.min_by_key(|(_, client)| client.last_used()).map(|(id, _)| *id);
        oldest.is_some_and(|oldest| {
            self.client(oldest, now, Client::close);
            true
        })
    }

    /// Whether the controller may have a class 3 connection for this message; idle ones are given up if need be.
    pub(super) fn connection_for_controller(
        &mut self,
        client: ClientId,
        plan: &MessagePlan,
        now: Instant,
    ) -> bool {
        if plan.connection().is_none() {
            return true;
        }
        if self.clients.get(&client).is_some_and(|client| client.has_connection_for(plan)) {
            return true;
        }
        let counted = || self.clients.iter().filter(|(_, client)| client.counts_for_controller());
        if counted().map(|(_, client)| client.connections_in_use()).sum::<usize>() < CONTROLLER_CONNECTIONS {
            return true;
        }
        let spare = counted()
            .filter_map(|(id, client)| client.spare_connection().map(|(since, serial)| (since, *id, serial)));
        spare.min().is_some_and(|(_, id, serial)| {
            self.client(id, now, |client, cx| client.give_up_connection(serial, cx));
            true
        })
    }

    /// Closes the session with a target that no block needs any more, and forgets it once it is closed.
    pub(super) fn retire(&mut self, target: &Target, now: Instant) {
        let needed = self.blocks.values().any(|entry| {
            let planned = entry.plan.as_ref().ok().map(|plan| plan.target());
            planned == Some(target)
                || entry.active.as_ref().is_some_and(|active| active.plan.target() == target)
        });
        let Some(id) = self.names.get(target).copied().filter(|_| !needed) else { return };
        self.client(id, now, Client::close);
        if self.clients.get(&id).is_some_and(|client| client.link_id().is_none()) {
            self.clients.remove(&id);
            self.names.remove(target);
            self.events.push_back(Event::Target { target: target.clone(), view: None });
        }
    }

    pub(super) fn retire_client(&mut self, id: ClientId, now: Instant) {
        if let Some(target) = self.clients.get(&id).map(|client| client.target().clone()) {
            self.retire(&target, now);
        }
    }

    pub(super) fn link<T>(
        &mut self,
        link: LinkId,
        now: Instant,
        call: impl FnOnce(&mut Client, &mut Context<'_>) -> T,
    ) -> Option<T> {
        let id = *self.links.get(&link)?;
        let call = |client: &mut Client, cx: &mut Context<'_>| {
            (client.link_id() == Some(link)).then(|| call(client, cx))
        };
        self.client(id, now, call).flatten()
    }

    /// The client of a target; a new one if there is none.
    pub(super) fn client_of(&mut self, target: &Target) -> ClientId {
        if let Some(id) = self.names.get(target) {
            return *id;
        }
        self.next_client += 1;
        let id = ClientId(self.next_client);
        self.names.insert(target.clone(), id);
        self.clients.insert(id, Client::new(target.clone()));
        id
    }

    /// Calls a client and carries out what it wants.
    pub(super) fn client<T>(
        &mut self,
        id: ClientId,
        now: Instant,
        call: impl FnOnce(&mut Client, &mut Context<'_>) -> T,
    ) -> Option<T> {
        let client = self.clients.get_mut(&id)?;
        // Calls are nested: an inner one finds this empty and has its own.
        let mut out = core::mem::take(&mut self.outputs);
        let (next_link, originator) = (&mut self.next_link, &mut self.originator);
        let result = call(client, &mut Context { now, next_link, originator, out: &mut out });
        let due = client.poll_timeout().filter(|at| client.armed.is_none_or(|armed| *at < armed));
        if let Some(due) = due {
            // One that is too early does no harm: most clients are used again before their time.
            client.armed.replace(due).map(|armed| self.housekeeping.remove(&(armed, id)));
            self.housekeeping.insert((due, id));
        }
        if client.take_changed() {
            let view = Some(Box::new(client.view()));
            self.events.push_back(Event::Target { target: client.target().clone(), view });
        }
        while let Some(output) = out.pop_front() {
            self.output(id, output, now);
        }
        self.outputs = out;
        Some(result)
    }

    fn output(&mut self, id: ClientId, output: Output, now: Instant) {
        match output {
            Output::Connect(link) => {
                self.links.insert(link, id);
                let target = self.clients.get(&id).map(|client| client.target().clone());
                self.events.extend(target.map(|target| Event::Connect { link, target }));
            }
            Output::Disconnect(link) => {
                self.links.remove(&link);
                self.events.push_back(Event::Disconnect { link });
            }
            Output::Transmit(link) => self.events.push_back(Event::Transmit { link }),
            Output::Wants(wants) => self.events.push_back(Event::Wants(wants)),
            Output::Block(block, input) => self.step(block, input, now),
            Output::Wrote(block, frame) => {
                if let Some(exchange) = self.exchange(block) {
                    exchange.request_frame = Some(frame);
                }
            }
            Output::Read(block, frame, response) => {
                if let Some(exchange) = self.exchange(block) {
                    exchange.response_frame = Some(frame);
                    exchange.response_at = response;
                }
            }
        }
    }

    /// What is known of the wire of the message under way.
    fn exchange(&mut self, block: BlockId) -> Option<&mut Exchange> {
        let active = self.blocks.get_mut(&block)?.active.as_mut()?;
        Some(&mut active.exchange)
    }
}
