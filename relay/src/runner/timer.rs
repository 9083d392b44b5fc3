//! Calls the engine when its next time limit or trigger is due.

use std::sync::Arc;
use std::time::Duration;

use super::Inner;

/// Runs until the runner stops. A panic ends one call into the engine, not the timer of everybody.
pub(super) async fn run(inner: Arc<Inner>) {
    loop {
        let ticking = tokio::spawn(tick(Arc::clone(&inner)));
        let stop = ticking.abort_handle();
        tokio::select! {
            () = inner.stop.cancelled() => return stop.abort(),
            ended = ticking => if let Err(error) = ended {
                tracing::error!(%error, "the timer failed and is started again");
                tokio::time::sleep(Duration::from_millis(100)).await;
                inner.with(|state, _| state.armed = None);
            },
        }
    }
}

async fn tick(inner: Arc<Inner>) {
    let mut wake = inner.wake.subscribe();
    loop {
        let next = *wake.borrow_and_update();
        let due = async {
            match next {
                Some(at) => tokio::time::sleep_until(inner.clock.at(at)).await,
                None => std::future::pending().await,
            }
        };
        tokio::select! {
            () = due => inner.tick(),
            changed = wake.changed() => if changed.is_err() { return },
        }
    }
}
