//! The types of REST and WebSocket. Described with examples in docs/REST.md, docs/WEBSOCKET.md and docs/LIVE.md.

mod access;
mod allow;
mod audit;
mod devices;
mod discovery;
mod history;
mod live;
mod project;
mod rest;
mod secret;
mod status;
mod target;
mod words;
mod write;
mod ws;

pub use self::access::{
    ActorKind, Caller, NewToken, NewUser, NewViewLink, PassView, PasswordChange, Role, SessionEntry,
    SessionState, SessionView, SetUp, SignIn, TokenCreated, UserChange, UserView, ViewLinkCreated,
};
pub use self::allow::{AllowedTarget, AllowedWrite, NewAllowedTarget, NewAllowedWrite};
pub use self::audit::{AuditHead, AuditPage, AuditRecord, AuditState};
pub use self::devices::{
    BrowsePage, BrowseRequest, BrowseStep, BrowsedSymbol, BrowsedType, CopyDevice, GroupValues, NewValue,
    NewVariables, Tree, VariableWritten, VariablesCsv, WriteEntry, WriteVariable, plant_findings,
};
pub use self::discovery::{DiscoverRequest, Discovered, DiscoveredDevice};
pub use self::history::{
    HistoryBucket, HistoryDropped, HistoryHealth, HistoryLoss, HistoryPage, HistoryRange, HistoryRun,
    HistoryState, HistoryTrend, HistoryValue,
};
pub use self::live::{
    DeviceHealth, DeviceIdentity, DeviceLoad, DeviceStatus, HealthState, LIVE_PROTOCOL, LiveClientMessage,
    LiveServerMessage, Quality, VariableValue,
};
pub use self::project::{ProjectChange, ProjectFolder, ProjectImport, ProjectPart, ProjectPartKind};
pub use self::rest::{
    Answer, Checked, ExchangeView, Finding, Health, InRequest, Problem, ProblemCode, Ready, RunRequest,
    findings,
};
pub use self::status::{BlockStatus, LastSuccess, MAX_EDGES};
pub use self::target::{ConnectionStatus, TargetStatus};
pub use self::words::WordsStatus;
pub use self::write::{
    NewWindow, ReadOnly, ReadValue, WindowView, WriteRequest, WriteState, WriteTicket, Written,
};
pub use self::ws::{ClientMessage, PROTOCOL_VERSION, ServerMessage};
