//! A relay that is killed leaves connections at its targets, but not for long.

use std::time::{Duration, Instant};

use cipdeck_tests::PATIENCE;
use cipdeck_tests::block;
use cipdeck_tests::command::Service;
use cipdeck_tests::measure::measured;
use cipdeck_tests::rest::Rest;
use cipdeck_tests::wait::eventually_every;
use serde_json::json;
use tempfile::TempDir;

/// How long a target may keep what nobody closes.
const FREED_WITHIN: Duration = Duration::from_secs(20);

#[tokio::test]
async fn a_killed_relay_keeps_a_connection_for_20_s_at_most_and_new_runs_say_so() {
    let device = Service::simulate("127.0.0.1:0", &["--max-connections", "1"]).await;
    let folder = TempDir::new().expect("a temporary folder");
    let mut relay = Service::serve("127.0.0.1:0", folder.path()).await;
    let rest = Rest::new(&relay.address);
    let path = format!("4,{}", device.address);
    let connected = rest.create(&block::connected(block::product_name(&path))).await;
    let unconnected = rest.create(&block::product_name(&path)).await;
    assert_eq!(rest.run(&connected).await["Q"], true);

    relay.process.kill();
    relay.process.ended(PATIENCE).await;
    let killed = Instant::now();
    let relay = Service::serve("127.0.0.1:0", folder.path()).await;
    let rest = Rest::new(&relay.address);
    assert_eq!(rest.run(&unconnected).await["Q"], true, "what needs no connection works meanwhile");
    let mut refused = 0;
    eventually_every(Duration::from_millis(250), "the connection is free again", FREED_WITHIN, async || {
        let status = rest.run(&connected).await;
        if status["Q"] == true {
            return Some(());
        }
        refused += 1;
        let why =
            (&status["Status"]["ErrorID"], &status["Status"]["SubErrorID"], &status["Status"]["ExtErrorID"]);
        assert_eq!(why, (&json!(224), &json!(1), &json!(0x0113)), "it says why not: {status}");
        assert_eq!(status["cause"]["by"], "forward_open", "{status}");
        None
    })
    .await;
    measured(format!("free {:?} after the relay was killed, refused {refused} times", killed.elapsed()));
    assert!(refused > 0, "the device had room for one connection only");
    assert!(killed.elapsed() < FREED_WITHIN);
}
