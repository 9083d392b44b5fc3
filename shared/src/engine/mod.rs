//! The machines behind a block. They never wait, read a clock or touch a socket: bytes and time are passed in.
//!
//! One [`Engine`] owns all blocks, the buffers of the channels and one client per target. Its methods come in
//! families: commands (`run`, `set_in`, `cancel`, `put`, `remove`), transport (`connected`, `connect_failed`,
//! `closed`, `handle_input`, `poll_transmit`), permission (`permit`), time (`poll_timeout`, `handle_timeout`).
//! After every call drain [`Engine::poll_event`], then arm a timer with [`Engine::poll_timeout`]. Calls that come
//! too late or for a link that is gone change nothing.
//!
//! Two rules are kept here. *At most once*: a request's bytes are handed out once; again only after the target
//! said that it does not know the session. *No wrong value*: a reply must carry the context of the one request
//! that is outstanding; after a timeout or a cancellation the socket is replaced.

mod block;
pub mod browse;
mod channel;
mod client;
mod connection;
mod entry;
mod event;
mod failure;
mod machine;
mod management;
mod matching;
pub mod poll;
mod session;
mod status;
mod target;
pub mod time;
mod trigger;

pub use self::block::{BlockView, Effect, Input, MsgBlock};
pub use self::channel::{Buffers, CONTROLLER_BUFFERS, CONTROLLER_CONNECTIONS, CONTROLLER_SESSIONS};
pub use self::connection::Originator;
pub use self::event::{Event, Exchange, LinkId, Wants};
pub use self::failure::{ConnectError, Failure};
pub use self::machine::{CommandError, Engine};
pub use self::management::{Management, REPORTS, ReportRow, Words};
pub use self::status::{Cause, CauseKind, CipStatus, Phase, RefusedBy, StatusBits};
pub use self::target::{ConnectionView, TargetState, TargetView};
pub use self::time::{Instant, Millis};
pub use self::trigger::Trigger;
