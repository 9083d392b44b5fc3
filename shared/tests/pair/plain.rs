//! A good network: everything that is asked is answered, and everything is closed in order.

use cipdeck_shared::config::Profile;
use cipdeck_shared::engine::Millis;
use cipdeck_shared::sim::{Quirk, SimConfig};

#[cfg(target_arch = "wasm32")]
use wasm_bindgen_test::wasm_bindgen_test as test;

use crate::network::Fate;
use crate::shots::BlockSpec;
use crate::world::{Press, World};

/// Every way to a device.
fn ways(device: usize) -> Vec<BlockSpec> {
    let mut ways = Vec::new();
    for connected in [false, true] {
        for route in ["", ",1,1", ",2,192.168.1.20", ",1,3,2,192.168.1.20"] {
            ways.push(BlockSpec { route, connected, ..BlockSpec::plain(device) });
        }
    }
    ways
}

fn quirky() -> Vec<SimConfig> {
    let quirks = [
        vec![],
        vec![Quirk::NoContext],
        vec![Quirk::OwnConnectionId],
        vec![Quirk::NoContext, Quirk::OwnConnectionId],
    ];
    quirks.into_iter().map(|quirks| SimConfig { quirks, ..SimConfig::default() }).collect()
}

#[test]
fn every_way_to_every_kind_of_device_gives_its_own_value() {
    let devices = quirky();
    let specs: Vec<_> = (0..devices.len()).flat_map(ways).collect();
    let blocks = specs.len();
    let mut world = World::new(devices, specs);
    for round in 0..5 {
        for block in 0..blocks {
            let finished = world.run(block);
            assert!(finished.view.q, "round {round}: {finished:?}");
        }
    }
    world.stop();
    world.check_stopped();
    for device in &world.devices {
        let counters = device.counters();
        assert_eq!(
            (counters.opened, counters.connected, counters.timed_out, counters.dropped),
            (4, 20, 0, 0)
        );
        assert_eq!((counters.closed, counters.unregistered), (4, 0), "each by its own Forward_Close");
    }
}

#[test]
fn a_thousand_connected_messages_are_one_connection() {
    let mut world = World::new(vec![SimConfig::default()], vec![BlockSpec::connected(0)]);
    for _ in 0..1_000 {
        assert!(world.run(0).view.q);
    }
    world.stop();
    world.check_stopped();
    let counters = world.devices[0].counters();
    assert_eq!((counters.opened, counters.connected, counters.closed), (1, 1_000, 1), "{counters}");
}

#[test]
fn an_engine_does_not_grow_with_what_it_has_done() {
    let mut world = World::new(quirky(), (0..4).flat_map(ways).collect());
    let mut sizes = Vec::new();
    for _ in 0..3 {
        for _ in 0..10 {
            for block in 0..world.specs.len() {
                world.run(block);
            }
        }
        world.finished.clear();
        // Everything that it holds is in its debug text, numbers of growing length too.
        sizes.push(format!("{:?}", world.engine).len());
    }
    assert!(sizes[2] < sizes[0] + sizes[0] / 50, "{sizes:?}");
}

#[test]
fn many_blocks_at_once_share_targets_and_connections() {
    let devices: Vec<_> = (0..3).map(|_| SimConfig { delay: Millis(5), ..SimConfig::default() }).collect();
    let specs: Vec<_> = (0..3).flat_map(ways).collect();
    let blocks = specs.len();
    let mut world = World::new(devices, specs);
    for round in 0..20 {
        for block in 0..blocks {
            world.press_at(round * 200 + 10, Press::Run(block));
        }
    }
    world.pass(10_000);
    assert_eq!(world.finished.len(), 20 * blocks);
    assert!(world.finished.iter().all(|finished| finished.view.q));
    world.stop();
    world.check_stopped();
}

#[test]
fn cyclic_and_one_shot_messages_live_together() {
    let cyclic = |device, connected, period| BlockSpec { connected, period, ..BlockSpec::plain(device) };
    let specs = vec![
        cyclic(0, false, 20),
        cyclic(0, true, 50),
        BlockSpec::plain(0),
        BlockSpec { conn_close: true, ..BlockSpec::connected(0) },
        cyclic(1, true, 1),
        BlockSpec { monitor: false, ..BlockSpec::connected(1) },
    ];
    let mut world = World::new(vec![SimConfig::default(), SimConfig::default()], specs);
    for block in [0, 1, 4] {
        world.press_at(1, Press::In(block, true));
    }
    for time in 0..50 {
        for block in [2, 3, 5] {
            world.press_at(time * 40 + 7, Press::Run(block));
        }
    }
    world.pass(2_100);
    let runs =
        |block| world.finished.iter().filter(|finished| finished.block == block && finished.view.q).count();
    assert!(runs(0) >= 100 && runs(1) >= 40 && runs(4) >= 400, "{} {} {}", runs(0), runs(1), runs(4));
    assert_eq!([2, 3, 5].map(runs), [50; 3]);
    world.stop();
    world.check_stopped();
}

#[test]
fn a_late_reply_never_answers_another_request() {
    for spec in
        [BlockSpec::plain(0), BlockSpec::connected(0), BlockSpec { route: ",1,1", ..BlockSpec::plain(0) }]
    {
        for quirks in [vec![], vec![Quirk::NoContext], vec![Quirk::OwnConnectionId]] {
            let device = SimConfig { quirks, ..SimConfig::default() };
            let mut world = World::new(vec![device], vec![spec.clone(), spec.clone()]);
            assert!(world.run(0).view.q);
            world.fates = vec![Fate::Pass(5_000, 7)];
            let finished = world.run(0);
            let status = finished.view.status;
            assert_eq!((status.error_id, status.sub_error_id), (55, 115), "{finished:?}");
            for _ in 0..100 {
                assert!(world.run(1).view.q);
            }
            world.pass(10_000);
            world.stop();
            world.check_stopped();
        }
    }
}

#[test]
fn a_connection_is_kept_alive_or_replaced_for_as_long_as_it_takes() {
    for keep_alive in [0, 1_000, 60_000] {
        let specs = vec![
            BlockSpec { keep_alive, ..BlockSpec::connected(0) },
            BlockSpec { keep_alive, period: 300, ..BlockSpec::plain(0) },
        ];
        let mut world = World::new(vec![SimConfig::default()], specs);
        world.press_at(1, Press::In(1, true));
        for minute in 0..10 {
            assert!(world.run(0).view.q, "{keep_alive} ms, {minute}");
            world.pass(7_000 * (minute + 1));
        }
        assert_eq!(world.devices[0].counters().dropped, 0);
        world.stop();
        world.check_stopped();
        let counters = world.devices[0].counters();
        assert_eq!((counters.timed_out, counters.dropped), (0, 0), "{keep_alive} ms: {counters}");
    }
}

#[test]
fn a_device_that_closes_idle_connections_is_not_noticed() {
    let mut world =
        World::new(vec![SimConfig::default()], vec![BlockSpec::connected(0), BlockSpec::plain(0)]);
    for _ in 0..5 {
        assert!(world.run(0).view.q && world.run(1).view.q);
        world.hang_up();
        world.pass(100);
    }
    world.stop();
    world.check_stopped();
}

#[test]
fn a_device_with_room_for_one_connection_is_used_again_after_every_loss() {
    let device = SimConfig { max_connections: 1, ..SimConfig::default() };
    let mut world = World::new(vec![device], vec![BlockSpec::connected(0)]);
    for _ in 0..5 {
        assert!(world.run(0).view.q, "what the lost socket has left is closed first");
        world.hang_up();
        world.pass(100);
    }
    world.fates = vec![Fate::Lose];
    world.run(0);
    assert!(world.run(0).view.q);
    world.stop();
    world.check_stopped();
}

#[test]
fn a_time_too_short_for_opening_does_not_use_up_the_connections_of_a_device() {
    let device = SimConfig { delay: Millis(400), ..SimConfig::default() };
    let spec = BlockSpec { timeouts: (250, 800), period: 300, ..BlockSpec::connected(0) };
    let mut world = World::new(vec![device], vec![spec]);
    world.press_at(1, Press::In(0, true));
    let mut most = 0;
    for _ in 0..300 {
        world.pass(100);
        let counters = world.devices[0].counters();
        most = most.max(counters.opened - counters.closed - counters.timed_out);
    }
    assert!(most <= 2, "{most} connections at once");
    world.stop();
    world.check_stopped();
}

#[test]
fn profiles_are_found_out_on_the_way() {
    for (vendor, name, opened) in [(1, "2080-LC50", 504), (1, "1756-L85E", 4_002), (47, "NX102", 1_994)] {
        let mut device = SimConfig::default();
        (device.identity.vendor, device.identity.device_type) = (vendor, 0x0E);
        device.identity.name = cipdeck_shared::wire::ShortString::new(name.as_bytes()).unwrap();
        let route = ",1,0";
        let specs = vec![
            BlockSpec { route, ..BlockSpec::connected(0) },
            BlockSpec { route, ..BlockSpec::plain(0) },
            BlockSpec { profile: Profile::Generic, ..BlockSpec::connected(0) },
        ];
        let mut world = World::new(vec![device], specs);
        assert!(world.run(0).view.q && world.run(1).view.q, "{name}");
        let target = world.engine.targets().next().unwrap().1;
        assert_eq!(target.connections[0].size, opened, "{name}");
        world.stop();
        world.check_stopped();
    }
}
