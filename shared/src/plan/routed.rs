//! A message and its way: the bytes that go out unconnected.

use alloc::vec::Vec;

use crate::config::Profile;
use crate::wire::{
    Epath, MessageRouterRequest, PortSegment, RequestTimeout, Segment, TooLong, UnconnectedSend,
};

/// What is sent along a route.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Routed {
    route: Epath,
    message: Vec<u8>,
}

impl Routed {
    fn new(request: &MessageRouterRequest, route: Epath, timeout_ms: u32) -> Result<Self, TooLong> {
        let message = request.bytes();
        if route.is_empty() {
            return Ok(Self { route, message });
        }
        let timeout = RequestTimeout::at_least(timeout_ms);
        let message = UnconnectedSend { timeout, message: &message, route: route.clone() }.request()?.bytes();
        Ok(Self { route, message })
    }

    /// The hops behind the TCP endpoint.
    pub const fn route(&self) -> &Epath {
        &self.route
    }

    /// The bytes of the unconnected message.
    pub fn message(&self) -> &[u8] {
        &self.message
    }
}

/// The ways of one message.
#[derive(Clone, Debug, PartialEq, Eq)]
pub(super) struct Routes {
    typed: Routed,
    /// Without a last hop to the device's own slot, if there is one.
    trimmed: Option<Routed>,
}

impl Routes {
    pub(super) fn new(
        request: &MessageRouterRequest,
        route: &Epath,
        timeout_ms: u32,
    ) -> Result<Self, TooLong> {
        let trimmed = ends_at_own_slot(route).then(|| Routed::new(request, without_last(route), timeout_ms));
        Ok(Self { typed: Routed::new(request, route.clone(), timeout_ms)?, trimmed: trimmed.transpose()? })
    }

    /// Without a route: the bytes as they are.
    pub(super) fn direct(message: Vec<u8>) -> Self {
        Self { typed: Routed { route: Epath::default(), message }, trimmed: None }
    }

    pub(super) const fn differ(&self) -> bool {
        self.trimmed.is_some()
    }

    pub(super) fn of(&self, profile: Profile) -> &Routed {
        let trimmed = self.trimmed.as_ref().filter(|_| profile == Profile::Micro800);
        trimmed.unwrap_or(&self.typed)
    }
}

/// Whether the last hop is `1,0`: a controller without a chassis does not take it. pycomm3 logix_driver.py.
pub(super) fn ends_at_own_slot(route: &Epath) -> bool {
    let own = PortSegment::new(1, 0).map(Segment::Port);
    own.is_some() && route.segments().last() == own.as_ref()
}

fn without_last(route: &Epath) -> Epath {
    let kept = route.segments().split_last().map_or(&[][..], |(_, kept)| kept);
    kept.iter().cloned().fold(Epath::default(), Epath::with)
}
