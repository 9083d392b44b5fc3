//! Sorts what arrives: answers of devices, each once, and everything else.

use std::collections::BTreeMap;
use std::net::{SocketAddr, SocketAddrV4};

use cipdeck_shared::api::DiscoveredDevice;
use cipdeck_shared::wire::{
    Command, CommonPacketFormat, Encapsulation, EncapsulationStatus, ItemType, ListIdentityItem, Reader,
    SenderContext,
};

/// Devices of one search.
const MAX_DEVICES: usize = 4_096;

/// Who has answered so far.
#[derive(Debug)]
pub(super) struct Collector {
    context: SenderContext,
    /// By source address and serial number.
    devices: BTreeMap<(SocketAddrV4, u32), DiscoveredDevice>,
    /// Answers for which there was no more room.
    surplus: u64,
    /// Datagrams that were no answers.
    ignored: u64,
}

impl Collector {
    /// Of the answers to a question with this context.
    pub(super) fn new(context: SenderContext) -> Self {
        Self { context, devices: BTreeMap::new(), surplus: 0, ignored: 0 }
    }

    /// Takes a datagram, whatever it is.
    pub(super) fn take(&mut self, from: SocketAddr, datagram: &[u8]) {
        let (SocketAddr::V4(from), Some((context, item))) = (from, identity(datagram)) else {
            self.ignored = self.ignored.saturating_add(1);
            tracing::debug!(peer.address = %from, bytes = ?datagram, "not an answer to ListIdentity");
            return;
        };
        if context != self.context {
            // Some devices do not send it back. Whoever introduces itself is there all the same.
            tracing::debug!(peer.address = %from, ?context, "an answer with another context");
        }
        let key = (from, item.serial);
        if self.devices.len() >= MAX_DEVICES && !self.devices.contains_key(&key) {
            self.surplus = self.surplus.saturating_add(1);
            return;
        }
        let device = || DiscoveredDevice::new(from.ip().octets(), from.port(), &item);
        self.devices.entry(key).or_insert_with(device);
    }

    /// The devices by address; what was left out is added to `errors`.
    pub(super) fn finish(self, errors: &mut Vec<String>) -> Vec<DiscoveredDevice> {
        if self.ignored > 0 {
            tracing::debug!(datagrams = self.ignored, "ignored");
        }
        if self.surplus > 0 {
            errors.push(format!("{} answers beyond the first {MAX_DEVICES} are left out", self.surplus));
        }
        self.devices.into_values().collect()
    }
}

/// The context and the identity in a successful answer to `ListIdentity`.
fn identity(datagram: &[u8]) -> Option<(SenderContext, ListIdentityItem)> {
    let frame = Encapsulation::decode(datagram).ok()?;
    let header = frame.header;
    if header.command != Command::ListIdentity || header.status != EncapsulationStatus::Success {
        return None;
    }
    let packet = CommonPacketFormat::read(&mut Reader::new(frame.data())).ok()?;
    let item = packet.find(ItemType::ListIdentity)?;
    Some((header.context, ListIdentityItem::decode(item.data).ok()?))
}

#[cfg(test)]
mod tests {
    use cipdeck_shared::sim::{Device, SimConfig, SimIdentity, handle_datagram};

    use super::*;
    use crate::discover::request;

    const CONTEXT: SenderContext = SenderContext([1, 2, 3, 4, 5, 6, 7, 8]);

    fn answer(serial: u32) -> Vec<u8> {
        let identity = SimIdentity { serial, ..SimIdentity::default() };
        let device = Device::new(SimConfig { identity, ..SimConfig::default() });
        handle_datagram(&device, &request(CONTEXT)).unwrap()
    }

    fn from(last: u8) -> SocketAddr {
        ([10, 0, 0, last], 44_818).into()
    }

    fn serials(collector: Collector) -> Vec<String> {
        let mut errors = Vec::new();
        let devices = collector.finish(&mut errors);
        assert_eq!(errors, Vec::<String>::new());
        devices.into_iter().map(|device| format!("{} {}", device.address, device.serial)).collect()
    }

    #[test]
    fn a_device_that_answers_twice_is_there_once() {
        let mut collector = Collector::new(CONTEXT);
        for (last, serial) in [(2, 7), (1, 7), (2, 7), (2, 8), (1, 7)] {
            collector.take(from(last), &answer(serial));
        }
        let expected = ["10.0.0.1 00000007", "10.0.0.2 00000007", "10.0.0.2 00000008"];
        assert_eq!(serials(collector), expected, "by address");
    }

    #[test]
    fn an_answer_without_our_context_counts() {
        let mut collector = Collector::new(SenderContext::default());
        collector.take(from(1), &answer(7));
        assert_eq!(serials(collector), ["10.0.0.1 00000007"]);
    }

    #[test]
    fn every_cut_and_every_changed_byte_is_survived() {
        let good = answer(7);
        let mut collector = Collector::new(CONTEXT);
        for length in 0..good.len() {
            collector.take(from(1), &good[..length]);
        }
        assert_eq!(collector.ignored, good.len() as u64);
        for at in 0..good.len() {
            for change in [0x01, 0x80, 0xFF] {
                let mut changed = good.clone();
                changed[at] ^= change;
                collector.take(from(1), &changed);
            }
        }
        assert!(
            collector.devices.len() < 20,
            "a changed serial number is another device, everything else is not"
        );
    }

    #[test]
    fn refusals_questions_and_other_commands_are_no_answers() {
        let mut collector = Collector::new(CONTEXT);
        let (mut refused, mut other) = (answer(7), answer(7));
        (refused[8], other[0]) = (1, 0x04);
        for datagram in [refused, other, request(CONTEXT), vec![0xFF; 1_500]] {
            collector.take(from(1), &datagram);
        }
        collector.take("[::1]:44818".parse().unwrap(), &answer(7));
        assert_eq!(collector.ignored, 5);
        assert_eq!(serials(collector), Vec::<String>::new());
    }

    #[test]
    fn a_flood_of_devices_is_bounded() {
        let mut collector = Collector::new(CONTEXT);
        for serial in 0..5_000 {
            collector.take(from(1), &answer(serial));
        }
        let mut errors = Vec::new();
        assert_eq!(collector.finish(&mut errors).len(), 4_096);
        assert_eq!(errors, ["904 answers beyond the first 4096 are left out"]);
    }
}
