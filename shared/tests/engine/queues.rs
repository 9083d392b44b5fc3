//! The queues of document 2080-RM001D p. 215 and 217, with connected and unconnected messages alike.

use cipdeck_shared::config::{BlockId, Channel};
use cipdeck_shared::engine::Phase;

#[cfg(target_arch = "wasm32")]
use wasm_bindgen_test::wasm_bindgen_test as test;

use crate::owner::Owner;

fn running(connected: bool, path: impl Fn(u32) -> String, blocks: u32) -> Owner {
    let mut owner = Owner::new();
    for n in 1..=blocks {
        owner.put_connected(BlockId(n), &path(n), |config| {
            config.target_cfg.cip_conn_mode = connected.into();
        });
        owner.run(BlockId(n)).unwrap();
    }
    owner
}

#[test]
fn four_messages_have_buffers_and_the_fifth_waits_with_en_only() {
    for connected in [false, true] {
        let mut owner = running(connected, |n| format!("4,10.0.0.{n}"), 6);
        let bits: Vec<_> = (1..=6).map(|n| owner.view(BlockId(n)).status.status_bits.0).collect();
        assert_eq!(bits, [3, 3, 3, 3, 1, 1], "EN and EW; EN");
        assert_eq!((owner.view(BlockId(5)).position, owner.view(BlockId(6)).position), (1, 2));
        let link = owner.open[2].0;
        owner.connected(link);
        owner.answer_register(link);
        if connected {
            owner.accept_open(link);
        }
        assert_eq!(owner.view(BlockId(5)).phase, Phase::Waiting, "a message that is out holds its buffer");
        owner.succeed(link, &[3]);
        let phases = [5, 6].map(|n| owner.view(BlockId(n)).phase);
        assert_eq!(phases, [Phase::Connecting, Phase::Waiting], "first come, first served");
    }
}

#[test]
fn messages_to_one_target_go_one_at_a_time_in_order_whatever_their_routes() {
    for connected in [false, true] {
        let mut owner = running(connected, |n| format!("4,10.0.0.1,1,{n}"), 4);
        let link = owner.register();
        for n in 1..=4_u8 {
            if connected {
                owner.accept_open(link);
            }
            let phases: Vec<_> = (1..=4).map(|n| owner.view(BlockId(n)).phase).collect();
            assert_eq!(phases.iter().filter(|phase| **phase == Phase::Sent).count(), 1);
            assert_eq!(phases[usize::from(n) - 1], Phase::Sent);
            let message = cipdeck_shared::wire::MessageRouterReply::success(
                cipdeck_shared::wire::ServiceCode::GetAttributeSingle,
                &[],
            );
            let message = cipdeck_shared::wire::MessageRouterReply { data: &[n], ..message };
            let frame = owner.answer_frame(link, &message);
            owner.input(link, &frame);
            assert_eq!(owner.view(BlockId(n.into())).res_data, [n]);
        }
    }
}

#[test]
fn a_slow_target_with_a_full_queue_lets_nobody_else_in_until_it_times_out() {
    let mut owner = running(true, |n| format!("4,10.0.0.1,1,{n}"), 4);
    owner.put_connected(BlockId(5), "4,10.0.0.5", |config| config.target_cfg.ucmm_timeout = 2_000);
    owner.run(BlockId(5)).unwrap();
    owner.put_connected(BlockId(9), "4,10.0.0.9", |config| config.channel = Channel::Monitor);
    owner.run(BlockId(9)).unwrap();
    assert_eq!(owner.view(BlockId(5)).phase, Phase::Waiting);
    assert_eq!(owner.view(BlockId(9)).phase, Phase::Connecting, "the monitor has its own buffers");
    owner.pass(3_000_000);
    let ids: Vec<_> = (1..=5).map(|n| owner.ids(BlockId(n))).collect();
    assert_eq!(ids, [(55, 113, 10), (55, 113, 10), (55, 113, 10), (55, 113, 10), (55, 112, 8)]);
}

#[test]
fn cancelling_the_message_that_opens_the_connection_lets_the_next_one_open_it() {
    let mut owner = running(true, |_| "4,10.0.0.1".to_owned(), 2);
    owner.register();
    owner.cancel(BlockId(1));
    let link = owner.register_and_open();
    owner.succeed(link, &[2]);
    assert_eq!(owner.view(BlockId(2)).res_data, [2]);
    assert_eq!(owner.trace(), ["register", "open", "register", "close", "open", "connected"]);
}
