//! What every request can reach.

use std::net::SocketAddr;
use std::sync::Arc;

use tokio::sync::Mutex;
use tokio_util::sync::CancellationToken;
use tokio_util::task::TaskTracker;

use crate::audit::Audit;
use crate::blocks::Blocks;
use crate::history::History;
use crate::http::AllowedHosts;

/// The parts of the relay, shared by all requests.
#[derive(Clone, Debug)]
pub(crate) struct App {
    /// Who may call.
    pub(crate) hosts: Arc<AllowedHosts>,
    /// What it is all about.
    pub(crate) blocks: Blocks,
    /// Who did what.
    pub(crate) audit: Audit,
    /// What has happened.
    pub(crate) history: History,
    /// Held by the one search for devices that may be under way.
    pub(crate) discovery: Arc<Mutex<()>>,
    /// Ready when the relay stops.
    pub(crate) stop: CancellationToken,
    /// The connected viewers.
    pub(crate) viewers: TaskTracker,
}

impl App {
    /// Puts the parts together.
    pub(crate) fn new(
        address: SocketAddr,
        blocks: Blocks,
        audit: Audit,
        history: History,
        stop: CancellationToken,
    ) -> Self {
        Self {
            hosts: Arc::new(AllowedHosts::new(address)),
            blocks,
            audit,
            history,
            discovery: Arc::default(),
            stop,
            viewers: TaskTracker::new(),
        }
    }
}
