//! What is counted, for `/metrics`. docs/METRICS.md lists everything.
//!
//! Counting costs an atomic addition and a look into a small table. No label is made of what somebody has typed: each
//! has a fixed set of words.

mod text;

use cipdeck_shared::engine::{BlockView, CauseKind};
use prometheus_client::metrics::counter::Counter;
use prometheus_client::metrics::family::Family;
use prometheus_client::metrics::histogram::Histogram;

pub(crate) use self::text::{CONTENT_TYPE, Now};
use crate::audit::Event;
use crate::permit::Denied;

/// One label with a fixed word.
type One = [(&'static str, &'static str); 1];

/// Two labels with fixed words.
type Two = [(&'static str, &'static str); 2];

/// Method, route and status of a request: text, because routes and statuses are many, though they are fixed.
type Request = [(&'static str, String); 3];

/// The counters of one relay. Clones share them.
#[derive(Clone, Debug)]
pub(crate) struct Metrics {
    messages: Family<Two, Counter>,
    denied: Family<One, Counter>,
    reply: Histogram,
    snapshots: Counter,
    requests: Family<Request, Counter>,
    events: Family<One, Counter>,
    unseated: Counter,
    polls: Counter,
    values: Counter,
}

/// Upper ends of the reply times in seconds, from a device on the next port to the longest timeout.
const REPLY_TIMES: [f64; 14] =
    [0.000_2, 0.000_5, 0.001, 0.002, 0.005, 0.01, 0.02, 0.05, 0.1, 0.25, 0.5, 1.0, 3.0, 10.0];

impl Default for Metrics {
    fn default() -> Self {
        Self {
            messages: Family::default(),
            denied: Family::default(),
            reply: Histogram::new(REPLY_TIMES),
            snapshots: Counter::default(),
            requests: Family::default(),
            events: Family::default(),
            unseated: Counter::default(),
            polls: Counter::default(),
            values: Counter::default(),
        }
    }
}

impl Metrics {
    /// A message has ended, which may write or only reads. One that was not permitted was none.
    pub(crate) fn message(&self, may_write: bool, view: &BlockView) {
        let result = match &view.cause {
            None => "ok",
            Some(cause) if cause.what == CauseKind::NotPermitted => return,
            Some(cause) => known(&cause.what),
        };
        let access = if may_write { "write" } else { "read" };
        self.messages.get_or_create(&[("access", access), ("result", result)]).inc();
        if let Some(micros) = view.reply_us {
            self.reply.observe(std::time::Duration::from_micros(micros).as_secs_f64());
        }
    }

    /// A command or a message was not permitted.
    pub(crate) fn denied(&self, denied: &Denied) {
        self.denied.get_or_create(&[("reason", denied.word())]).inc();
    }

    /// A viewer was so far behind that it got everything anew.
    pub(crate) fn snapshot(&self) {
        self.snapshots.inc();
    }

    /// A request has been answered. `route` is the template, never the address itself.
    pub(crate) fn request(&self, method: &str, route: &str, status: u16) {
        let labels =
            [("method", method.to_owned()), ("route", route.to_owned()), ("status", status.to_string())];
        self.requests.get_or_create(&labels).inc();
    }

    /// Something was recorded, or should have been.
    pub(crate) fn event(&self, event: Event) {
        self.events.get_or_create(&[("event", event.word())]).inc();
    }

    /// A device was asked for values of variables.
    pub(crate) fn poll(&self) {
        self.polls.inc();
    }

    /// So many variables have another value, quality or time.
    pub(crate) fn values(&self, count: usize) {
        self.values.inc_by(count as u64);
    }

    /// A connection was closed because there are too many.
    pub(crate) fn unseated(&self) {
        self.unseated.inc();
    }
}

/// The word of a cause, as one of those that this version knows.
fn known(cause: &CauseKind) -> &'static str {
    match cause {
        CauseKind::RefusedByDevice => "refused_by_device",
        CauseKind::Timeout => "timeout",
        CauseKind::Refused => "refused",
        CauseKind::Unreachable => "unreachable",
        CauseKind::Unresolved => "unresolved",
        CauseKind::SessionRefused => "session_refused",
        CauseKind::EncapsulationStatus => "encapsulation_status",
        CauseKind::Malformed => "malformed",
        CauseKind::Closed => "closed",
        CauseKind::Limit => "limit",
        CauseKind::TooSmall => "too_small",
        CauseKind::Invalid => "invalid",
        CauseKind::Cancelled => "cancelled",
        _ => "other",
    }
}

#[cfg(test)]
mod tests;
