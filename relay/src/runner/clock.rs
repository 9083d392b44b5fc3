//! The runtime's time as the engine counts it.

use std::time::Duration;

use cipdeck_shared::engine::Instant;

/// Microseconds since the clock was made.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Clock {
    epoch: tokio::time::Instant,
}

impl Clock {
    /// Starts at zero.
    pub(crate) fn start() -> Self {
        Self { epoch: tokio::time::Instant::now() }
    }

    /// Now.
    pub(crate) fn now(&self) -> Instant {
        Instant(u64::try_from(self.epoch.elapsed().as_micros()).unwrap_or(u64::MAX))
    }

    /// When the runtime has to wake somebody up.
    pub(crate) fn at(&self, instant: Instant) -> tokio::time::Instant {
        // A wake-up beyond all calendars is a wake-up in a year: waking too early is harmless.
        let year = Duration::from_hours(365 * 24);
        let wait = Duration::from_micros(instant.0);
        self.epoch.checked_add(wait).unwrap_or_else(|| tokio::time::Instant::now() + year)
    }
}
