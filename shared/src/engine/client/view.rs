//! How a client looks from outside.

use alloc::vec::Vec;

use crate::engine::connection::Connection;
use crate::engine::session::Session;
use crate::engine::target::{ConnectionView, TargetState, TargetView};

use super::{Client, Link, What};

impl Client {
    /// How the target looks now.
    pub(in crate::engine) fn view(&self) -> TargetView {
        let state = match &self.link {
            Link::None if self.error.is_some() => TargetState::Down,
            Link::None => TargetState::Closed,
            Link::Connecting(_) | Link::Registering(..) => TargetState::Connecting,
            Link::Ready(..) => TargetState::Open,
            Link::Closing(..) => TargetState::Closing,
        };
        let connections: Vec<_> = self
            .connections
            .iter()
            .map(|connection| ConnectionView {
                route: connection.route.clone(),
                size: connection.size,
                requests: connection.requests,
            })
            .collect();
        TargetView {
            state,
            error: self.error.clone(),
            profile: self.known.identity,
            no_context: self.session().is_some_and(Session::has_no_context),
            own_connection_id: self.known.own_connection_id,
            connections,
            dropped: self.dropped,
            last_used: self.last_used,
        }
    }

    /// Whether [`Self::view`] is different from what was told last.
    pub(in crate::engine) const fn take_changed(&mut self) -> bool {
        core::mem::replace(&mut self.changed, false)
    }

    /// Class 3 connections that count for the controller: open, being opened, and wanted by messages that wait.
    pub(in crate::engine) fn connections_in_use(&self) -> usize {
        let opening = self.outstanding.as_ref().is_some_and(|out| matches!(out.what, What::Open(..)));
        let waiting = self.queue.iter().skip(usize::from(opening));
        let mut missing = Vec::new();
        for job in waiting.filter(|job| job.plan.connection().is_some()) {
            let route = job.plan.routed(self.profile_for(&job.plan)).route();
            let is_open = self.connections.iter().any(|connection| connection.route == *route);
            if !is_open && !missing.contains(&route) {
                missing.push(route);
            }
        }
        let closing = |open: &&Connection| open.close_wanted && !self.is_wanted(&open.route);
        let ending = self.connections.iter().filter(closing).count();
        self.connections.len() - ending + missing.len() + usize::from(opening)
    }

    /// Whether a message along this route finds its connection open.
    pub(in crate::engine) fn has_connection_for(&self, plan: &crate::plan::MessagePlan) -> bool {
        let route = plan.routed(self.profile_for(plan)).route();
        let stays = |open: &Connection| !open.close_wanted && open.route == *route;
        self.connections.iter().any(stays) || self.is_wanted(route)
    }
}
