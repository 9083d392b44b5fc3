//! A message under way.

use std::future::Future;
use std::pin::Pin;

use crate::runner::{Ended, Lane, Refused};

/// A message under way.
pub(super) struct Flight {
    /// Of a device that is asked how it is.
    pub(super) is_health: bool,
    /// Ready when it has ended.
    pub(super) message: Pin<Box<dyn Future<Output = Landed> + Send>>,
}

/// The lane comes back with what has become of its message.
pub(super) type Landed = (Lane, Result<Ended, Refused>);

/// When the message under way has ended; never without one.
pub(super) async fn landed(flight: &mut Option<Flight>) -> Landed {
    match flight {
        Some(flight) => flight.message.as_mut().await,
        None => std::future::pending().await,
    }
}
