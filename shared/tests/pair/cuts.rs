//! A TCP connection that breaks after every single byte, in either direction.

use cipdeck_shared::sim::SimConfig;

#[cfg(target_arch = "wasm32")]
use wasm_bindgen_test::wasm_bindgen_test as test;

use crate::network::Cut;
use crate::shots::BlockSpec;
use crate::world::{Press, World};

/// Everything that a session can have: plain, routed and connected messages, two connections, and one that is closed.
/// How many bytes have gone in each direction of its first TCP connection.
fn conversation(cut: Option<Cut>) -> (usize, usize) {
    let specs = vec![
        BlockSpec::plain(0),
        BlockSpec { route: ",1,1", ..BlockSpec::plain(0) },
        BlockSpec::connected(0),
        BlockSpec { route: ",1,1", conn_close: true, ..BlockSpec::connected(0) },
    ];
    let mut world = World::new(vec![SimConfig::default()], specs);
    world.cut = cut;
    for block in 0..4 {
        world.press_at(10 + block as u64, Press::Run(block));
    }
    world.pass(3_000);
    assert_eq!(world.finished.len(), 4, "everything ends: {cut:?}");
    world.check();
    let bytes = world.first_sent;
    world.cut = None;
    for block in 0..4 {
        let finished = world.run(block);
        assert!(finished.view.q, "{cut:?}: the next one works: {finished:?}");
    }
    world.stop();
    world.check_stopped();
    bytes
}

#[test]
fn at_every_byte_towards_the_device() {
    let bytes = conversation(None).0;
    assert!(bytes > 500, "a whole conversation: {bytes} bytes");
    for after in 0..bytes {
        conversation(Some(Cut::ToDevice(after)));
    }
}

#[test]
fn at_every_byte_towards_the_engine() {
    let bytes = conversation(None).1;
    assert!(bytes > 500, "a whole conversation: {bytes} bytes");
    for after in 0..bytes {
        conversation(Some(Cut::ToEngine(after)));
    }
}
