//! A relay in this process, on a free port, with its data in a temporary folder.

use std::net::SocketAddr;
use std::path::Path;

use cipdeck_relay::{RunError, Settings};
use cipdeck_shared::api::Role;
use tempfile::TempDir;
use tokio::net::TcpListener;
use tokio::sync::oneshot;
use tokio::task::JoinHandle;

use crate::PATIENCE;
use crate::command::LOOPBACK;
use crate::rest::Rest;
use crate::viewer::Viewer;
use crate::wait::within;

/// A running relay; it stops when it is dropped.
#[derive(Debug)]
pub struct Relay {
    /// Where it listens.
    pub address: SocketAddr,
    /// Its REST interface.
    pub rest: Rest,
    stop: oneshot::Sender<()>,
    running: JoinHandle<Result<(), RunError>>,
    folder: TempDir,
}

impl Relay {
    /// With an empty database.
    pub async fn start() -> Self {
        Self::start_in(TempDir::new().expect("a temporary folder")).await
    }

    /// With the database of an earlier relay.
    pub async fn start_in(folder: TempDir) -> Self {
        Self::start_with(folder, |settings| settings).await
    }

    /// With other settings.
    pub async fn start_with(folder: TempDir, change: impl FnOnce(Settings) -> Settings) -> Self {
        let listener = TcpListener::bind(("127.0.0.1", 0)).await.expect("a free port");
        let address = listener.local_addr().expect("the port that is bound");
        let (stop, stopped) = oneshot::channel();
        // Whoever is at this machine may do an engineer's work on the devices of the tests.
        let settings = Settings::stored_in(folder.path())
            .with_local(Role::Engineer)
            .allowing(LOOPBACK)
            .allowing("no-such-drive.invalid");
        let settings = change(settings);
        let running = tokio::spawn(cipdeck_relay::run(settings, listener, async {
            let _ = stopped.await; // dropped counts, too
        }));
        // The listener is bound: a request waits until the relay takes it.
        Self { address, rest: Rest::new(address), stop, running, folder }
    }

    /// A client of its WebSocket.
    pub async fn viewer(&self) -> Viewer {
        Viewer::connect(self.address).await
    }

    /// The address of its page.
    pub fn page(&self) -> String {
        format!("http://{}/", self.address)
    }

    /// The folder of its database.
    pub fn folder(&self) -> &Path {
        self.folder.path()
    }

    /// Stops it in order; the folder of its database.
    pub async fn stop(self) -> TempDir {
        let _ = self.stop.send(());
        let ended = within("the relay stops", PATIENCE, self.running).await;
        ended.expect("the relay does not panic").expect("the relay stops in order");
        self.folder
    }
}
