//! One accident at a time, at every frame and at every moment of a conversation.

use cipdeck_shared::engine::Millis;
use cipdeck_shared::sim::{Quirk, SimConfig};

#[cfg(target_arch = "wasm32")]
use wasm_bindgen_test::wasm_bindgen_test as test;

use crate::network::Fate;
use crate::shots::BlockSpec;
use crate::world::{Press, World};

/// Frames of a device in the conversation: session, identity, three messages, two connections, and their ends.
const FRAMES: usize = 14;

fn conversation(quirks: Vec<Quirk>) -> World {
    let device = SimConfig { delay: Millis(3), quirks, ..SimConfig::default() };
    let specs = vec![
        BlockSpec::plain(0),
        BlockSpec::connected(0),
        BlockSpec { route: ",1,1", conn_close: true, ..BlockSpec::connected(0) },
    ];
    let mut world = World::new(vec![device], specs);
    for block in 0..3 {
        world.press_at(1 + block as u64, Press::Run(block));
        world.press_at(100 + block as u64, Press::Run(block));
    }
    world
}

/// Lets it end; afterwards every block works as if nothing had happened.
fn recovers(mut world: World) {
    world.pass(8_000);
    world.check();
    for block in 0..3 {
        let finished = world.run(block);
        assert!(finished.view.q, "{finished:?}");
    }
    world.stop();
    world.check_stopped();
}

#[test]
fn every_accident_at_every_frame() {
    let accidents = [
        Fate::Lose,
        Fate::Pass(5_000, 1),
        Fate::Pass(20, 1),
        Fate::Twice(0),
        Fate::Twice(7),
        Fate::Twice(900),
        Fate::Replay(0),
        Fate::Replay(1),
        Fate::Spoil(1, 1),
        Fate::Spoil(5, 0xFF),
        Fate::Spoil(8, 1),
        Fate::Cut(0),
        Fate::Cut(30),
    ];
    for quirks in [vec![], vec![Quirk::OwnConnectionId]] {
        for accident in &accidents {
            for frame in 0..FRAMES {
                let mut world = conversation(quirks.clone());
                world.fates = vec![Fate::Pass(0, usize::MAX); frame];
                world.fates.push(accident.clone());
                recovers(world);
            }
        }
    }
}

#[test]
fn without_contexts_every_accident_that_a_network_can_have() {
    for accident in [Fate::Lose, Fate::Pass(5_000, 1), Fate::Cut(0), Fate::Cut(30)] {
        for frame in 0..FRAMES {
            let mut world = conversation(vec![Quirk::NoContext, Quirk::OwnConnectionId]);
            world.fates = vec![Fate::Pass(0, usize::MAX); frame];
            world.fates.push(accident.clone());
            recovers(world);
        }
    }
}

#[test]
fn a_cancel_at_every_moment() {
    for moment in 1..150 {
        for block in 0..3 {
            let mut world = conversation(vec![]);
            world.press_at(moment, Press::Cancel(block));
            recovers(world);
        }
    }
}

#[test]
fn a_stop_at_every_moment() {
    for moment in 1..150 {
        let mut world = conversation(vec![]);
        world.pass(moment);
        world.stop();
        world.check_stopped();
    }
}
