//! The clients that are compared. Each opens all its sessions, sends one request on each, and then all run at once.

use std::future::Future;
use std::net::SocketAddr;
use std::sync::{Arc, Barrier};
use std::time::Instant;

use crate::load::{Load, Sample, Watch, sum};
use crate::processor;
use crate::sessions::{Ciplink, Session, ours, rseip};
use crate::way::{Sender, Way};

/// Runs a load and counts.
pub(crate) fn run(sender: Sender, load: &Load) -> Sample {
    let before = processor::time();
    let watches = match sender {
        Sender::Ciplink => ciplink_threads(load),
        Sender::Ours => tasks(load, ours),
        Sender::Rseip => tasks(load, rseip),
    };
    sum(load, watches, processor::time().saturating_sub(before))
}

/// The runtime that `cipdeck` uses, with as many threads as the process has processors.
fn tasks<S, F>(load: &Load, open: fn(Way, Vec<SocketAddr>) -> F) -> Vec<Watch>
where
    S: Session,
    F: Future<Output = Vec<S>>,
{
    let runtime = tokio::runtime::Builder::new_multi_thread().enable_all().build().expect("a runtime");
    runtime.block_on(async {
        let mut sessions = open(load.way, load.targets.clone()).await;
        for session in &mut sessions {
            session.ask().await;
        }
        let window = load.window();
        let running: Vec<_> = sessions
            .into_iter()
            .map(|mut session| {
                tokio::spawn(async move {
                    let (mut watch, mut since) = (Watch::default(), Instant::now());
                    loop {
                        session.ask().await;
                        match watch.lap(since, window) {
                            Some(now) => since = now,
                            None => break,
                        }
                    }
                    session.close().await;
                    watch
                })
            })
            .collect();
        let mut watches = Vec::new();
        for session in running {
            watches.push(session.await.expect("a session ends well"));
        }
        watches
    })
}

fn ciplink_threads(load: &Load) -> Vec<Watch> {
    let started = Arc::new(Barrier::new(load.targets.len()));
    std::thread::scope(|scope| {
        let running: Vec<_> = load
            .targets
            .iter()
            .map(|target| {
                let started = Arc::clone(&started);
                scope.spawn(move || {
                    let session = Ciplink::open(load.way, *target);
                    session.ask();
                    started.wait();
                    let window = load.window();
                    let (mut watch, mut since) = (Watch::default(), Instant::now());
                    loop {
                        session.ask();
                        match watch.lap(since, window) {
                            Some(now) => since = now,
                            None => break,
                        }
                    }
                    session.close();
                    watch
                })
            })
            .collect();
        running.into_iter().map(|session| session.join().expect("a session ends well")).collect()
    })
}
