//! What a request does is found wherever it hides it: what is carried is never milder than what it is alone.
#![no_main]

use cipdeck_shared::plan::effects;
use cipdeck_shared::table::Access;
use cipdeck_shared::wire::{Epath, MultipleServicePacket, PortSegment, RequestTimeout, UnconnectedSend};
use libfuzzer_sys::fuzz_target;

const GET: &[u8] = &[0x0E, 3, 0x20, 1, 0x24, 1, 0x30, 7];

fuzz_target!(|bytes: &[u8]| {
    let alone = access(bytes);
    let Some(port) = PortSegment::new(1, 0) else { return };
    let (timeout, route) = (RequestTimeout::at_least(1_000), Epath::default().hop(port));
    if let Ok(routed) = (UnconnectedSend { timeout, message: bytes, route }).request() {
        assert!(access(&routed.bytes()).may_write() >= alone.may_write(), "on a route");
    }
    if let Some(packet) = MultipleServicePacket::new(vec![GET, bytes, GET])
        && let Ok(packet) = packet.request()
    {
        assert!(access(&packet.bytes()).may_write() >= alone.may_write(), "in a packet");
    }
});

fn access(bytes: &[u8]) -> Access {
    let all = effects(bytes);
    assert!(!all.is_empty(), "every request does something, if only unknown");
    Access::of_all(all.iter().map(|effect| effect.access))
}
