//! A write has two halves: the offer, which reads what is there and says what will be there, and the command that
//! carries the ticket of the offer. The message is the one that was offered, to the byte.

mod message;

use std::sync::Arc;

use cipdeck_shared::api::{ReadValue, VariableValue, VariableWritten, WriteEntry, WriteTicket, Written};
use cipdeck_shared::config::{Device, DeviceId, Profile, Variable, VariableId, write_hex};
use cipdeck_shared::engine::poll::{Quality, Reading, Reason};
use cipdeck_shared::plan::Severity;
use cipdeck_shared::plan::plant::{self, DevicePlan, VariablePlan};
use cipdeck_shared::tag::{Dialect, Type, Value};

use self::message::{one_bit, whole, within_limits};
use super::point::Shown;
use super::work::in_words;
use super::{Inner, Plant};
use crate::actor::Actor;
use crate::audit::Event;
use crate::desk::{self, Desk, Lost, Why};
use crate::error::ApiError;
use crate::permit::{Confirmed, GOOD_FOR, Offer, Order, record};
use crate::runner::{Refused, lock};
use crate::wall_clock;

/// What somebody has been offered.
#[derive(Debug)]
pub(super) struct Pending {
    variable: Variable,
    device: Device,
    plan: VariablePlan,
    desk: Desk,
}

/// Offers that can be open at once.
const MAX_PENDING: usize = 256;

impl Plant {
    /// The first half: what is there, what will be there, and the ticket for the second half.
    pub(crate) async fn offer(
        &self,
        actor: &Actor,
        id: VariableId,
        text: &str,
    ) -> Result<WriteTicket, ApiError> {
        let (variable, device, plan, device_plan) = self.0.writable(id)?;
        let name = format!("{id} {} ({})", variable.config.name, plan.name);
        let desk = self.0.desk(actor, device.id, &name, &device_plan).await;
        let mut desk = desk.map_err(Lost::into_error)?;
        let old = desk.read(&plan.name, plan.kind.as_ref()).await.map_err(Lost::into_error)?;
        let shown = shown(&variable, &plan);
        let (message, new) = match plan.name.bit() {
            None => whole(&desk, &plan, &old, text),
            Some(bit) => {
                let number = desk.read(&plan.name.without_bit(), None).await.map_err(Lost::into_error)?;
                one_bit(&desk, &plan, &number, bit, text)
            }
        }
        .map_err(wrong)?;
        within_limits(&variable, &plan, &new.1).map_err(wrong)?;
        let request: Arc<[u8]> = message.bytes().into();
        let revision = desk.put(message).map_err(wrong)?;
        let order = Order { actor: actor.clone(), confirmed: self.0.policy.hypothetical(revision) };
        self.0.runner.ask(desk.lane.block(), &order)?;
        let (old, no_old) = match value_of(&shown, &old, desk.dialect()) {
            Some(old) => (Some(old), None),
            None => (None, Some(reason(&old))),
        };
        let new = Some(read_value(&shown, Some(&new.0), &new.1, desk.dialect()));
        let offer = Offer { revision, request, old, new };
        let ticket = self.0.policy.offer(actor, desk.lane.block(), &offer, no_old).map_err(Refused::from)?;
        self.0.keep(&ticket.ticket, Pending { variable: variable.clone(), device, plan, desk })?;
        Ok(WriteTicket { revision: variable.revision, ..ticket })
    }

    /// The second half: one message, and what is there then.
    pub(crate) async fn write(
        &self,
        actor: &Actor,
        id: VariableId,
        ticket: &str,
    ) -> Result<VariableWritten, ApiError> {
        let (pending, confirmed) = self.0.redeem(actor, id, ticket)?;
        let (inner, actor) = (Arc::clone(&self.0), actor.clone());
        // It is carried out to its end, also when nobody waits for it any more.
        let write = tokio::spawn(async move { inner.carry_out(&actor, pending, confirmed).await });
        write.await.unwrap_or_else(|error| Err(ApiError::Internal(error.to_string())))
    }
}

impl Inner {
    /// A variable that may be written at all, and all about it.
    fn writable(&self, id: VariableId) -> Result<(Variable, Device, VariablePlan, DevicePlan), ApiError> {
        let entries = lock(&self.entries);
        let variable = entries.variable(id)?.clone();
        let device = entries.device(entries.group(variable.group)?.config.device)?.clone();
        if !variable.config.writable {
            let why = format!("{id} is not to be written: an engineer can allow it where it is configured");
            return Err(ApiError::NotPermitted(why));
        }
        let cannot = |findings: &[plant::PlantFinding]| ApiError::Conflict(in_words(findings));
        let device_plan = plant::device(&device.config).map_err(|findings| cannot(&findings))?;
        let mut plans = plant::variables(entries.variables_of(variable.group), &device_plan.types);
        let plan = plans.remove(&id).unwrap_or_else(|| Err(Vec::new()));
        Ok((variable, device, plan.map_err(|findings| cannot(&findings))?, device_plan))
    }

    /// What the device is, as far as anybody knows.
    pub(super) fn profile(&self, device: DeviceId, plan: &DevicePlan) -> Profile {
        let found = self.hub.status(device).and_then(|status| Profile::of_word(&status.profile));
        if plan.profile == Profile::Auto { found.unwrap_or_default() } else { plan.profile }
    }

    fn keep(self: &Arc<Self>, ticket: &str, pending: Pending) -> Result<(), ApiError> {
        let mut all = lock(&self.pending);
        if all.len() >= MAX_PENDING {
            return Err(ApiError::Busy(format!("{MAX_PENDING} writes wait to be confirmed")));
        }
        all.insert(ticket.to_owned(), pending);
        let (inner, ticket) = (Arc::downgrade(self), ticket.to_owned());
        let stop = self.stop.clone();
        self.tasks.spawn(async move {
            stop.run_until_cancelled(tokio::time::sleep(GOOD_FOR)).await;
            if let Some(inner) = inner.upgrade() {
                lock(&inner.pending).remove(&ticket);
            }
        });
        Ok(())
    }

    /// A command comes with a ticket.
    fn redeem(&self, actor: &Actor, id: VariableId, ticket: &str) -> Result<(Pending, Confirmed), ApiError> {
        let unknown = || {
            let why = "the ticket is unknown, used, too old, somebody else's, or for another variable: ask for one with";
            ApiError::NotPermitted(format!("{why} variables/{id}/offer"))
        };
        let block = {
            let pending = lock(&self.pending);
            let pending = pending.get(ticket).filter(|pending| pending.variable.id == id);
            pending.map(|pending| pending.desk.lane.block()).ok_or_else(unknown)?
        };
        // Somebody else's ticket stays theirs.
        let confirmed = self.policy.redeem(ticket, actor, block).map_err(Refused::from)?;
        let pending = lock(&self.pending).remove(ticket).ok_or_else(unknown)?;
        let (variable, device, ..) = self.writable(id)?;
        if (variable.revision, device.revision) != (pending.variable.revision, pending.device.revision) {
            let why = "the variable or its device has been changed since: look at it and confirm again";
            return Err(ApiError::NotPermitted(why.to_owned()));
        }
        Ok((pending, confirmed))
    }

    async fn carry_out(
        &self,
        actor: &Actor,
        pending: Pending,
        confirmed: Confirmed,
    ) -> Result<VariableWritten, ApiError> {
        let Pending { variable, device, plan, mut desk } = pending;
        let order = Order { actor: actor.clone(), confirmed: Some(confirmed.clone()) };
        let ended = desk.lane.run(Some(order)).await?;
        let may_have_acted = ended.view.cause.as_ref().is_some_and(|cause| cause.may_have_acted);
        let ended = Ok(ended);
        let refused = match desk::reply(&ended) {
            // At the last moment.
            Err(Lost { why: Why::Denied, reason }) => return Err(ApiError::NotPermitted(reason)),
            Err(lost) => Some(lost.reason),
            Ok(reply) => desk::refused(reply),
        };
        let shown = shown(&variable, &plan);
        let now = desk.read(&plan.name, plan.kind.as_ref()).await.unwrap_or_default();
        let read_back = value_of(&shown, &now, desk.dialect());
        let is_equal =
            confirmed.new.as_ref().zip(read_back.as_ref()).map(|(new, found)| new.data == found.data);
        let record = record(Event::WriteReadBack, actor)
            .with("block", desk.lane.block().to_string())
            .with("variable", variable.id.to_string())
            .with("ticket", confirmed.id)
            .with_some("read_back", read_back.as_ref().map(|value| value.data.clone()))
            .with_some("is_equal", is_equal);
        self.policy.note(&record);
        let text = |value: &Option<ReadValue>| value.as_ref().map(|value| value.text.clone());
        let entry = WriteEntry {
            at: wall_clock::now(),
            actor: actor.name().to_owned(),
            variable: variable.id,
            name: variable.config.name.clone(),
            address: plan.name.to_string(),
            old: text(&confirmed.old),
            new: text(&confirmed.new),
            read_back: text(&read_back),
            is_done: refused.is_none(),
            reason: refused.clone(),
            is_equal,
        };
        if let Err(error) = self.store.add_write(device.id, entry).await {
            // The audit has it; the device may have been deleted meanwhile.
            tracing::warn!(%error, device = %device.id, "a write is not in the device's list");
        }
        let value = (now.quality == Quality::Good).then(|| value(&shown, &now, self));
        Ok(VariableWritten {
            is_done: refused.is_none(),
            reason: refused,
            may_have_acted,
            written: Written { old: confirmed.old, new: confirmed.new, read_back, is_equal },
            value,
        })
    }
}

fn shown(variable: &Variable, plan: &VariablePlan) -> Shown {
    Shown {
        variable: variable.id,
        address: plan.name.to_string(),
        view: plan.view.clone(),
        unit: plan.unit.clone(),
        wrong: None,
    }
}

/// What was read, as bytes and in words.
fn value_of(shown: &Shown, reading: &Reading, dialect: Dialect) -> Option<ReadValue> {
    let value = reading.value.as_ref().filter(|_| reading.quality == Quality::Good)?;
    match &reading.kind {
        Some(kind) => Some(read_value(shown, Some(kind), value, dialect)),
        None => Some(read_value(shown, None, value, dialect)),
    }
}

fn read_value(shown: &Shown, kind: Option<&Type>, value: &Value, dialect: Dialect) -> ReadValue {
    let data = kind.and_then(|kind| kind.encode(dialect, value).ok()).unwrap_or_default();
    ReadValue { data: write_hex(&data), text: shown.text(kind, value) }
}

fn value(shown: &Shown, reading: &Reading, inner: &Inner) -> VariableValue {
    shown.value(&super::poll::point(reading, inner.clock))
}

fn reason(reading: &Reading) -> String {
    reading.reason.as_ref().map_or_else(|| "it could not be read".to_owned(), Reason::text)
}

/// What somebody has typed cannot be written.
fn wrong(why: impl Into<String>) -> ApiError {
    let finding = cipdeck_shared::api::Finding {
        field: "text".to_owned(),
        severity: Severity::Error,
        rule: "value".to_owned(),
        message: why.into(),
        min: None,
        max: None,
        error_id: None,
        sub_error_id: None,
        communication_report: None,
    };
    ApiError::Findings(vec![finding])
}
