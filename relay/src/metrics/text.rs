//! The counters, and how things are at this moment, as text.

use std::fmt;

use cipdeck_shared::api::{ActorKind, AuditState, HistoryHealth};
use cipdeck_shared::engine::TargetState;
use prometheus_client::encoding::text::encode;
use prometheus_client::metrics::counter::Counter;
use prometheus_client::metrics::family::Family;
use prometheus_client::metrics::gauge::Gauge;
use prometheus_client::metrics::info::Info;
use prometheus_client::registry::Registry;

use super::{Metrics, One};

/// What the text is. Prometheus asks for it, and takes it.
pub(crate) const CONTENT_TYPE: &str = "application/openmetrics-text; version=1.0.0; charset=utf-8";

/// How things are at this moment: looked at when somebody asks.
#[derive(Clone, Debug)]
pub(crate) struct Now {
    pub(crate) blocks: usize,
    pub(crate) targets: Vec<TargetState>,
    pub(crate) sessions: Vec<ActorKind>,
    pub(crate) viewers: usize,
    pub(crate) window: bool,
    pub(crate) read_only: bool,
    pub(crate) audit: AuditState,
    pub(crate) history: HistoryHealth,
    /// Runs that are kept; `None` while they cannot be counted.
    pub(crate) history_runs: Option<u64>,
    /// Runs that wait to be written.
    pub(crate) history_waiting: usize,
}

impl Metrics {
    /// Everything, in the OpenMetrics text format. The registry lives as long as this call: it only names what is
    /// there.
    pub(crate) fn text(&self, now: &Now) -> Result<String, fmt::Error> {
        let mut registry = Registry::with_prefix("cipdeck");
        self.counters(&mut registry);
        now.gauges(&mut registry);
        let mut text = String::new();
        encode(&mut text, &registry)?;
        Ok(text)
    }

    fn counters(&self, registry: &mut Registry) {
        registry.register("messages", "Messages that have ended", self.messages.clone());
        registry.register("denied", "Commands and messages that were not permitted", self.denied.clone());
        registry.register(
            "reply_seconds",
            "From the last written byte to the decoded reply",
            self.reply.clone(),
        );
        registry.register(
            "viewer_snapshots",
            "Times that a viewer was so far behind that it got everything anew",
            self.snapshots.clone(),
        );
        registry.register("http_requests", "Requests that were answered", self.requests.clone());
        registry.register("audit_events", "Events of the audit since the start", self.events.clone());
        registry.register(
            "connections_refused",
            "Connections that were closed because there were too many",
            self.unseated.clone(),
        );
        registry.register("polls", "Requests for values of variables", self.polls.clone());
        registry.register(
            "values",
            "Times that a variable got another value, quality or time",
            self.values.clone(),
        );
    }
}

impl Now {
    fn gauges(&self, registry: &mut Registry) {
        let version = [("version", env!("CARGO_PKG_VERSION"))];
        registry.register("build", "The relay", Info::new(version));
        registry.register("blocks", "Stored blocks", count(self.blocks));
        registry.register("targets", "Targets by the state of their session", self.targets());
        registry.register("sessions", "Open sessions by how they came in", self.sessions());
        registry.register("viewers", "Open WebSockets", count(self.viewers));
        registry.register("write_window_open", "1 while the write window is open", flag(self.window));
        registry.register("read_only", "1 while all writing is stopped", flag(self.read_only));
        registry.register("audit_records", "The number of the newest record", gauge(self.audit.records));
        registry.register("audit_writable", "1 while the audit can be written", flag(self.audit.writable));
        registry.register("history_recording", "1 while runs are being kept", flag(self.history.recording));
        registry.register("history_waiting", "Runs that wait to be written", count(self.history_waiting));
        let lost: Counter = Counter::default();
        lost.inc_by(self.history.lost);
        registry.register("history_lost", "Runs that could not be kept since the start", lost);
        if let Some(runs) = self.history_runs {
            registry.register("history_runs", "Runs that are kept", gauge(runs));
        }
    }

    fn targets(&self) -> Family<One, Gauge> {
        let states = [
            (TargetState::Closed, "closed"),
            (TargetState::Connecting, "connecting"),
            (TargetState::Open, "open"),
            (TargetState::Closing, "closing"),
            (TargetState::Down, "down"),
        ];
        tally("state", &self.targets, &states)
    }

    fn sessions(&self) -> Family<One, Gauge> {
        tally("kind", &self.sessions, &[(ActorKind::Person, "person"), (ActorKind::ViewLink, "view_link")])
    }
}

/// How many of each, also where there is none.
fn tally<T: PartialEq>(label: &'static str, values: &[T], words: &[(T, &'static str)]) -> Family<One, Gauge> {
    let family = Family::<One, Gauge>::default();
    for (kind, word) in words {
        let same = values.iter().filter(|value| *value == kind).count();
        family.get_or_create(&[(label, *word)]).set(signed(same as u64));
    }
    family
}

fn count(number: usize) -> Gauge {
    gauge(number as u64)
}

fn gauge(number: u64) -> Gauge {
    let gauge = Gauge::default();
    gauge.set(signed(number));
    gauge
}

fn flag(is_on: bool) -> Gauge {
    gauge(is_on.into())
}

fn signed(number: u64) -> i64 {
    i64::try_from(number).unwrap_or(i64::MAX)
}
