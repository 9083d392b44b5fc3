//! SEND_REQ and DATA_EXCH against our simulated device and the adapter of ciplink: the four words and Received_Data over
//! REST, WebSocket and the command line.

use std::fs;

use cipdeck_tests::PATIENCE;
use cipdeck_tests::block::{self, with};
use cipdeck_tests::command::{Ended, Service, cipdeck};
use cipdeck_tests::fake_plc::{Act, FakePlc, messages, success};
use cipdeck_tests::peers::CiplinkAdapter;
use cipdeck_tests::relay::Relay;
use serde_json::{Value, json};
use tempfile::TempDir;

/// Get_Attribute_Single of Identity 1/1/7.
const PRODUCT_NAME: &str = "0000 030E 0120 0124 0730";

/// The same of class 238, which no device here has.
const NOBODY: &str = "0000 030E EE20 0124 0730";

#[tokio::test]
async fn the_product_name_is_read_with_the_words_of_the_manual() {
    let device = Service::simulate("127.0.0.1:0", &[]).await;
    let adapter = CiplinkAdapter::start();
    let relay = Relay::start().await;
    let mut viewer = relay.viewer().await;
    for (address, name) in [
        (device.address.clone(), "cipdeck demo drive"),
        (adapter.address().to_string(), CiplinkAdapter::PRODUCT_NAME),
    ] {
        let id = relay.rest.create(&block::send_req(&address, PRODUCT_NAME)).await;
        let fresh = relay.rest.get(&format!("blocks/{id}/status")).await.body;
        assert_eq!(
            fresh["words"],
            json!({"Management_Param": [0, 0, 30, 10], "Received_Data": "", "ENO": false})
        );

        let status = relay.rest.run(&id).await;
        let reply = [&[0x8E, 0, 0, 0], &short_string(name)[..]].concat();
        assert_eq!(status["Q"], true, "{status}");
        assert_eq!(status["request"], "0e03200124013007", "the message type is no part of the message");
        assert_eq!(status["ResData"], block::short_string(name));
        let words = &status["words"];
        assert_eq!(words["Management_Param"], json!([0x0100, 0, 30, reply.len()]), "{words}");
        assert_eq!((&words["Received_Data"], &words["ENO"]), (&json!(words_of(&reply)), &json!(true)));

        let again = viewer.run(&id).await;
        assert_eq!(again["words"]["Management_Param"], json!([0x0200, 0, 30, reply.len()]), "{again}");
        let stored = relay.rest.get(&format!("blocks/{id}/status")).await.body;
        assert_eq!(stored["words"]["ENO"], false, "EN has fallen");
        assert_eq!(stored["words"]["Received_Data"], json!(words_of(&reply)));
    }
}

#[tokio::test]
async fn the_activity_bit_is_seen_up_and_down() {
    let plc =
        FakePlc::start(messages(|request| vec![Act::Hold, Act::Send(request.success(b"\x02PV"))])).await;
    let relay = Relay::start().await;
    let mut viewer = relay.viewer().await;
    let id = relay.rest.create(&block::send_req(&plc.address().to_string(), PRODUCT_NAME)).await;
    let run = viewer.submit(json!({ "type": "run", "block": id })).await;
    let sent =
        viewer.status_where("the request is sent", PATIENCE, &id, |status| status["phase"] == "sent").await;
    assert_eq!(
        sent["words"],
        json!({"Management_Param": [0x0101, 0, 30, 10], "Received_Data": "", "ENO": true})
    );
    plc.release();
    let answer = viewer.answer(&run).await;
    assert_eq!(answer["status"]["words"]["Management_Param"], json!([0x0100, 0, 30, 7]));
    let idle = |status: &Value| status["words"]["ENO"] == false;
    let ended = viewer.status_where("EN falls", PATIENCE, &id, idle).await;
    assert_eq!(ended["words"]["Received_Data"], "008E 0000 5002 0056", "{ended}");
}

#[tokio::test]
async fn a_class_that_is_not_there_is_report_0_and_no_success() {
    let device = Service::simulate("127.0.0.1:0", &[]).await;
    let adapter = CiplinkAdapter::start();
    let relay = Relay::start().await;
    for address in [device.address.clone(), adapter.address().to_string()] {
        let id = relay.rest.create(&block::send_req(&address, NOBODY)).await;
        let status = relay.rest.run(&id).await;
        assert_eq!((&status["Q"], &status["Status"]["Error"]), (&json!(false), &json!(true)), "{status}");
        assert_eq!(status["cause"]["what"], "refused_by_device");
        let words = &status["words"];
        assert_eq!(words["Management_Param"][1], 0, "the exchange itself was correct");
        let received = words["Received_Data"].as_str().expect("words");
        let general = status["Status"]["SubErrorID"].as_u64().expect("a general status");
        assert!(received.starts_with("008E ") && general != 0, "{status}");
        assert_eq!(&received[7..9], format!("{general:02X}"), "the low byte of word 1: {received}");
        assert_eq!(words["Management_Param"][3], 2 * received.split(' ').count());
    }
}

#[tokio::test]
async fn message_type_1_and_con_are_class_3_connections() {
    let device = Service::simulate("127.0.0.1:0", &[]).await;
    let adapter = CiplinkAdapter::start();
    let relay = Relay::start().await;
    for (address, name) in [
        (device.address.clone(), "cipdeck demo drive"),
        (adapter.address().to_string(), CiplinkAdapter::PRODUCT_NAME),
    ] {
        let typed = block::send_req(&address, "0001 030E 0120 0124 0730");
        let addressed = block::data_exch(&address, "CON", "030E 0120 0124 0730");
        for block in [typed, addressed] {
            let id = relay.rest.create(&block).await;
            for _ in 0..3 {
                let status = relay.rest.run(&id).await;
                assert_eq!(status["ResData"], block::short_string(name), "{status}");
            }
        }
        let targets = relay.rest.get("targets").await.body;
        let target = targets.as_array().expect("targets").iter().find(|target| target["target"] == address);
        let connections = &target.expect("the target")["connections"];
        assert_eq!((connections.as_array().map(Vec::len), &connections[0]["requests"]), (Some(1), &json!(6)));
    }
}

#[tokio::test]
async fn a_tsx_etc_101_finds_its_device_in_the_words() {
    // It asks at 44818 and nowhere else: an address of this process, so that nobody else is there.
    let [high, low] = [std::process::id() >> 8 & 0xFF, std::process::id() & 0xFF];
    let ip = [127, 1 + high % 250, low, 3];
    let [a, b, c, d] = ip;
    let device = Service::simulate(&format!("{a}.{b}.{c}.{d}:44818"), &[]).await;
    let folder = TempDir::new().expect("a temporary folder");
    let listed = format!("{a}.{b}.{c}.{d}:* via *");
    let relay = Relay::start_with(folder, |settings| settings.allowing(&listed)).await;
    let words = format!("0000 {a:02X}{b:02X} {c:02X}{d:02X} 024E 4420 0124 0000 000A");
    let id = relay.rest.create(&block::send_req_etc101(&words)).await;
    let status = relay.rest.run(&id).await;
    assert_eq!(
        (&status["Q"], &status["request"]),
        (&json!(true), &json!("4e02204424010000".to_owned() + "0a00")),
        "{status}"
    );
    let registers = "00CE 0000 0000 0001 0002 0003 0004 0005 0006 0007 0008 0009";
    assert_eq!(
        status["words"],
        json!({"Management_Param": [0x0100, 0, 30, 24], "Received_Data": registers, "ENO": true})
    );
    drop(device);
    let nobody = relay.rest.run(&id).await;
    let reports = nobody["words"]["Management_Param"][1].as_u64();
    assert!(matches!(reports, Some(0x13FF | 0x0AFF)), "refused, or reset while its process ends: {nobody}");
}

#[tokio::test]
async fn data_exch_reads_and_writes_registers() {
    let device = Service::simulate("127.0.0.1:0", &[]).await;
    let relay = Relay::start().await;
    let read = block::data_exch(&device.address, "UNC", "024E 4420 0124 0005 0003");
    let read = relay.rest.create(&read).await;
    assert_eq!(received(&relay.rest.run(&read).await), "00CE 0000 0005 0006 0007");

    let write = block::data_exch(&device.address, "UNC", "0250 4420 0124 0006 0001 1234");
    let write = relay.rest.create(&write).await;
    let unasked = relay.rest.post(&format!("blocks/{write}/run"), &json!({})).await;
    unasked.is_problem(403, "not_permitted");
    let opened = relay.rest.post("window", &json!({})).await;
    assert_eq!(opened.status, 200, "{opened:?}");
    let offer = relay.rest.post(&format!("blocks/{write}/write"), &json!({ "revision": 1 })).await.body;
    assert_eq!((&offer["old"]["data"], &offer["new"]["data"]), (&json!("0600"), &json!("3412")), "{offer}");
    let ticket = &offer["ticket"];
    let written = relay.rest.post(&format!("blocks/{write}/run"), &json!({ "ticket": ticket })).await.body;
    assert_eq!(received(&written), "00D0 0000", "{written}");
    let back = &written["written"];
    assert_eq!((&back["read_back"]["data"], &back["is_equal"]), (&json!("3412"), &json!(true)), "{written}");
    assert_eq!(received(&relay.rest.run(&read).await), "00CE 0000 0005 1234 0007");
}

#[tokio::test]
async fn what_goes_wrong_is_told_in_the_reports() {
    let relay = Relay::start().await;
    let silent = FakePlc::start(messages(|_| Vec::new())).await;
    let hangs_up = FakePlc::start(messages(|_| vec![Act::Close])).await;
    let talkative =
        FakePlc::start(messages(|request| vec![Act::Send(request.reply(&success(0x0E, &[7; 9])))])).await;
    let nobody = {
        let gone = FakePlc::start(messages(|_| Vec::new())).await;
        gone.address().to_string()
    };
    let etc100 = |address: &str| with(block::send_req(address, PRODUCT_NAME), "/Received_Data_Size", 6);
    let exchange = |address: &str| {
        with(block::data_exch(address, "UNC", "030E 0120 0124 0730"), "/Received_Data_Size", 6)
    };
    for (address, report_etc100, report_exchange, cause) in [
        (silent.address().to_string(), 0x0001, 0x0001, "timeout"),
        (hangs_up.address().to_string(), 0x04FF, 0x0AFF, "closed"),
        (talkative.address().to_string(), 0x0009, 0x0009, "too_small"),
        (nobody, 0x03FF, 0x13FF, "refused"),
    ] {
        for (block, report) in [(etc100(&address), report_etc100), (exchange(&address), report_exchange)] {
            let id = relay.rest.create(&management(block, 2, 2)).await;
            let status = relay.rest.run(&id).await;
            assert_eq!(status["cause"]["what"], cause, "{status}");
            let words = &status["words"];
            assert_eq!(words["Management_Param"], json!([0x0100, report, 2, 0]), "{cause}: {words}");
            assert_eq!((&words["Received_Data"], &status["Q"]), (&json!(""), &json!(false)), "{cause}");
        }
    }
}

#[tokio::test]
async fn a_cancelled_exchange_that_would_wait_for_ever_is_report_2() {
    let plc = FakePlc::start(messages(|_| vec![Act::Hold])).await;
    let relay = Relay::start().await;
    let mut viewer = relay.viewer().await;
    let patient = management(block::send_req(&plc.address().to_string(), PRODUCT_NAME), 2, 0);
    let id = relay.rest.create(&patient).await;
    let run = viewer.submit(json!({ "type": "run", "block": id })).await;
    viewer.status_where("the request is sent", PATIENCE, &id, |status| status["phase"] == "sent").await;
    viewer.cancel(&id).await;
    let answer = viewer.answer(&run).await;
    let words = &answer["status"]["words"];
    assert_eq!(words["Management_Param"], json!([0x0100, 0x0002, 0, 0]), "{answer}");
}

#[tokio::test]
async fn what_cannot_be_sent_is_a_finding_with_the_report_of_the_controller() {
    let relay = Relay::start().await;
    let good = block::send_req("192.168.1.102", PRODUCT_NAME);
    for (pointer, value, field, report) in [
        ("/Address", json!("ADDR('0.2.0')"), "Address", 3),
        ("/Management_Param", json!([0, 0, 30]), "Management_Param", 5),
        ("/Request_Code", json!(80), "Request_Code", 6),
        ("/Data_to_Send", json!("0000 3E"), "Data_to_Send", 6),
        ("/Management_Param", json!([0, 0, 30, 11]), "Management_Param[3]", 14),
    ] {
        let reply = relay.rest.post("blocks", &with(good.clone(), pointer, value)).await;
        reply.is_problem(422, "findings");
        let findings = reply.body["findings"].as_array().cloned().unwrap_or_default();
        let finding = findings.iter().find(|finding| finding["field"] == field).expect("a finding");
        assert_eq!(finding["Communication_Report"], report, "{finding}");
    }
    let reply = relay.rest.post("check", &management(good, 2, 0)).await.body;
    assert_eq!(reply["findings"][0]["rule"], "waits_for_ever", "{reply}");
    assert_eq!(reply["request"], "0e03200124013007");
}

#[tokio::test]
async fn the_command_line_shows_the_words_and_the_name() {
    let device = Service::simulate("127.0.0.1:0", &[]).await;
    let ended = run_file(&block::send_req(&device.address, PRODUCT_NAME), &[]).await;
    assert_eq!(ended.code, 0, "{ended:?}");
    for part in [
        "SEND_REQ for TSX ETC 100",
        "cipdeck demo drive",
        "0100 0000 001E 0017",
        "Exchange correct",
        "008E 0000",
    ] {
        assert!(ended.stdout.contains(part), "{part}: {}", ended.stdout);
    }
    let ended = run_file(&block::send_req(&device.address, PRODUCT_NAME), &["--json"]).await;
    assert_eq!(ended.json()["words"]["Management_Param"], json!([0x0100, 0, 30, 23]));
    let ended = run_file(&block::send_req(&device.address, PRODUCT_NAME), &["--repeat", "3"]).await;
    assert_eq!((ended.code, ended.stdout.lines().count()), (0, 3), "{ended:?}");

    let refused = run_file(&block::send_req(&device.address, NOBODY), &[]).await;
    assert_eq!(refused.code, 3, "{refused:?}");
    assert!(
        refused.stdout.contains("NOT a success") && refused.stdout.contains("0x05"),
        "{}",
        refused.stdout
    );

    let folder = TempDir::new().expect("a temporary folder");
    let file = folder.path().join("block.json");
    fs::write(&file, block::send_req("0.0.0.0", PRODUCT_NAME).to_string()).expect("a file");
    let checked = cipdeck(&["check", file.to_str().expect("a path"), "--json"]).await;
    assert_eq!(checked.json()["request"], "0e03200124013007");
}

/// With another word in `Management_Param`.
fn management(mut block: Value, index: usize, word: i64) -> Value {
    block["Management_Param"][index] = json!(word);
    block
}

async fn run_file(block: &Value, more: &[&str]) -> Ended {
    let folder = TempDir::new().expect("a temporary folder");
    let file = folder.path().join("block.json");
    fs::write(&file, block.to_string()).expect("a file");
    cipdeck(&[&["run", file.to_str().expect("a path")], more].concat()).await
}

fn received(status: &Value) -> String {
    assert_eq!(status["Q"], true, "{status}");
    status["words"]["Received_Data"].as_str().expect("words").to_owned()
}

fn short_string(text: &str) -> Vec<u8> {
    let length = u8::try_from(text.len()).expect("a short name");
    [&[length], text.as_bytes()].concat()
}

/// Low byte first, as Control Expert shows words.
fn words_of(bytes: &[u8]) -> String {
    let words = bytes.chunks(2).map(|pair| format!("{:02X}{:02X}", pair.get(1).unwrap_or(&0), pair[0]));
    words.collect::<Vec<_>>().join(" ")
}
