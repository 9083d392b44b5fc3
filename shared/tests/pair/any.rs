//! Any devices, blocks, buttons and accidents.

use cipdeck_shared::config::Profile;
use cipdeck_shared::engine::Millis;
use cipdeck_shared::sim::{Fault, Quirk, SimConfig};
use cipdeck_shared::wire::EncapsulationStatus;
use proptest::collection::vec;
use proptest::prelude::*;

use crate::network::Fate;
use crate::shots::BlockSpec;
use crate::world::{Press, World};

const DEVICES: usize = 3;
const BLOCKS: usize = 6;

fn device() -> impl Strategy<Value = SimConfig> {
    let delay = prop_oneof![3 => Just(0), 2 => 1..50_u64, 1 => 200..2_000_u64];
    let fault = prop_oneof![
        6 => Just(Fault::Ok),
        1 => prop::sample::select(vec![
            Fault::Drop,
            Fault::WrongContext,
            Fault::WrongSession,
            Fault::WrongConnectionId,
            Fault::WrongSequence,
            Fault::WrongService,
            Fault::Garbage,
            Fault::HalfFrame,
            Fault::Close,
            Fault::EncapsulationStatus(EncapsulationStatus(8)),
        ]),
    ];
    let size = prop::sample::select(vec![32_u16, 100, 500, 4_002]);
    (delay, vec(fault, 0..6), any::<bool>(), any::<bool>(), 1..4_usize, any::<bool>(), size).prop_map(
        |(delay, faults, no_context, own_id, max_connections, large, max_size)| {
            let quirks = [(no_context, Quirk::NoContext), (own_id, Quirk::OwnConnectionId)];
            let quirks = quirks.into_iter().filter(|(has, _)| *has).map(|(_, quirk)| quirk).collect();
            SimConfig {
                delay: Millis(delay),
                faults,
                max_connections,
                large,
                max_size,
                quirks,
                ..SimConfig::default()
            }
        },
    )
}

fn block() -> impl Strategy<Value = BlockSpec> {
    // One more device than there is: nobody listens there.
    let device = prop_oneof![12 => 0..DEVICES, 1 => Just(DEVICES)];
    let route =
        prop::sample::select(vec!["", "", ",1,0", ",1,1", ",1,9", ",1,3,2,192.168.1.20", ",2,192.168.1.99"]);
    let period = prop_oneof![3 => Just(0), 1 => 1..400_i64];
    let keep_alive = prop_oneof![2 => Just(0), 1 => Just(1_000)];
    let profile =
        prop::sample::select(vec![Profile::Auto, Profile::Generic, Profile::Logix, Profile::Micro800]);
    let timeouts = (250..3_000_i64, 800..3_000_i64);
    (device, route, any::<[bool; 3]>(), period, keep_alive, profile, timeouts).prop_map(
        |(device, route, [connected, conn_close, monitor], period, keep_alive, profile, timeouts)| {
            BlockSpec { device, route, connected, conn_close, monitor, period, keep_alive, profile, timeouts }
        },
    )
}

fn fate() -> impl Strategy<Value = Fate> {
    prop_oneof![
        6 => (0..20_u64, 1..80_usize).prop_map(|(delay, piece)| Fate::Pass(delay, piece)),
        2 => (200..4_000_u64).prop_map(|delay| Fate::Pass(delay, usize::MAX)),
        1 => Just(Fate::Lose),
        3 => (0..3_000_u64).prop_map(Fate::Twice),
        2 => (any::<usize>(), any::<u8>()).prop_map(|(at, with)| Fate::Spoil(at, with)),
        3 => any::<usize>().prop_map(Fate::Replay),
        1 => (0..100_usize).prop_map(Fate::Cut),
    ]
}

fn press() -> impl Strategy<Value = Press> {
    prop_oneof![
        8 => (0..BLOCKS).prop_map(Press::Run),
        1 => (0..BLOCKS).prop_map(Press::Cancel),
        2 => (0..BLOCKS, any::<bool>()).prop_map(|(block, on)| Press::In(block, on)),
    ]
}

proptest! {
    #![proptest_config(ProptestConfig { cases: 256, ..ProptestConfig::default() })]

    #[test]
    fn anything_on_the_way(
        devices in vec(device(), DEVICES),
        specs in vec(block(), BLOCKS),
        presses in vec((0..300_u64, press()), 0..60),
        fates in vec(fate(), 0..80),
    ) {
        let without_context =
            |device: &SimConfig| device.quirks.contains(&Quirk::NoContext);
        let indistinct = (0..DEVICES).filter(|index| without_context(&devices[*index])).collect();
        let mut world = World::new(devices, specs);
        (world.fates, world.indistinct) = (fates, indistinct);
        let mut time = 1;
        for (gap, press) in presses {
            time += gap;
            world.press_at(time, press);
        }
        world.pass(time + 10_000);
        world.check();
        world.stop();
        world.check_stopped();
    }
}
