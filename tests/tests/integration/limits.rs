//! How much runs at the same time.

use cipdeck_tests::PATIENCE;
use cipdeck_tests::block::{self, with};
use cipdeck_tests::fake_plc::{self, Act, FakePlc};
use cipdeck_tests::relay::Relay;
use cipdeck_tests::viewer::Viewer;
use serde_json::{Value, json};

#[tokio::test]
async fn the_controller_has_four_buffers_and_the_fifth_message_waits() {
    let relay = Relay::start().await;
    let mut viewer = relay.viewer().await;
    let mut targets = Vec::new();
    let mut runs = Vec::new();
    for _ in 0..5 {
        let plc =
            FakePlc::start(fake_plc::messages(|request| vec![Act::Hold, Act::Send(request.success(&[1]))]))
                .await;
        let id = relay.rest.create(&block::product_name(&plc.path())).await;
        runs.push((viewer.submit(json!({ "type": "run", "block": id })).await, id));
        targets.push(plc);
    }
    for (_, id) in &runs[..4] {
        phase(&mut viewer, id, "sent", 5).await;
    }
    phase(&mut viewer, &runs[4].1, "waiting", 1).await;
    assert_eq!(viewer.statuses[&runs[4].1]["position"], 1);
    assert_eq!(targets[4].requests().len(), 0, "nothing is sent without a buffer");

    targets[0].release();
    phase(&mut viewer, &runs[4].1, "sent", 5).await;
    for target in &targets[1..] {
        target.release();
    }
    for (run, _) in runs {
        let answer = viewer.answer(&run).await;
        assert_eq!(answer["status"]["Q"], true, "{answer}");
    }
}

#[tokio::test]
async fn the_monitor_channel_does_not_wait_for_the_controllers_buffers() {
    let relay = Relay::start().await;
    let mut viewer = relay.viewer().await;
    let dead = FakePlc::start(fake_plc::messages(|_| vec![])).await;
    for _ in 0..5 {
        let id = relay.rest.create(&block::product_name(&dead.path())).await;
        viewer.submit(json!({ "type": "run", "block": id })).await;
    }
    let good = FakePlc::start(fake_plc::answering(&[1])).await;
    let id = relay.rest.create(&with(block::product_name(&good.path()), "/Channel", "monitor")).await;
    assert_eq!(viewer.run(&id).await["Q"], true);
}

#[tokio::test]
async fn a_target_gets_one_message_at_a_time() {
    let relay = Relay::start().await;
    let mut viewer = relay.viewer().await;
    let plc =
        FakePlc::start(fake_plc::messages(|request| vec![Act::Hold, Act::Send(request.success(&[1]))])).await;
    let mut runs = Vec::new();
    for _ in 0..3 {
        let id = relay.rest.create(&block::product_name(&plc.path())).await;
        runs.push((viewer.submit(json!({ "type": "run", "block": id })).await, id));
    }
    phase(&mut viewer, &runs[0].1, "sent", 5).await;
    for (_, id) in &runs[1..] {
        phase(&mut viewer, id, "buffered", 3).await;
    }
    for (sent, (run, _)) in runs.iter().enumerate() {
        plc.release();
        let answer = viewer.answer(run).await;
        assert_eq!(answer["status"]["Q"], true, "{answer}");
        assert!(plc.messages().len() <= sent + 2, "the next is sent after the answer");
    }
    let connections: Vec<_> = plc.requests().iter().map(|request| request.connection).collect();
    assert_eq!(connections, [1; 4], "one session for all");
}

#[tokio::test]
async fn fifty_blocks_at_fifty_targets_all_run() {
    let relay = Relay::start().await;
    let mut viewer = relay.viewer().await;
    let mut runs = Vec::new();
    let mut targets = Vec::new();
    for number in 0..50_u8 {
        let plc = FakePlc::start(fake_plc::answering(&[number])).await;
        let id = relay.rest.create(&with(block::product_name(&plc.path()), "/Channel", "monitor")).await;
        runs.push((viewer.submit(json!({ "type": "run", "block": id })).await, block::hex(&[number])));
        targets.push(plc);
    }
    for (run, data) in runs {
        let answer = viewer.answer(&run).await;
        assert_eq!(answer["status"]["ResData"], data, "{answer}");
    }
}

async fn phase(viewer: &mut Viewer, id: &str, phase: &str, bits: u64) {
    let reached = |status: &Value| status["phase"] == phase && status["Status"]["StatusBits"] == bits;
    viewer.status_where(&format!("{id} is {phase}"), PATIENCE, id, reached).await;
}
