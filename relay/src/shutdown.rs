//! The signals that stop the process.

use std::future::Future;

/// Listens from now on; ready when the process is asked to stop: Ctrl-C, or SIGTERM on Unix.
pub(crate) fn requested() -> impl Future<Output = ()> + Send {
    // Not inside of the future: a signal that comes before it is waited for must not kill the process.
    let signals = signals();
    async move {
        match signals {
            Ok(signals) => {
                let signal = signals.await;
                tracing::info!(signal, "stopping");
            }
            Err(error) => {
                tracing::error!(%error, "cannot listen for signals");
                std::future::pending::<()>().await;
            }
        }
    }
}

#[cfg(unix)]
fn signals() -> std::io::Result<impl Future<Output = &'static str> + Send> {
    use tokio::signal::unix::{SignalKind, signal};
    let (mut interrupt, mut terminate) = (signal(SignalKind::interrupt())?, signal(SignalKind::terminate())?);
    Ok(async move {
        tokio::select! {
            _ = interrupt.recv() => "interrupt",
            _ = terminate.recv() => "terminate",
        }
    })
}

#[cfg(windows)]
fn signals() -> std::io::Result<impl Future<Output = &'static str> + Send> {
    use tokio::signal::windows::{ctrl_break, ctrl_c, ctrl_close};
    let (mut interrupt, mut stop, mut close) = (ctrl_c()?, ctrl_break()?, ctrl_close()?);
    Ok(async move {
        tokio::select! {
            _ = interrupt.recv() => "interrupt",
            _ = stop.recv() => "break",
            _ = close.recv() => "close",
        }
    })
}
