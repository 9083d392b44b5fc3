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
use crate::listen::secure_url;
use crate::permit::Policy;
use crate::plant::Plant;
use crate::settings::Settings;
use crate::store::Store;
use crate::tls::Tls;

/// The parts of the relay, shared by all requests.
#[derive(Clone, Debug)]
pub(crate) struct App {
    /// Who may call.
    pub(crate) hosts: Arc<AllowedHosts>,
    /// What is allowed.
    pub(crate) policy: Arc<Policy>,
    /// The database.
    pub(crate) store: Store,
    /// Browsers are told to keep to HTTPS.
    pub(crate) hsts: bool,
    /// Where the relay goes after set-up, if that is not here.
    pub(crate) moves_to: Option<String>,
    /// What is served with beyond loopback.
    pub(crate) tls: Option<Tls>,
    /// What was configured.
    pub(crate) settings: Arc<Settings>,
    /// What it is all about.
    pub(crate) blocks: Blocks,
    /// The devices.
    pub(crate) plant: Plant,
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
    pub(crate) plant: Plant,
    pub(crate) history: History,
}

impl App {
    /// Puts the parts together.
    pub(crate) fn new(settings: Settings, parts: Parts, tls: Option<Tls>, stop: CancellationToken) -> Self {
        let Parts { policy, store, access, blocks, plant, history } = parts;
        let audit = policy.audit.clone();
        Self {
            hosts: Arc::default(),
            hsts: false,
            moves_to: None,
            tls,
            settings: Arc::new(settings),
            policy,
            store,
            blocks,
            plant,
            audit,
            history,
            access,
            discovery: Arc::default(),
            stop,
            viewers: TaskTracker::new(),
        }
    }

    /// The same parts, for who calls this address.
    pub(crate) fn answering_at(&self, address: SocketAddr, is_tls: bool) -> Self {
        let allowed = AllowedHosts::new(address, is_tls, &self.settings.allow_hosts);
        let hsts = is_tls && self.settings.tls.as_ref().is_some_and(|tls| tls.hsts);
        let listen = self.settings.listen;
        let moves_to = (!listen.ip().is_loopback() && !is_tls).then(|| secure_url(listen));
        Self { hosts: Arc::new(allowed), hsts, moves_to, ..self.clone() }
    }
}
