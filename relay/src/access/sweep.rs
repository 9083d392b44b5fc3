//! Ends what is over although nobody asks: who watches with an ended session is shown out within a second.

use std::sync::{Arc, Weak};
use std::time::Duration;

use super::trail::Event;
use super::{Access, Inner};
use crate::runner::lock;

/// How often.
const PERIOD: Duration = Duration::from_millis(500);

/// Every so many times it is stored when tokens and links were used.
const STORE_EVERY: u32 = 120;

/// Goes on as long as somebody holds the access.
pub(super) fn start(inner: &Arc<Inner>) {
    let inner = Arc::downgrade(inner);
    tokio::spawn(async move {
        for turn in 1_u32.. {
            tokio::time::sleep(PERIOD).await;
            let Some(inner) = Weak::upgrade(&inner) else { return };
            Access(inner).sweep(turn % STORE_EVERY == 0).await;
        }
    });
}

impl Access {
    async fn sweep(&self, is_time_to_store: bool) {
        let ended = lock(&self.0.sessions).sweep();
        for session in ended {
            let members = [("user", session.user.as_str()), ("why", "idle or too old")];
            self.0.trail.record(Event::SessionEnded, "relay", "", &members);
        }
        lock(&self.0.passes).end_ended();
        if is_time_to_store {
            self.store_used().await;
        }
    }

    /// Stores when tokens and links were used.
    async fn store_used(&self) {
        let used = lock(&self.0.passes).newly_used();
        if !used.is_empty()
            && let Err(error) = self.0.store.passes_used(used).await
        {
            tracing::warn!(%error, "not stored when tokens were used");
        }
    }
}
