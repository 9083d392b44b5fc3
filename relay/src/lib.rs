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
mod backup;
mod blocks;
mod desk;
mod discover;
mod draft;
mod error;
mod history;
mod http;
mod hub;
mod line;
mod listen;
mod live;
mod metrics;
mod owner;
mod permit;
mod plant;
mod private;
mod project;
mod ritual;
mod runner;
mod shutdown;
mod simulate;
mod store;
mod telemetry;
mod tls;
mod wall_clock;
mod ws;

#[cfg(test)]
mod tests;

use std::future::Future;
use std::path::Path;
use std::sync::{Arc, Mutex};
use std::time::Duration;

use cipdeck_shared::api::ProjectChange;
use cipdeck_shared::config::project::read;
use cipdeck_shared::sim::{Device, SimConfig};
use tokio::net::TcpListener;
use tokio_util::sync::CancellationToken;
use tokio_util::task::AbortOnDropHandle;

use self::access::Access;
use self::app::{App, Parts};
use self::audit::{Audit, Event, Record};
use self::blocks::Blocks;
pub use self::error::RunError;
use self::history::History;
use self::listen::{Doors, Listening, Seats, Site};
use self::permit::{Gate, Policy, RuleError, permit};
use self::plant::Plant;
use self::project::{FilesError, Folder};
use self::runner::Guard;
pub use self::settings::Settings;
use self::store::{Store, StoreError, StoredLists};

/// How long viewers have to hear the end, and requests that are being answered after everything else has ended.
const LAST_ANSWERS: Duration = Duration::from_secs(3);

/// Serves until `shutdown` is ready; then stops in order: viewers, running messages and their sessions, the store.
///
/// `listener` is bound to loopback. There the relay stays if the settings say so; if they name an address that others can
/// reach, it goes there, with TLS, as soon as there is an administrator.
///
/// The log is the caller's: nothing here starts one.
pub async fn run(
    settings: Settings,
    listener: TcpListener,
    shutdown: impl Future<Output = ()> + Send,
) -> Result<(), RunError> {
    serve(settings, listener, shutdown, |_, _| ()).await
}

/// [`run`]; says whenever it is ready to answer somewhere, the first time with the set-up code if there is no
/// administrator yet.
pub(crate) async fn serve(
    settings: Settings,
    listener: TcpListener,
    shutdown: impl Future<Output = ()> + Send,
    ready: impl FnMut(&Listening, Option<&str>) + Send,
) -> Result<(), RunError> {
    serve_with(settings, listener, shutdown, ready, permit).await
}

/// [`serve`] with another decision, to show what this one is good for.
async fn serve_with(
    settings: Settings,
    listener: TcpListener,
    shutdown: impl Future<Output = ()> + Send,
    mut ready: impl FnMut(&Listening, Option<&str>) + Send,
    gate: Gate,
) -> Result<(), RunError> {
    let address = listener.local_addr().map_err(RunError::Listen)?;
    if !address.ip().is_loopback() {
        return Err(RunError::NotLoopback(address));
    }
    if settings.local.is_some() && !settings.listen.ip().is_loopback() {
        return Err(RunError::LocalForOthers(settings.listen));
    }
    if settings.local.is_some() && !settings.allow_hosts.is_empty() {
        return Err(RunError::LocalThroughTunnel);
    }
    let tls = listen::tls(&settings)?;
    let database = settings.database();
    let no_store = |error| match &database {
        Some(path) => RunError::Store(format!("{}: {error}", path.display())),
        None => RunError::Store(format!("{error}")),
    };
    let store = Store::open(database.as_deref()).await.map_err(no_store)?;
    if let Some(folder) = &settings.project {
        join(&store, folder).await?;
    }
    let history = History::open(settings.data.as_deref(), settings.history).await;
    // After the store, which only one relay can have.
    let audit = Audit::open(settings.data.as_deref()).map_err(|error| RunError::Audit(error.to_string()))?;
    note(&audit, &Record::new(Event::Start, "relay", "").with("version", env!("CARGO_PKG_VERSION")));
    let access = Access::open(store.clone(), audit.clone(), settings.local).await.map_err(no_store)?;
    let mut setup_code = if settings.local.is_some() { None } else { access.setup_code() };
    let stored = store.load_lists().await.map_err(no_store)?;
    let policy = Arc::new(policy(&settings, audit.clone(), &stored)?);
    let guard = Guard::new(Arc::clone(&policy), gate);
    let blocks = Blocks::open(store.clone(), Arc::clone(&policy), guard, history.recorder());
    let blocks = blocks.await.map_err(no_store)?;
    let plant = Plant::open(store.clone(), blocks.runner(), Arc::clone(&policy)).await.map_err(no_store)?;
    tracing::info!(data = ?settings.data, "starting");

    let stop = CancellationToken::new();
    let keeper = tokio::spawn(Arc::clone(&policy).keep(stop.clone()));
    let renewal = tls.clone().map(|tls| AbortOnDropHandle::new(tokio::spawn(tls::watch(tls, audit.clone()))));
    let is_set_up = access.is_set_up();
    let parts = Parts {
        policy,
        store,
        access,
        blocks: blocks.clone(),
        plant: plant.clone(),
        history: history.clone(),
    };
    let app = App::new(settings, parts, tls, stop.clone());
    let viewers = app.viewers.clone();
    let site = site(app);
    let mut ready = |listening: &Listening| ready(listening, setup_code.take().as_deref());
    let mut doors = Doors::open(listener, &site, is_set_up, &mut ready).await;
    let result = match &mut doors {
        Ok(doors) => tokio::select! {
            () = shutdown => Ok(()),
            error = doors.keep(&site, &mut ready) => Err(error),
        },
        Err(_) => Ok(()),
    };
    stop.cancel();
    if let Ok(doors) = &mut doors {
        doors.close().await;
    }
    viewers.close();
    if tokio::time::timeout(LAST_ANSWERS, viewers.wait()).await.is_err() {
        tracing::info!("some viewers did not take their last message");
    }
    plant.stop().await;
    blocks.stop().await;
    history.close().await;
    // It has heard of the stop.
    let _ = keeper.await;
    drop(renewal);
    note(&audit, &Record::new(Event::Stop, "relay", ""));
    if tokio::time::timeout(LAST_ANSWERS, doors?.are_empty()).await.is_err() {
        tracing::info!("some connections were held open; everything of value is safe");
    }
    result
}

/// Files of one change that the log names.
const FILES_TOLD: usize = 8;

/// The folder of the project becomes what is stored, and is kept from now on.
async fn join(store: &Store, folder: &Path) -> Result<(), RunError> {
    let wrong = |error: &dyn std::fmt::Display| RunError::Project(format!("{}: {error}", folder.display()));
    let stored = store.last_change().await.map_err(|error| RunError::Store(error.to_string()))?;
    let repaired = Folder::repair(folder, stored.as_deref()).map_err(|error| wrong(&error))?;
    for file in repaired.iter().take(FILES_TOLD) {
        tracing::warn!(
            file,
            of = repaired.len(),
            "project: a change was interrupted, and this file is put in order"
        );
    }
    let opened = Folder::open(folder).map_err(|error| wrong(&error))?;
    let read = read(opened.files());
    if !read.errors.is_empty() {
        return Err(wrong(&FilesError::Wrong(read.errors)));
    }
    for finding in project::findings(opened.files(), &read) {
        tracing::warn!(file = finding.field, "project: {}", finding.message);
    }
    let version = read.version;
    let outcome = store.join(opened, read, false).await.map_err(|error| match error {
        StoreError::Files(error) => wrong(&error),
        error => RunError::Store(error.to_string()),
    })?;
    for part in outcome.parts {
        if part.how != ProjectChange::Unchanged {
            tracing::info!(what = ?part.what, how = ?part.how, name = part.name, id = part.id, file = part.file, "project");
        }
    }
    tracing::info!(folder = %folder.display(), version, "project");
    Ok(())
}

/// What is answered, wherever that will be.
fn site(app: App) -> Site {
    let limits = app.settings.limits;
    Site {
        listen: app.settings.listen,
        tls: app.tls.clone(),
        seats: Seats::new(limits.connections, limits.connections_per_client, app.policy.metrics.clone()),
        router: Box::new(move |address, is_tls| {
            app.policy.lists.listens_on(address);
            http::router(app.answering_at(address, is_tls))
        }),
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
