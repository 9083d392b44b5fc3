//! The command line against targets that nobody here wrote, and against our own simulated device.

use cipdeck_tests::block;
use cipdeck_tests::command::{Ended, Service, cipdeck};
use cipdeck_tests::peers::{CiplinkAdapter, Cpppo};
use serde_json::{Value, json};

#[tokio::test]
async fn send_reads_the_product_name_of_the_simulated_device() {
    let device = Service::simulate("127.0.0.1:0", &[]).await;
    let ended = get(&format!("4,{}", device.address), 1, 7).await;
    assert_eq!(ended.code, 0, "{ended:?}");
    let status = ended.json();
    assert_eq!((&status["Q"], &status["Status"]["StatusBits"]), (&json!(true), &json!(17)), "{status}");
    assert_eq!(status["request"], "0e03200124013007");
    let data = status["ResData"].as_str().expect("data");
    assert_eq!(status["response"], format!("8e000000{data}"));
    let name = &status["decoded"][0];
    assert_eq!(
        (&name["from"], &name["type"], &name["guess"]),
        (&json!(0), &json!("SHORT_STRING"), &Value::Null)
    );
    let text = name["text"].as_str().expect("a name").trim_matches(['"', '\'']);
    assert_eq!(data, block::short_string(text), "the text is what the bytes say");
}

#[tokio::test]
async fn the_exit_code_says_what_kind_of_failure_it_was() {
    let device = Service::simulate("127.0.0.1:0", &[]).await;
    let path = format!("4,{}", device.address);
    let refused = get(&path, 238, 1).await;
    assert_eq!((refused.code, ids(&refused)), (3, (224, 5)), "{refused:?}");

    drop(device);
    let nobody = get(&path, 1, 7).await;
    assert_eq!((nobody.code, ids(&nobody)), (4, (210, 0)), "{nobody:?}");
    assert_eq!(nobody.json()["cause"]["what"], "refused");

    let wrong = cipdeck(&["send", &path, "--service", "300", "--class", "1", "--instance", "1"]).await;
    assert_eq!(wrong.code, 2, "{wrong:?}");
    assert!(wrong.stderr.contains('1') && wrong.stderr.contains("127"), "the range: {}", wrong.stderr);

    let usage = cipdeck(&["send"]).await;
    assert_eq!(usage.code, 2, "{usage:?}");
}

#[tokio::test]
async fn every_fault_of_the_simulated_device_has_its_cause() {
    for (fault, code, cause) in [
        ("drop", 4, "timeout"),
        ("half-frame", 4, "timeout"),
        ("wrong-context", 4, "timeout"),
        ("wrong-session", 4, "timeout"),
        ("wrong-service", 4, "malformed"),
        ("garbage", 4, "malformed"),
        ("close", 4, "closed"),
        ("status=8", 4, "encapsulation_status"),
        ("error=5", 3, "refused_by_device"),
        ("ok", 0, ""),
    ] {
        let device = Service::simulate("127.0.0.1:0", &["--fault", fault]).await;
        let ended = send(&format!("4,{}", device.address), 1, 7, &["--json", "--timeout", "250"]).await;
        let what = &ended.json()["cause"]["what"];
        assert_eq!((ended.code, what.as_str().unwrap_or_default()), (code, cause), "{fault}: {ended:?}");
    }
}

#[tokio::test]
async fn send_talks_to_cpppo() {
    let cpppo = Cpppo::start().await;
    let name = get(&cpppo.path(), 1, 7).await;
    assert_eq!(name.code, 0, "{name:?}");
    assert!(
        name.json()["decoded"][0]["text"].as_str().is_some_and(|text| text.contains(Cpppo::PRODUCT_NAME))
    );

    let attribute = get(&cpppo.path(), 1, 99).await;
    assert_eq!((attribute.code, ids(&attribute)), (3, (224, 8)), "{attribute:?}");

    let class = get(&cpppo.path(), 238, 1).await;
    assert_eq!((class.code, ids(&class)), (4, (69, 65)), "{class:?}");
    let cause = &class.json()["cause"];
    assert_eq!((&cause["what"], &cause["status"]), (&json!("encapsulation_status"), &json!(8)), "{cause}");
    let people = send(&cpppo.path(), 238, 1, &[]).await;
    assert!(people.stdout.contains("0x08") || people.stderr.contains("0x08"), "named: {people:?}");
}

#[tokio::test]
async fn send_talks_to_ciplink() {
    let adapter = CiplinkAdapter::start();
    let name = get(&adapter.path(), 1, 7).await;
    assert_eq!(name.code, 0, "{name:?}");
    assert_eq!(name.json()["ResData"], block::short_string(CiplinkAdapter::PRODUCT_NAME));
    let class = get(&adapter.path(), 238, 1).await;
    assert_eq!((class.code, ids(&class)), (3, (224, 5)), "{class:?}");
}

#[tokio::test]
async fn numbers_are_read_in_every_notation_of_the_manuals() {
    let adapter = CiplinkAdapter::start();
    for (service, class, attribute) in
        [("14", "1", "7"), ("0x0E", "0x01", "0x07"), ("0Eh", "1h", "7h"), ("16#0E", "16#1", "16#7")]
    {
        let ended = cipdeck(&[
            "send",
            &adapter.path(),
            "--service",
            service,
            "--class",
            class,
            "--instance",
            "1",
            "--attribute",
            attribute,
        ])
        .await;
        assert_eq!(ended.code, 0, "{service}: {ended:?}");
        assert!(ended.stdout.contains(CiplinkAdapter::PRODUCT_NAME), "{ended:?}");
    }
}

#[tokio::test]
async fn repeat_prints_a_line_per_run_and_goes_on_after_failures() {
    let adapter = CiplinkAdapter::start();
    let ended = send(&adapter.path(), 238, 1, &["--json", "--repeat", "3"]).await;
    assert_eq!(ended.code, 3, "{ended:?}");
    let lines: Vec<Value> =
        ended.stdout.lines().map(|line| serde_json::from_str(line).expect("JSON in every line")).collect();
    assert_eq!(lines.len(), 3, "{ended:?}");
    assert!(lines.iter().all(|line| line["Status"]["SubErrorID"] == 5));
}

#[tokio::test]
async fn check_gives_the_bytes_or_all_findings() {
    let folder = tempfile::TempDir::new().expect("a temporary folder");
    let file = folder.path().join("block.json");
    let name = file.to_str().expect("a path in UTF-8");
    std::fs::write(&file, block::product_name("4,192.0.2.1").to_string()).expect("a file");
    let good = cipdeck(&["check", name, "--json"]).await;
    assert_eq!((good.code, &good.json()["request"]), (0, &json!("0e03200124013007")), "{good:?}");

    let wrong = block::with(block::product_name(""), "/AppCfg/Service", 300);
    std::fs::write(&file, wrong.to_string()).expect("a file");
    let bad = cipdeck(&["check", name, "--json"]).await;
    assert_eq!(bad.code, 2, "{bad:?}");
    let fields: Vec<_> =
        bad.json()["findings"].as_array().into_iter().flatten().map(|one| one["field"].clone()).collect();
    assert!(
        fields.contains(&json!("AppCfg.Service")) && fields.contains(&json!("TargetCfg.Path")),
        "{fields:?}"
    );
}

#[tokio::test]
async fn run_sends_a_block_from_a_file() {
    let adapter = CiplinkAdapter::start();
    let folder = tempfile::TempDir::new().expect("a temporary folder");
    let file = folder.path().join("block.json");
    std::fs::write(&file, block::get(&adapter.path(), 1, 1, 1).to_string()).expect("a file");
    let ended = cipdeck(&["run", file.to_str().expect("a path in UTF-8"), "--json"]).await;
    assert_eq!((ended.code, &ended.json()["ResData"]), (0, &json!("0100")), "{ended:?}");
}

async fn get(path: &str, class: u32, attribute: u32) -> Ended {
    send(path, class, attribute, &["--json"]).await
}

async fn send(path: &str, class: u32, attribute: u32, more: &[&str]) -> Ended {
    let (class, attribute) = (class.to_string(), attribute.to_string());
    let arguments =
        ["send", path, "--service", "14", "--class", &class, "--instance", "1", "--attribute", &attribute];
    cipdeck(&[&arguments, more].concat()).await
}

fn ids(ended: &Ended) -> (u64, u64) {
    let status = &ended.json()["Status"];
    (status["ErrorID"].as_u64().unwrap_or(0), status["SubErrorID"].as_u64().unwrap_or(0))
}
