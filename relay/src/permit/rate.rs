//! How many messages a target gets per second, so that one busy block cannot take a small device down.

use std::collections::HashMap;
use std::sync::Mutex;
use std::time::Duration;

use cipdeck_shared::config::Target;
use tokio::time::Instant;

use super::Denied;
use crate::runner::lock;

/// A count per target and second.
#[derive(Debug)]
pub(crate) struct Rate {
    limit: u32,
    seconds: Mutex<HashMap<Target, (Instant, u32)>>,
}

/// Targets that are counted; more than a relay has sessions for.
const MAX_TARGETS: usize = 4_096;

const SECOND: Duration = Duration::from_secs(1);

impl Rate {
    /// Messages per second and target; 0 = no limit.
    pub(crate) fn new(limit: u32) -> Self {
        Self { limit, seconds: Mutex::default() }
    }

    /// Messages per second and target; 0 = no limit.
    pub(super) const fn limit(&self) -> u32 {
        self.limit
    }

    /// One more message.
    pub(super) fn take(&self, target: &Target, now: Instant) -> Result<(), Denied> {
        if self.limit == 0 || *target == Target::BuiltIn {
            return Ok(());
        }
        let mut seconds = lock(&self.seconds);
        if !seconds.contains_key(target) && seconds.len() >= MAX_TARGETS {
            seconds.retain(|_, (began, _)| now.duration_since(*began) < SECOND);
        }
        let (began, count) = match seconds.get_mut(target) {
            Some(second) => second,
            None => seconds.entry(target.clone()).or_insert((now, 0)),
        };
        if now.duration_since(*began) >= SECOND {
            (*began, *count) = (now, 0);
        }
        if *count >= self.limit {
            return Err(Denied::TooMany { target: target.to_string(), limit: self.limit });
        }
        *count += 1;
        Ok(())
    }
}
