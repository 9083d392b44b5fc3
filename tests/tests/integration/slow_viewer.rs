//! A viewer that does not read costs nobody anything.

use cipdeck_tests::PATIENCE;
use cipdeck_tests::block::{self, with};
use cipdeck_tests::fake_plc::{self, FakePlc};
use cipdeck_tests::measure::measured;
use cipdeck_tests::relay::Relay;
use cipdeck_tests::viewer::Viewer;
use serde_json::{Value, json};

const BLOCKS: usize = 80;
/// Enough for the buffers of the operating system, which hold some MB, to be full long before.
const MESSAGES: u64 = 80;

#[tokio::test]
async fn a_viewer_that_does_not_read_holds_up_nobody_and_then_gets_the_newest_state() {
    let relay = Relay::start().await;
    let plc = FakePlc::start(fake_plc::answering(&[7; 490])).await;
    let cyclic = with(block::product_name(&plc.path()), "/CtrlCfg", json!({ "TriggerType": 100 }));
    let cyclic = with(cyclic, "/Channel", "monitor");
    let mut ids = Vec::new();
    for _ in 0..BLOCKS {
        ids.push(relay.rest.create(&cyclic).await);
    }
    let mut slow = relay.viewer().await;
    let mut fast = relay.viewer().await;
    for id in &ids {
        fast.set_in(id, true).await;
    }
    let enough = |viewer: &mut Viewer| (viewer.seq >= MESSAGES).then_some(());
    fast.wait_until("the other viewer sees changes all the time", PATIENCE, enough).await;
    for id in &ids {
        fast.set_in(id, false).await;
    }
    for id in &ids {
        fast.status_where("it has ended", PATIENCE, id, ended).await;
    }
    for id in &ids {
        let runs = &fast.statuses[id]["runs"];
        slow.status_where("the newest state", PATIENCE, id, |status| {
            ended(status) && status["runs"] == *runs
        })
        .await;
    }
    measured(format!("a viewer that did not read got {} messages, another one {}", slow.seq, fast.seq));
    assert!(slow.seq < fast.seq, "what nobody reads is not kept");
}

fn ended(status: &Value) -> bool {
    status["IN"] == false && status["Status"]["StatusBits"] == 16
}
