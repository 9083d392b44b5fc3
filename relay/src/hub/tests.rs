use cipdeck_shared::config::MsgCipGeneric;
use cipdeck_shared::engine::{Phase, StatusBits};

use super::*;
use crate::history::Recorder;

const B1: BlockId = BlockId(1);

fn hub(count: u32) -> Hub {
    let hub = Hub::recording(Recorder::default());
    for id in 1..=count {
        hub.put(Block { id: BlockId(id), revision: 1, config: MsgCipGeneric::product_name("0,0").into() });
    }
    hub
}

/// The block goes through these edges.
fn edges(hub: &Hub, block: BlockId, edges: &[(u64, u16)]) {
    let edges = edges.iter().map(|(at, bits)| (*at, StatusBits(*bits))).collect();
    hub.changed(block, &BlockView { edges, phase: Phase::Sent, ..BlockView::default() });
}

fn succeed(hub: &Hub, block: BlockId, data: u8) {
    let view = BlockView { q: true, res_data: vec![data], ..BlockView::default() };
    hub.changed(block, &view);
    hub.finished(block, &view, &Exchange { request: [data].into(), ..Exchange::default() }, None);
}

#[test]
fn a_viewer_gets_everything_once_and_then_only_the_newest_of_what_changed() {
    let hub = hub(3);
    let mut cursor = Cursor::default();
    let snapshot = hub.update(&mut cursor).unwrap();
    assert!(snapshot.is_snapshot);
    assert_eq!((snapshot.blocks.len(), snapshot.statuses.len()), (3, 3));
    assert_eq!(hub.update(&mut cursor), None);
    for data in 0..100 {
        succeed(&hub, B1, data);
    }
    let changes = hub.update(&mut cursor).unwrap();
    assert!(!changes.is_snapshot);
    assert_eq!((changes.blocks.len(), changes.statuses.len()), (0, 1));
    assert_eq!(changes.statuses[0].res_data, "63");
    assert_eq!(hub.update(&mut cursor), None);
}

#[test]
fn edges_are_told_once_to_each_viewer_and_the_oldest_are_dropped() {
    let hub = hub(1);
    let (mut fast, mut slow) = (Cursor::default(), Cursor::default());
    hub.update(&mut fast);
    hub.update(&mut slow);
    edges(&hub, B1, &[(0, 1), (3, 3)]);
    let seen = |cursor: &mut Cursor| {
        let status = hub.update(cursor).unwrap().statuses.remove(0);
        (status.edges.iter().map(|(at, _)| *at).collect::<Vec<_>>(), status.edges_dropped)
    };
    assert_eq!(seen(&mut fast), (vec![0, 3], 0));
    for at in 10..30 {
        edges(&hub, B1, &[(at, 5)]);
    }
    assert_eq!(seen(&mut slow), ((14..30).collect(), 6));
    assert_eq!(seen(&mut fast), ((14..30).collect(), 4));
    edges(&hub, B1, &[(0, 1), (40, 3)]);
    assert_eq!(seen(&mut slow), (vec![0, 40], 0));
    assert_eq!(seen(&mut Cursor::default()), (vec![0, 40], 0), "a new viewer sees the last message");
}

#[test]
fn a_removal_is_told_and_a_viewer_far_behind_starts_again() {
    let hub = hub(2);
    let (mut near, mut far) = (Cursor::default(), Cursor::default());
    hub.update(&mut near);
    hub.update(&mut far);
    hub.remove(B1);
    let update = hub.update(&mut near).unwrap();
    assert_eq!((update.removed, update.statuses.len()), (vec![B1], 0));
    for id in 10..2_000 {
        hub.put(Block { id: BlockId(id), revision: 1, config: MsgCipGeneric::product_name("0,0").into() });
        hub.remove(BlockId(id));
    }
    let update = hub.update(&mut far).unwrap();
    assert!(update.is_snapshot);
    assert_eq!(update.blocks.len(), 1);
    assert!(lock(&hub.latest).removed.len() <= MAX_REMOVED);
}

#[test]
fn the_last_success_survives_a_failure_and_sixteen_exchanges_are_kept() {
    let hub = hub(1);
    for data in 1..=20 {
        succeed(&hub, B1, data);
    }
    let failed = BlockView { phase: Phase::Failed, ..BlockView::default() };
    hub.changed(B1, &failed);
    let status = hub.finished(B1, &failed, &Exchange::default(), None).unwrap();
    assert_eq!((status.res_data.as_str(), status.last.unwrap().res_data.as_str()), ("", "14"));
    let exchanges = hub.exchanges(B1).unwrap();
    assert_eq!((exchanges.len(), exchanges[0].request.as_str()), (16, "06"));
}

#[test]
fn a_changed_block_is_told_with_its_status() {
    let hub = hub(1);
    let mut cursor = Cursor::default();
    hub.update(&mut cursor);
    hub.put(Block { id: B1, revision: 2, config: MsgCipGeneric::product_name("0,0").into() });
    let update = hub.update(&mut cursor).unwrap();
    assert_eq!((update.blocks[0].revision, update.statuses.len()), (2, 1));
}

#[test]
fn the_last_value_is_read_by_the_blocks_layout() {
    let hub = Hub::recording(Recorder::default());
    let block = |layout: &str| {
        let mut config = MsgCipGeneric::product_name("4,10.0.0.1");
        layout.clone_into(&mut config.res_layout);
        Block { id: BlockId(1), revision: 1, config: config.into() }
    };
    hub.put(block("speed: REAL; run: BOOL"));
    let view = BlockView { q: true, res_data: vec![0, 0, 0x48, 0x42, 1], ..BlockView::default() };
    hub.finished(BlockId(1), &view, &Exchange::default(), None);
    let texts = || {
        let status = hub.update(&mut Cursor::default()).unwrap().statuses.remove(0);
        let decoded = status.last.unwrap().decoded;
        decoded.iter().map(|value| format!("{} {}", value.name, value.text)).collect::<Vec<_>>()
    };
    assert_eq!(texts(), ["speed 50", "run TRUE"]);
    hub.put(block("a: UINT; b: UINT; c: USINT"));
    assert_eq!(texts(), ["a 0", "b 16968", "c 1"], "another layout reads the same bytes");
}
