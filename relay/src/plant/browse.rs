//! Asking a device what it has: one question at a time and device, which goes on while people look at what has been
//! found already.

use std::sync::{Arc, Mutex};

use cipdeck_shared::api::{BrowsePage, BrowseRequest, BrowseStep, BrowsedSymbol, BrowsedType};
use cipdeck_shared::config::DeviceId;
use cipdeck_shared::engine::browse::{Access, Browse, BrowseWhat, Symbol};
use cipdeck_shared::plan::plant::{self, DevicePlan};
use cipdeck_shared::tag::{Member, Structure, Type};
use tokio_util::sync::CancellationToken;

use super::poll::way;
use super::work::in_words;
use super::{Inner, Plant};
use crate::actor::Actor;
use crate::desk::{Desk, Lost};
use crate::error::ApiError;
use crate::permit::Order;
use crate::runner::lock;

/// A question that has been asked.
#[derive(Debug)]
pub(super) struct Browsing {
    found: Mutex<Found>,
    cancel: CancellationToken,
}

#[derive(Debug)]
struct Found {
    step: BrowseStep,
    reason: Option<String>,
    requests: u64,
    symbols: Vec<BrowsedSymbol>,
}

impl Browsing {
    /// Asks no more.
    pub(super) fn end(&self) {
        self.cancel.cancel();
    }
}

/// Names of one page.
const PAGE: usize = 1_000;

/// Names that are kept of a device. More than any controller has.
const MAX_SYMBOLS: usize = 200_000;

/// Requests for one structure: each member of an Omron's takes one.
const MAX_TYPE_REQUESTS: u32 = 5_000;

impl Plant {
    /// Begins to ask. What was asked before ends.
    pub(crate) fn browse(&self, actor: &Actor, id: DeviceId, request: BrowseRequest) -> Result<(), ApiError> {
        let (name, plan) = self.0.browsable(id)?;
        let what = if request.system { BrowseWhat::WithSystem } else { BrowseWhat::Tags };
        let found = Found { step: BrowseStep::Running, reason: None, requests: 0, symbols: Vec::new() };
        let browsing = Browsing { found: Mutex::new(found), cancel: self.0.stop.child_token() };
        let browsing = Arc::new(browsing);
        if let Some(before) = lock(&self.0.browses).insert(id, Arc::clone(&browsing)) {
            before.end();
        }
        let (inner, actor) = (Arc::clone(&self.0), actor.clone());
        let cancel = browsing.cancel.clone();
        self.0.tasks.spawn(async move {
            let ended =
                cancel.run_until_cancelled(inner.list(&actor, id, &name, &plan, what, &browsing)).await;
            let mut found = lock(&browsing.found);
            match ended {
                Some(Ok(())) => found.step = BrowseStep::Done,
                Some(Err(lost)) => (found.step, found.reason) = (BrowseStep::Failed, Some(lost.reason)),
                None => found.step = BrowseStep::Cancelled,
            }
        });
        Ok(())
    }

    /// What has been found, from the `from`th name on.
    pub(crate) fn browsed(&self, id: DeviceId, from: usize) -> Result<BrowsePage, ApiError> {
        self.device(id)?;
        let browsing = lock(&self.0.browses).get(&id).cloned();
        let Some(browsing) = browsing else {
            return Ok(BrowsePage {
                state: BrowseStep::Idle,
                reason: None,
                requests: 0,
                found: 0,
                expected: None,
                symbols: Vec::new(),
                next: 0,
            });
        };
        let found = lock(&browsing.found);
        let rest = found.symbols.get(from..).unwrap_or_default();
        let symbols = rest.get(..PAGE).unwrap_or(rest).to_vec();
        Ok(BrowsePage {
            state: found.step,
            reason: found.reason.clone(),
            requests: found.requests,
            found: found.symbols.len(),
            expected: None,
            next: from.min(found.symbols.len()) + symbols.len(),
            symbols,
        })
    }

    /// Asks no more.
    pub(crate) fn end_browse(&self, id: DeviceId) -> Result<(), ApiError> {
        self.device(id)?;
        if let Some(browsing) = lock(&self.0.browses).get(&id) {
            browsing.end();
        }
        Ok(())
    }

    /// What a structure is made of, asked of the device.
    pub(crate) async fn browsed_type(
        &self,
        actor: &Actor,
        id: DeviceId,
        structure: u32,
    ) -> Result<BrowsedType, ApiError> {
        let (name, plan) = self.0.browsable(id)?;
        let mut desk = self.0.desk(actor, id, &name, &plan).await.map_err(Lost::into_error)?;
        let mut browse = Browse::template(desk.dialect(), structure);
        while let Some(request) = browse.next_request() {
            if browse.requests() > MAX_TYPE_REQUESTS {
                return Err(ApiError::Conflict("the structure has no end".to_owned()));
            }
            let reply = desk.ask(&request).await;
            browse.handle_reply(reply.as_deref().map_err(Lost::failure));
        }
        match (browse.kind(), browse.error()) {
            (Some(Type::Structure(structure)), _) => Ok(told(structure)),
            (_, why) => {
                let why = why.unwrap_or("it is no structure");
                Err(ApiError::Conflict(format!("the device does not tell it: {why}")))
            }
        }
    }
}

impl Inner {
    fn browsable(&self, id: DeviceId) -> Result<(String, DevicePlan), ApiError> {
        let entries = lock(&self.entries);
        let device = entries.device(id)?;
        let plan =
            plant::device(&device.config).map_err(|findings| ApiError::Conflict(in_words(&findings)))?;
        Ok((format!("{id} {}", device.config.name), plan))
    }

    /// A conversation with a device in somebody's name.
    pub(super) async fn desk(
        &self,
        actor: &Actor,
        id: DeviceId,
        name: &str,
        plan: &DevicePlan,
    ) -> Result<Desk, Lost> {
        let way = way(plan, self.profile(id, plan));
        Desk::open(self.runner.lane(name), self.clock, way, Some(Order::read(actor.clone()))).await
    }

    async fn list(
        &self,
        actor: &Actor,
        id: DeviceId,
        name: &str,
        plan: &DevicePlan,
        what: BrowseWhat,
        browsing: &Browsing,
    ) -> Result<(), Lost> {
        let mut desk = self.desk(actor, id, name, plan).await?;
        lock(&browsing.found).reason = Browse::caveat(desk.dialect()).map(str::to_owned);
        let mut browse = Browse::new(desk.dialect(), what);
        while let Some(request) = browse.next_request() {
            let reply = desk.ask(&request).await;
            browse.handle_reply(reply.as_deref().map_err(Lost::failure));
            let mut found = lock(&browsing.found);
            let new = browse.found().get(found.symbols.len()..).unwrap_or_default();
            found.symbols.extend(new.iter().map(symbol));
            found.requests = browse.requests().into();
            if found.symbols.len() > MAX_SYMBOLS {
                let reason = format!("there are more than {MAX_SYMBOLS} names");
                return Err(Lost::silent(reason));
            }
        }
        match browse.error() {
            None => Ok(()),
            Some(reason) => Err(Lost::silent(reason.to_owned())),
        }
    }
}

fn symbol(symbol: &Symbol) -> BrowsedSymbol {
    let access = |access| match access {
        Access::Write => "read and write",
        Access::Read => "read",
        Access::None => "none",
    };
    BrowsedSymbol {
        name: symbol.name.clone(),
        kind: symbol.type_text.clone(),
        structure: symbol.template.map(|id| id.to_string()),
        access: symbol.access.map(|it| access(it).to_owned()),
        note: symbol.note.map(str::to_owned),
    }
}

/// A structure and its members.
fn told(structure: &Structure) -> BrowsedType {
    let member = |member: &Member| BrowsedSymbol {
        name: member.name.clone(),
        kind: written_out(&member.kind),
        structure: None,
        access: None,
        note: None,
    };
    BrowsedType {
        name: structure.name.clone(),
        members: structure.members.iter().map(member).collect(),
        kind: members(structure),
    }
}

/// A type without names of structures, which only the device knows.
fn written_out(kind: &Type) -> String {
    match kind {
        Type::Structure(structure) => members(structure),
        Type::Array(element, dimensions) if matches!(**element, Type::Structure(_)) => {
            format!("{}{dimensions}", written_out(element))
        }
        kind => kind.to_string(),
    }
}

fn members(structure: &Structure) -> String {
    let member = |member: &Member| format!("{}: {}", member.name, written_out(&member.kind));
    let all: Vec<_> = structure.members.iter().map(member).collect();
    format!("STRUCT{{{}}}", all.join("; "))
}
