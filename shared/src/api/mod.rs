//! The types of REST and WebSocket. Described with examples in docs/REST.md and docs/WEBSOCKET.md.

mod audit;
mod discovery;
mod history;
mod rest;
mod status;
mod target;
mod ws;

pub use self::audit::{AuditHead, AuditPage, AuditRecord, AuditState};
pub use self::discovery::{DiscoverRequest, Discovered, DiscoveredDevice};
pub use self::history::{
    HistoryBucket, HistoryDropped, HistoryHealth, HistoryLoss, HistoryPage, HistoryRange, HistoryRun,
    HistoryState, HistoryTrend, HistoryValue,
};
pub use self::rest::{
    Answer, Checked, ExchangeView, Finding, Health, InRequest, Problem, ProblemCode, RunRequest, findings,
};
pub use self::status::{BlockStatus, LastSuccess, MAX_EDGES};
pub use self::target::{ConnectionStatus, TargetStatus};
pub use self::ws::{ClientMessage, PROTOCOL_VERSION, ServerMessage};
