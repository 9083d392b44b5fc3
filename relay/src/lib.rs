//! The relay: a thin layer of sockets, time and storage around `cipdeck-shared`, and the command line tool `cipdeck`.
//!
//! It moves bytes and time and decides nothing about the protocol. [`run`] is the whole server; [`cli`] is everything
//! that a person types.

pub mod cli;
pub mod settings;

mod app;
mod draft;
mod error;
mod http;
mod permit;
mod runner;
mod shutdown;
mod simulate;
mod telemetry;
mod wall_clock;

use std::future::Future;

use tokio::net::TcpListener;
use tokio_util::sync::CancellationToken;

use self::app::App;
pub use self::error::RunError;
pub use self::settings::Settings;

/// Serves on a listener that is already bound, until `shutdown` is ready; then stops in order: viewers, running
/// messages and their sessions, the store.
///
/// The log is the caller's: nothing here starts one.
pub async fn run(
    settings: Settings,
    listener: TcpListener,
    shutdown: impl Future<Output = ()> + Send,
) -> Result<(), RunError> {
    serve(settings, listener, shutdown, || ()).await
}

/// [`run`]; says when it is ready to answer.
pub(crate) async fn serve(
    settings: Settings,
    listener: TcpListener,
    shutdown: impl Future<Output = ()> + Send,
    ready: impl FnOnce() + Send,
) -> Result<(), RunError> {
    let address = listener.local_addr().map_err(RunError::Listen)?;
    if !address.ip().is_loopback() {
        return Err(RunError::NotLoopback(address));
    }
    tracing::info!(server.address = %address, data = ?settings.data, "listening");
    let stop = CancellationToken::new();
    let app = App::new(address, stop.clone());
    let server =
        axum::serve(listener, http::router(app)).with_graceful_shutdown(stop.clone().cancelled_owned());
    let server = tokio::spawn(server.into_future());
    ready();
    shutdown.await;
    stop.cancel();
    server.await.map_err(|_| RunError::Stopped)?.map_err(RunError::Serve)
}
