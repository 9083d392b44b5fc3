//! What every request can reach.

use std::net::SocketAddr;
use std::sync::Arc;

use tokio::sync::Mutex;
use tokio_util::sync::CancellationToken;
use tokio_util::task::TaskTracker;

use crate::access::Access;
use crate::audit::Audit;
use crate::blocks::Blocks;
use crate::history::History;
use crate::http::AllowedHosts;
use crate::permit::Policy;
use crate::store::Store;

/// The parts of the relay, shared by all requests.
#[derive(Clone, Debug)]
pub(crate) struct App {
    /// Who may call.
    pub(crate) hosts: Arc<AllowedHosts>,
    /// What is allowed.
    pub(crate) policy: Arc<Policy>,
    /// The database.
    pub(crate) store: Store,
    /// What it is all about.
    pub(crate) blocks: Blocks,
    /// Who did what.
    pub(crate) audit: Audit,
    /// What has happened.
    pub(crate) history: History,
    /// Who calls.
    pub(crate) access: Access,
    /// Held by the one search for devices that may be under way.
    pub(crate) discovery: Arc<Mutex<()>>,
    /// Ready when the relay stops.
    pub(crate) stop: CancellationToken,
    /// The connected viewers.
    pub(crate) viewers: TaskTracker,
}

/// What is opened before anybody is answered.
#[derive(Clone, Debug)]
pub(crate) struct Parts {
    pub(crate) policy: Arc<Policy>,
    pub(crate) store: Store,
    pub(crate) access: Access,
    pub(crate) blocks: Blocks,
    pub(crate) history: History,
}

impl App {
    /// Puts the parts together.
    pub(crate) fn new(address: SocketAddr, parts: Parts, stop: CancellationToken) -> Self {
        let Parts { policy, store, access, blocks, history } = parts;
        let audit = policy.audit.clone();
        Self {
            hosts: Arc::new(AllowedHosts::new(address)),
            policy,
            store,
            blocks,
            audit,
            history,
            access,
            discovery: Arc::default(),
            stop,
            viewers: TaskTracker::new(),
        }
    }
}
