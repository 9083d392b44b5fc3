//! The relay: a thin layer of sockets, time and storage around `cipdeck-shared`, and the command line tool `cipdeck`.
//!
//! It moves bytes and time and decides nothing about the protocol. [`run`] is the whole server; [`cli`] is everything
//! that a person types.

mod access;
mod actor;
pub mod capture;
pub mod cli;
pub mod client;
pub mod settings;

mod app;
mod audit;
mod blocks;
mod discover;
mod draft;
mod error;
mod history;
mod http;
mod hub;
mod permit;
mod ritual;
mod runner;
mod shutdown;
mod simulate;
mod store;
mod telemetry;
mod wall_clock;
mod ws;

#[cfg(test)]
mod tests;

use std::future::Future;
use std::net::SocketAddr;
use std::sync::{Arc, Mutex};
use std::time::Duration;

use cipdeck_shared::sim::{Device, SimConfig};
use tokio::net::TcpListener;
use tokio_util::sync::CancellationToken;

use self::access::Access;
use self::app::{App, Parts};
use self::audit::{Audit, Event, Record};
use self::blocks::Blocks;
pub use self::error::RunError;
use self::history::History;
use self::permit::{Gate, Policy, RuleError, permit};
use self::runner::Guard;
pub use self::settings::Settings;
use self::store::{Store, StoredLists};

/// How long viewers have to hear the end, and requests that are being answered after everything else has ended.
const LAST_ANSWERS: Duration = Duration::from_secs(3);

/// Serves on a listener that is already bound, until `shutdown` is ready; then stops in order: viewers, running
/// messages and their sessions, the store.
///
/// The log is the caller's: nothing here starts one.
pub async fn run(
    settings: Settings,
    listener: TcpListener,
    shutdown: impl Future<Output = ()> + Send,
) -> Result<(), RunError> {
    serve(settings, listener, shutdown, |_| ()).await
}

/// [`run`]; says when it is ready to answer, and with which set-up code if there is no administrator yet.
pub(crate) async fn serve(
    settings: Settings,
    listener: TcpListener,
    shutdown: impl Future<Output = ()> + Send,
    ready: impl FnOnce(Option<String>) + Send,
) -> Result<(), RunError> {
    serve_with(settings, listener, shutdown, ready, permit).await
}

/// [`serve`] with another decision, to show what this one is good for.
async fn serve_with(
    settings: Settings,
    listener: TcpListener,
    shutdown: impl Future<Output = ()> + Send,
    ready: impl FnOnce(Option<String>) + Send,
    gate: Gate,
) -> Result<(), RunError> {
    let address = listener.local_addr().map_err(RunError::Listen)?;
    if !address.ip().is_loopback() {
        return Err(RunError::NotLoopback(address));
    }
    let database = settings.database();
    let no_store = |error| match &database {
        Some(path) => RunError::Store(format!("{}: {error}", path.display())),
        None => RunError::Store(format!("{error}")),
    };
    let store = Store::open(database.as_deref()).await.map_err(no_store)?;
    let history = History::open(settings.data.as_deref(), settings.history).await;
    // After the store, which only one relay can have.
    let audit = Audit::open(settings.data.as_deref()).map_err(|error| RunError::Audit(error.to_string()))?;
    note(&audit, &Record::new(Event::Start, "relay", "").with("version", env!("CARGO_PKG_VERSION")));
    let access = Access::open(store.clone(), audit.clone(), settings.local).await.map_err(no_store)?;
    let setup_code = if settings.local.is_some() { None } else { access.setup_code() };
    let stored = store.load_lists().await.map_err(no_store)?;
    let policy = Arc::new(policy(&settings, audit.clone(), &stored)?);
    policy.lists.listens_on(address);
    let guard = Guard::with_gate(Arc::clone(&policy), gate);
    let blocks = Blocks::open(store.clone(), Arc::clone(&policy), guard, history.recorder());
    let blocks = blocks.await.map_err(no_store)?;
    tracing::info!(server.address = %address, data = ?settings.data, "listening");

    let stop = CancellationToken::new();
    let keeper = tokio::spawn(Arc::clone(&policy).keep(stop.clone()));
    let parts = Parts { policy, store, access, blocks: blocks.clone(), history: history.clone() };
    let app = App::new(address, parts, stop.clone());
    let viewers = app.viewers.clone();
    let server = axum::serve(listener, http::router(app).into_make_service_with_connect_info::<SocketAddr>())
        .with_graceful_shutdown(stop.clone().cancelled_owned());
    let mut server = tokio::spawn(server.into_future());
    ready(setup_code);
    let ended = tokio::select! {
        () = shutdown => None,
        ended = &mut server => Some(ended),
    };
    stop.cancel();
    viewers.close();
    if tokio::time::timeout(LAST_ANSWERS, viewers.wait()).await.is_err() {
        tracing::info!("some viewers did not take their last message");
    }
    blocks.stop().await;
    history.close().await;
    // It has heard of the stop.
    let _ = keeper.await;
    note(&audit, &Record::new(Event::Stop, "relay", ""));
    match ended {
        Some(_) => Err(RunError::Stopped),
        None => match tokio::time::timeout(LAST_ANSWERS, server).await {
            Ok(Ok(result)) => result.map_err(RunError::Serve),
            Ok(Err(_)) => Err(RunError::Stopped),
            // Somebody holds a connection open; everything of value is safe.
            Err(_) => Ok(()),
        },
    }
}

/// What the configuration file and the administrators allow.
fn policy(settings: &Settings, audit: Audit, stored: &StoredLists) -> Result<Policy, RunError> {
    let policy = Policy::new(settings.data.as_deref(), audit, settings.limits.messages_per_second);
    let wrong = |error: RuleError| RunError::List(error.to_string());
    for target in &settings.allow.target {
        policy.lists.add_target(None, target).map_err(wrong)?;
    }
    for write in &settings.allow.write {
        policy.lists.add_write(None, write).map_err(wrong)?;
    }
    for (id, target) in &stored.targets {
        policy.lists.add_target(Some(*id), target).map_err(wrong)?;
    }
    for (id, write) in &stored.writes {
        policy.lists.add_write(Some(*id), write).map_err(wrong)?;
    }
    Ok(policy)
}

/// Records the start or the end, and the end of the chain in the log, where it is out of reach of whoever reaches the
/// data folder.
fn note(audit: &Audit, record: &Record) {
    // What cannot be recorded has been logged, and stops writes.
    let _ = audit.append(record);
    let state = audit.state();
    tracing::info!(audit.records = state.records, audit.head = state.head.hash, "audit");
}

/// Answers on a listener as one simulated device, until this future is dropped.
pub async fn simulate(listener: TcpListener, device: SimConfig) {
    let device = Arc::new(Mutex::new(Device::new(device)));
    simulate::answer_tcp(listener, device, runner::Clock::start()).await;
}
