//! The read that belongs to a write.

use alloc::vec::Vec;

use crate::config::{Channel, Profile};
use crate::wire::{MessageRouterRequest, ServiceCode};

use super::effect::effects;
use super::routed::Routes;
use super::{MessagePlan, TriggerType};

/// A service that writes, and the one that reads the same. CIP Vol 1, appendix A.
const PAIRS: [(u8, u8); 3] = [(0x02, 0x01), (0x10, 0x0E), (0x19, 0x18)];

impl MessagePlan {
    /// The read of what this message writes, on the same way; none where no service reads the same.
    pub fn reader(&self) -> Option<Self> {
        let (_, read) = PAIRS.into_iter().find(|(write, _)| *write == self.request.service().0)?;
        let request =
            MessageRouterRequest::new(ServiceCode(read), self.request.path().clone(), Vec::new()).ok()?;
        let bytes = request.bytes();
        let route = self.routes.of(Profile::Auto).route();
        Some(Self {
            routes: Routes::new(&request, route, self.ucmm_timeout_ms).ok()?,
            effects: effects(&bytes).into(),
            bytes: bytes.into(),
            request,
            // Not one of the controller's four buffers.
            channel: Channel::Monitor,
            trigger: TriggerType::Once,
            resume: false,
            ..self.clone()
        })
    }
}
