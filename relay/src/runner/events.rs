//! What the engine says, carried out.

use std::sync::Arc;

use cipdeck_shared::config::{BlockId, Target};
use cipdeck_shared::engine::{BlockView, Event, Instant, LinkId, StatusBits, Wants};

use super::{Ended, Inner, State, link};

impl Inner {
    /// Called under the lock.
    pub(super) fn carry_out(self: &Arc<Self>, event: Event, state: &mut State, now: Instant) {
        match event {
            Event::Connect { link, target } => self.connect(link, target, state),
            Event::Disconnect { link } => {
                // Dropping the last handle tells the task, which drops the socket.
                state.sockets.remove(&link);
            }
            Event::Transmit { link } => {
                if let Some(socket) = state.sockets.get(&link) {
                    socket.wake();
                }
            }
            Event::Wants(wants) => self.ask(&wants, state, now),
            Event::Changed { block, edge } => self.tell(block, edge, state),
            Event::Target { target, view } => self.observer.target(&target, view.as_deref()),
            Event::Finished { block, shot, view, exchange } => {
                let (error_id, sub_error_id) = (view.status.error_id, view.status.sub_error_id);
                tracing::debug!(%block, shot, error_id, sub_error_id, elapsed_us = view.elapsed_us, "ended");
                if let Some(guard) = &self.guard {
                    state.grants.ended(&guard.policy, block, shot, &view, &exchange);
                }
                let trace = state.carried.remove(&block).map(|trail| trail.trace());
                let status = self.observer.finished(block, &view, &exchange, trace);
                if let Some(run) = state.runs.remove(&(block, shot)) {
                    // Nobody may wait any more.
                    let _ = run.send(Ended { view, exchange, status });
                }
            }
        }
    }

    fn tell(&self, block: BlockId, edge: Option<(u64, StatusBits)>, state: &State) {
        if let Some(view) = self.observer.watches().then(|| state.engine.glance(block)).flatten() {
            self.observer.changed(block, &BlockView { edges: edge.into_iter().collect(), ..view });
        }
    }

    fn connect(self: &Arc<Self>, link: LinkId, target: Target, state: &mut State) {
        let (socket, task) = link::open(link, target, Arc::clone(self));
        state.sockets.insert(link, socket);
        self.tasks.spawn_on(task, &self.runtime);
    }

    fn ask(&self, wants: &Wants, state: &mut State, now: Instant) {
        let Wants { block, shot, revision, link, opens } = *wants;
        let verdict = match &self.guard {
            Some(guard) if opens => state.grants.opening(guard.gate, &guard.policy, block, revision),
            Some(guard) => state.grants.shot(guard.gate, &guard.policy, block, revision, shot),
            None => Ok(()),
        };
        let Err(denied) = verdict else {
            if let Some(trail) = state.trails.get(&link).filter(|_| !opens) {
                trail.begin();
                state.carried.insert(block, Arc::clone(trail));
            }
            return state.engine.permit(wants, Ok(()), now);
        };
        state.engine.permit(wants, Err(&denied.to_string()), now);
        let stops = state.grants.stops(block, revision);
        if stops {
            tracing::warn!(%block, shot, revision, %denied, "not sent");
        } else {
            // A read goes on asking, perhaps a thousand times a second.
            tracing::debug!(%block, shot, revision, %denied, "not sent");
        }
        if stops {
            // It would ask again and again, and start by itself in the next write window.
            let _ = state.engine.set_in(block, false, now);
        }
    }
}
