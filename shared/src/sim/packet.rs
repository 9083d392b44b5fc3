//! Multiple_Service_Packet: several requests in a message.

use alloc::vec::Vec;

use crate::engine::time::Instant;
use crate::wire::{GeneralStatus, MultipleServicePacket, MultipleServiceReply};

use super::device::{Caller, Device};
use super::request::{Answer, Refusal, service_of};

/// Packets in packets are carried out inside of each other.
const MAX_DEPTH: u8 = 8;

/// Resource unavailable.
const NO_RESOURCE: GeneralStatus = GeneralStatus(0x02);

impl Device {
    /// Each request gets what room the others leave; with at least one refused the status is 1E.
    pub(super) fn packet(
        &mut self,
        module: usize,
        data: &[u8],
        caller: Caller,
        now: Instant,
    ) -> Result<Vec<u8>, Refusal> {
        if caller.depth >= MAX_DEPTH {
            return Err(NO_RESOURCE.into());
        }
        let packet = MultipleServicePacket::decode(data).map_err(|_| GeneralStatus::NotEnoughData)?;
        self.counters.packets += 1;
        let count = packet.parts().len();
        // Count, an offset each, and at least a status each.
        let least = Answer::HEAD + 2 + (2 + Answer::HEAD) * count;
        let mut room = caller.room.checked_sub(least).ok_or(GeneralStatus::ReplyDataTooLarge)?;
        let mut parts = Vec::with_capacity(count);
        let mut refused = false;
        for part in packet.parts() {
            let own = room + Answer::HEAD;
            let inner = Caller { depth: caller.depth + 1, room: own, ..caller };
            let mut reply = self.ask(module, part, inner, now).message;
            if reply.len() > own {
                let refusal = Answer::refusal(service_of(part), GeneralStatus::ReplyDataTooLarge);
                reply = refusal.message;
            }
            refused |= reply.get(2) != Some(&GeneralStatus::Success.0);
            room = room.saturating_sub(reply.len().saturating_sub(Answer::HEAD));
            parts.push(reply);
        }
        let data = MultipleServiceReply::data(&parts).ok_or(GeneralStatus::ReplyDataTooLarge)?;
        if refused {
            return Err(Refusal { data, ..Refusal::from(GeneralStatus::EmbeddedServiceError) });
        }
        Ok(data)
    }
}
