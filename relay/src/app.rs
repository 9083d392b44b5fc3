//! What every request can reach.

use std::net::SocketAddr;
use std::sync::Arc;

use tokio_util::sync::CancellationToken;

use crate::http::AllowedHosts;

/// The parts of the relay, shared by all requests.
#[derive(Clone, Debug)]
pub(crate) struct App {
    /// Who may call.
    pub(crate) hosts: Arc<AllowedHosts>,
    /// Ready when the relay stops.
    #[expect(dead_code, reason = "viewers watch it")]
    pub(crate) stop: CancellationToken,
}

impl App {
    /// Puts the parts together.
    pub(crate) fn new(address: SocketAddr, stop: CancellationToken) -> Self {
        Self { hosts: Arc::new(AllowedHosts::new(address)), stop }
    }
}
