//! The read that belongs to a write.

use crate::config::{Channel, Profile};
use crate::wire::{ClassCode, MessageRouterRequest, ServiceCode};

use super::effect::effects;
use super::routed::Routes;
use super::{ConnectionPlan, MessagePlan, TriggerType};

/// A service that writes, and the one that reads the same. CIP Vol 1, appendix A.
const PAIRS: [(u8, u8); 3] = [(0x02, 0x01), (0x10, 0x0E), (0x19, 0x18)];

/// Modbus object: Write_Holding_Registers and Read_Holding_Registers. Schneider EIO0000001601 p. 67.
const REGISTERS: (u8, u8) = (0x50, 0x4E);

/// Start and quantity, in front of the registers.
const REGISTERS_HEAD: usize = 4;

/// The longest that a read of our own waits.
const PATIENCE_MS: u32 = 10_000;

impl MessagePlan {
    /// The read of what this message writes, on the same way; none where no service reads the same.
    pub fn reader(&self) -> Option<Self> {
        let head = self.written_from();
        let pair = PAIRS.into_iter().chain((head > 0).then_some(REGISTERS));
        let (_, read) = pair.into_iter().find(|(write, _)| *write == self.request.service().0)?;
        // The path as it stands there: a device may care how wide its numbers are.
        let data_at = self.bytes.len().checked_sub(self.request.data().len())?;
        let path = self.bytes.get(1..data_at)?;
        let bytes = [&[read], path, self.request.data().get(..head)?].concat();
        let request = MessageRouterRequest::decode(&bytes).ok()?;
        let timeout_ms = self.ucmm_timeout_ms.min(PATIENCE_MS);
        let route = self.routes.of(Profile::Auto).route();
        let routes = if route.is_empty() {
            Routes::direct(bytes.clone())
        } else {
            Routes::new(&request, route, timeout_ms).ok()?
        };
        Some(Self {
            routes,
            effects: effects(&bytes).into(),
            bytes: bytes.into(),
            request,
            // Not one of the controller's four buffers.
            channel: Channel::Monitor,
            trigger: TriggerType::Once,
            ucmm_timeout_ms: timeout_ms,
            connection: self.connection.map(|connection| ConnectionPlan {
                timeout_ms: connection.timeout_ms.min(PATIENCE_MS),
                ..connection
            }),
            resume: false,
            words: None,
            ..self.clone()
        })
    }

    /// The data that this message writes, as [`Self::reader`] finds it.
    pub fn written(&self) -> &[u8] {
        self.request.data().get(self.written_from()..).unwrap_or_default()
    }

    /// Where the values begin in the data.
    fn written_from(&self) -> usize {
        let class = self.effects.first().and_then(|effect| effect.class).map(ClassCode);
        let registers =
            self.request.service() == ServiceCode(REGISTERS.0) && class == Some(ClassCode::Modbus);
        if registers { REGISTERS_HEAD } else { 0 }
    }
}
