//! Taking up another certificate while the relay runs: soon after its files have changed, or at once on SIGHUP.

use std::future::Future;
use std::time::Duration;

use super::Tls;
use crate::audit::{Audit, Event, Record};

/// How often the files are looked at.
const PACE: Duration = Duration::from_secs(2);

/// Goes on until it is dropped.
pub(crate) fn watch(tls: Tls, audit: Audit) -> impl Future<Output = ()> + Send {
    // Not inside of the future: from now on the signal must not end the process.
    let mut asked = Asked::listen();
    async move {
        loop {
            let was_asked = tokio::select! {
                () = asked.next() => true,
                () = tokio::time::sleep(PACE) => false,
            };
            let (tls, audit) = (tls.clone(), audit.clone());
            // Reading files and checking keys takes its time.
            let _ = tokio::task::spawn_blocking(move || look(&tls, &audit, was_asked)).await;
        }
    }
}

fn look(tls: &Tls, audit: &Audit, was_asked: bool) {
    if !was_asked && !tls.is_stale() {
        return;
    }
    match tls.reload() {
        Ok(true) => {
            let fingerprint = tls.fingerprint();
            tracing::info!(tls.fingerprint = fingerprint, "another certificate is in use");
            let record = Record::new(Event::CertificateReloaded, "relay", "");
            // What cannot be recorded has been logged.
            let _ = audit.append(&record.with("fingerprint", fingerprint));
        }
        Ok(false) if was_asked => tracing::info!("the certificate is the same"),
        Ok(false) => {}
        Err(error) => tracing::error!(%error, "the new certificate cannot be used: the old one stays"),
    }
}

/// SIGHUP.
#[cfg(unix)]
struct Asked(Option<tokio::signal::unix::Signal>);

#[cfg(unix)]
impl Asked {
    fn listen() -> Self {
        use tokio::signal::unix::{SignalKind, signal};
        Self(signal(SignalKind::hangup()).inspect_err(|error| tracing::warn!(%error, "no SIGHUP")).ok())
    }

    async fn next(&mut self) {
        let heard = match &mut self.0 {
            Some(signal) => signal.recv().await,
            None => None,
        };
        if heard.is_none() {
            std::future::pending::<()>().await;
        }
    }
}

/// Nobody asks: there are no such signals here.
#[cfg(not(unix))]
struct Asked;

#[cfg(not(unix))]
impl Asked {
    const fn listen() -> Self {
        Self
    }

    async fn next(&mut self) {
        std::future::pending().await
    }
}
