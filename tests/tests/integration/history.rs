//! What has happened stays known: listed, summed up, exported, and not lost by `kill -9`.

use std::time::{Duration, Instant};

use cipdeck_relay::simulate;
use cipdeck_shared::sim::SimConfig;
use cipdeck_tests::PATIENCE;
use cipdeck_tests::block::{self, with};
use cipdeck_tests::command::Service;
use cipdeck_tests::measure::measured;
use cipdeck_tests::relay::Relay;
use cipdeck_tests::rest::Rest;
use cipdeck_tests::wait::{eventually, eventually_every};
use serde_json::{Value, json};
use tempfile::TempDir;
use tokio::net::TcpListener;

/// Runs of a block that the history knows, when there are so many.
async fn runs(rest: &Rest, question: &str, count: usize) -> Vec<Value> {
    eventually("the runs are in the history", PATIENCE, async || {
        let page = rest.get(&format!("history?{question}")).await;
        assert_eq!(page.status, 200, "{page:?}");
        page.body["runs"].as_array().filter(|runs| runs.len() == count).cloned()
    })
    .await
}

#[tokio::test]
async fn every_run_is_listed_with_what_it_said_and_survives_the_relay() {
    let relay = Relay::start().await;
    let name = relay.rest.create(&block::product_name("0,0")).await;
    let refused = relay.rest.create(&block::get("0,0", 0x6F, 1, 1)).await;
    for _ in 0..3 {
        assert_eq!(relay.rest.run(&name).await["Q"], true);
    }
    let status = relay.rest.run(&refused).await;
    assert_eq!(status["Q"], false);

    let all = runs(&relay.rest, "", 4).await;
    assert_eq!(all[0]["block"], json!(refused), "the newest is first");
    for member in ["ErrorID", "SubErrorID", "ExtErrorID"] {
        assert_eq!(all[0][member], status["Status"][member], "{member}");
    }
    assert_eq!(
        (&all[0]["cause"], &all[0]["elapsed_us"]),
        (&json!("refused_by_device"), &status["elapsed_us"])
    );
    let ok = runs(&relay.rest, &format!("block={name}&result=ok"), 3).await;
    assert_eq!(ok[0]["values"][0]["name"], "product name");
    assert_eq!(ok[0]["request"], "0e03200124013007");
    assert!(ok[0]["response"].as_str().is_some_and(|response| response.starts_with("8e000000")), "{}", ok[0]);
    runs(&relay.rest, &format!("block={name}&result=failed"), 0).await;

    let first = relay.rest.get("history?limit=3").await.body;
    let next = first["next"].as_str().expect("there is one more");
    let second = relay.rest.get(&format!("history?limit=3&before={next}")).await.body;
    assert_eq!((second["runs"].as_array().map(Vec::len), &second["next"]), (Some(1), &Value::Null));

    let folder = relay.stop().await;
    let relay = Relay::start_in(folder).await;
    assert_eq!(runs(&relay.rest, "", 4).await, all, "the same after a restart");
    let state = relay.rest.get("history/state").await.body;
    assert_eq!((&state["enabled"], &state["runs"], &state["dropped"]), (&json!(true), &json!(4), &json!([])));
    assert_eq!(relay.rest.get("health").await.body["history"], json!({ "recording": true, "lost": 0 }));
}

#[tokio::test]
async fn a_trend_and_a_file_say_the_same_as_the_list() {
    let relay = Relay::start().await;
    let id = relay.rest.create(&block::get("0,0", 1, 1, 1)).await;
    for _ in 0..5 {
        relay.rest.run(&id).await;
    }
    let listed = runs(&relay.rest, &format!("block={id}"), 5).await;
    let trend = relay.rest.get(&format!("history/trend?block={id}&points=10")).await.body;
    let count: u64 =
        trend["buckets"].as_array().into_iter().flatten().filter_map(|one| one["runs"].as_u64()).sum();
    assert_eq!(
        (count, &trend["value"], &trend["complete"]),
        (5, &json!("vendor id"), &json!(true)),
        "{trend}"
    );
    let bucket = &trend["buckets"][0];
    assert_eq!(bucket["value"]["max"], listed[0]["values"][0]["number"], "{bucket}");
    assert!(bucket["reply_us"]["min"].as_f64() <= bucket["reply_us"]["max"].as_f64(), "{bucket}");

    let file = relay.rest.get(&format!("history.csv?block={id}")).await;
    assert_eq!((file.status, file.content_type.as_str()), (200, "text/csv; charset=utf-8; header=present"));
    let text = file.body.as_str().expect("text").to_owned();
    let lines: Vec<&str> = text.split("\r\n").collect();
    assert_eq!((lines.len(), lines[6]), (7, ""), "a header, five runs, and the end of the last line: {text}");
    assert!(lines[0].starts_with("at,block,result,ErrorID"), "{text}");
    for (line, run) in lines[1..6].iter().zip(&listed) {
        assert!(
            line.starts_with(&format!("{},{id},ok,0,0,0,", run["at"].as_str().expect("a time"))),
            "{line}"
        );
    }
}

#[tokio::test]
async fn what_cannot_be_asked_is_said_in_words() {
    let relay = Relay::start().await;
    for (path, named) in [
        ("history?block=7", "b7"),
        ("history?from=yesterday", "yesterday"),
        ("history?from=2026-11-22T10:00:00Z&to=2026-11-22T10:00:00Z", "earlier"),
        ("history?result=bad", "ok, failed or all"),
        ("history?limit=1001", "1000"),
        ("history?limit=0", "limit"),
        ("history?before=1.2.3", "next"),
        ("history?blok=b7", "blok"),
        ("history?points=7", "points"),
        ("history?block=b1&block=b2", "duplicate"),
        ("history/trend", "block"),
        ("history/trend?block=b7&points=2001", "2000"),
        ("history/state?block=b7", "none"),
        ("history.csv?limit=7", "limit"),
    ] {
        let reply = relay.rest.get(path).await;
        reply.is_problem(400, "unreadable");
        assert!(
            reply.body["detail"].as_str().is_some_and(|detail| detail.contains(named)),
            "{path}: {reply:?}"
        );
    }
    assert_eq!(relay.rest.get("history?block=b7&from=&to=&result=all&limit=&before=").await.status, 200);
}

/// How many targets answer at once, so that over 1,000 runs end in a second.
const TARGETS: usize = 8;

/// What `kill -9` may cost.
const LOST: Duration = Duration::from_secs(1);

#[tokio::test]
async fn a_kill_costs_the_last_second_of_history_at_most_and_no_block() {
    let folder = TempDir::new().expect("a temporary folder");
    let mut relay = Service::serve("127.0.0.1:0", folder.path()).await;
    let rest = Rest::new(&relay.address);
    let mut ids = Vec::new();
    for _ in 0..TARGETS {
        let listener = TcpListener::bind(("127.0.0.1", 0)).await.expect("a free port");
        let path = format!("4,{}", listener.local_addr().expect("the port that is bound"));
        tokio::spawn(simulate(listener, SimConfig::default()));
        let fast = with(block::product_name(&path), "/CtrlCfg", json!({ "TriggerType": 1 }));
        ids.push(rest.create(&with(fast, "/Channel", "monitor")).await);
    }
    for id in &ids {
        assert_eq!(rest.post(&format!("blocks/{id}/in"), &json!({ "IN": true })).await.status, 200);
    }
    let blocks = rest.get("blocks").await.body;
    let counts = async || {
        let mut all = Vec::new();
        for id in &ids {
            all.push(rest.get(&format!("blocks/{id}/status")).await.body["runs"].as_u64().unwrap_or(0));
        }
        all
    };
    // What had ended when, for longer than what may be lost.
    let mut samples = Vec::new();
    eventually_every(Duration::from_millis(50), "enough runs", PATIENCE, async || {
        samples.push((counts().await, Instant::now()));
        let (first, last) = (samples.first()?.1, samples.last()?.1);
        (last - first > 2 * LOST).then_some(())
    })
    .await;
    relay.process.kill();
    let killed = Instant::now();
    relay.process.ended(PATIENCE).await;

    let (before, at) = samples.iter().rfind(|(_, at)| killed - *at >= LOST).expect("older samples");
    let (last, end) = samples.last().expect("samples");
    let during: u64 = last.iter().zip(before).map(|(last, before)| last - before).sum();
    let per_second = u128::from(during) * 1_000 / (*end - *at).as_millis().max(1);
    let relay = Service::serve("127.0.0.1:0", folder.path()).await;
    let rest = Rest::new(&relay.address);
    assert_eq!(rest.get("blocks").await.body, blocks, "no block is lost");
    let mut missing = 0;
    for ((id, before), last) in ids.iter().zip(before).zip(last) {
        let trend = rest.get(&format!("history/trend?block={id}&points=1")).await.body;
        let buckets = trend["buckets"].as_array().cloned().unwrap_or_default();
        let kept: u64 = buckets.iter().filter_map(|bucket| bucket["runs"].as_u64()).sum();
        assert!(kept >= *before, "{id}: {kept} of {before} that ended a second before the kill");
        missing += last.saturating_sub(kept);
    }
    measured(format!("{per_second} runs/s when it was killed; {missing} of the last {during} are missing"));
    assert!(per_second >= 1_000, "not fast enough to mean something: {per_second} runs/s");
    assert_eq!(rest.get("history/state").await.body["dropped"], json!([]));
}

#[tokio::test]
async fn a_full_disk_costs_history_and_no_run_and_it_goes_on_when_there_is_room() {
    let folder = TempDir::new().expect("a temporary folder");
    let relay = Service::serve_with_limits("127.0.0.1:0", folder.path()).await;
    let rest = Rest::new(&relay.address);
    let cyclic = with(block::product_name("0,0"), "/CtrlCfg", json!({ "TriggerType": 5 }));
    let cyclic = rest.create(&cyclic).await;
    let other = rest.create(&block::product_name("0,0")).await;
    assert_eq!(rest.post(&format!("blocks/{cyclic}/in"), &json!({ "IN": true })).await.status, 200);
    let health = async || rest.get("health").await.body["history"].clone();
    let state = async || rest.get("history/state").await.body;
    eventually("history is written", PATIENCE, async || {
        state().await["runs"].as_u64().filter(|runs| *runs > 0)
    })
    .await;

    // No file may become bigger than the history's log is now.
    let log =
        std::fs::metadata(folder.path().join("history.sqlite-wal")).expect("the log of the history").len();
    relay.process.limit_files(Some(log));
    let bad = eventually("it is said", PATIENCE, async || {
        let health = health().await;
        (health["recording"] == false && health["lost"].as_u64() > Some(0)).then_some(health)
    })
    .await;
    let kept = state().await;
    assert!(kept["problem"].is_string(), "{kept}");
    assert_eq!(kept["dropped"][0]["why"], "disk", "{kept}");
    assert_eq!(rest.run(&other).await["Q"], true, "runs go on");
    let runs = async || rest.get(&format!("blocks/{cyclic}/status")).await.body["runs"].as_u64();
    let before = runs().await;
    eventually("cyclic runs go on", PATIENCE, async || runs().await.filter(|now| Some(*now) > before)).await;

    relay.process.limit_files(None);
    eventually("history goes on", PATIENCE, async || (health().await["recording"] == true).then_some(()))
        .await;
    let after = eventually("runs are kept again", PATIENCE, async || {
        let state = state().await;
        (state["runs"].as_u64() > kept["runs"].as_u64()).then_some(state)
    })
    .await;
    assert_eq!(after["problem"], Value::Null);
    let [dropped] = after["dropped"].as_array().expect("a list").as_slice() else { panic!("{after}") };
    assert_eq!(
        (&dropped["why"], &dropped["runs"]),
        (&json!("disk"), &health().await["lost"]),
        "{dropped} {bad}"
    );
}
