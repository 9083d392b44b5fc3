//! Devices, groups and variables through the relay: one poll however many look, bad tags, lost devices, writes.

use std::time::Duration;

use cipdeck_tests::PATIENCE;
use cipdeck_tests::command::Service;
use cipdeck_tests::live::LiveViewer;
use cipdeck_tests::relay::Relay;
use cipdeck_tests::rest::Rest;
use cipdeck_tests::wait::eventually;
use futures_util::future::join_all;
use serde_json::{Value, json};

/// A device with one group that is off; the ids of both.
async fn device(rest: &Rest, address: &str, profile: &str, period_ms: u32) -> (String, String) {
    let device = json!({ "name": "device", "path": format!("4,{address}"), "profile": profile });
    let device = made(rest, "devices", &device).await;
    let group = json!({ "device": device["id"], "name": "group", "period_ms": period_ms });
    let group = made(rest, "groups", &group).await;
    (id(&device), id(&group))
}

async fn made(rest: &Rest, path: &str, body: &Value) -> Value {
    let reply = rest.post(path, body).await;
    assert_eq!(reply.status, 201, "{path} {body}: {reply:?}");
    reply.body
}

/// Variables with these addresses as names; their ids.
async fn variables(rest: &Rest, group: &str, addresses: &[&str]) -> Vec<String> {
    let new: Vec<_> = addresses.iter().map(|name| json!({ "name": name, "address": name })).collect();
    let made = made(rest, &format!("groups/{group}/variables"), &json!({ "variables": new })).await;
    made.as_array().expect("variables").iter().map(id).collect()
}

fn id(entry: &Value) -> String {
    entry["id"].as_str().expect("an id").to_owned()
}

async fn turn(rest: &Rest, group: &str, on: bool) {
    let tree = rest.get("devices").await.body;
    let groups = tree["groups"].as_array().expect("groups");
    let mut there = groups.iter().find(|there| there["id"] == group).expect("the group").clone();
    there["on"] = json!(on);
    let reply = rest.put(&format!("groups/{group}"), &there).await;
    assert_eq!(reply.status, 200, "{reply:?}");
}

/// Requests that a simulated device says to have got, when it ends.
async fn requests(mut device: Service) -> u64 {
    device.process.interrupt();
    device.process.ended(PATIENCE).await;
    let counted = |line: &str| line.strip_prefix("unconnected ")?.split(',').next()?.parse().ok();
    device.process.line("it says what it got", PATIENCE, counted).await
}

#[tokio::test]
async fn ten_viewers_cost_the_device_no_more_than_one() {
    let mut counts = Vec::new();
    for viewers in [1, 10] {
        let plc = Service::simulate("127.0.0.1:0", &["--profile", "omron"]).await;
        let relay = Relay::start().await;
        let (_, group) = device(&relay.rest, &plc.address, "omron", 200).await;
        let ids = variables(&relay.rest, &group, &["TAG1", "TAG2", "grHWCs_PV"]).await;
        let mut all = Vec::new();
        for _ in 0..viewers {
            let mut viewer = LiveViewer::connect(relay.address).await;
            viewer.watch(&[&group]).await;
            all.push(viewer);
        }
        turn(&relay.rest, &group, true).await;
        let pv = &ids[2];
        join_all(all.iter_mut().map(|viewer| {
            viewer.until("20 periods", PATIENCE, |it| (it.times.get(pv)?.len() >= 20).then_some(()))
        }))
        .await;
        turn(&relay.rest, &group, false).await;
        relay.stop().await;
        counts.push(requests(plc).await);
    }
    println!("requests in 20 periods: one viewer {}, ten viewers {}", counts[0], counts[1]);
    assert!(counts[0].abs_diff(counts[1]) <= 1, "{counts:?}");
    assert!(counts[0] <= 23, "a request each period, and one for the device's identity: {counts:?}");
}

#[tokio::test]
async fn a_bad_tag_is_said_and_the_others_are_read() {
    let plc = Service::simulate("127.0.0.1:0", &["--profile", "omron"]).await;
    let relay = Relay::start().await;
    let (device, group) = device(&relay.rest, &plc.address, "auto", 100).await;
    let ids = variables(&relay.rest, &group, &["TAG1", "no_such_tag", "grHWCs_PV"]).await;
    let mut viewer = LiveViewer::connect(relay.address).await;
    viewer.watch(&[&group]).await;
    turn(&relay.rest, &group, true).await;
    viewer
        .until("two are good and one is bad", PATIENCE, |viewer| {
            let quality = |place: usize| viewer.values.get(&ids[place])?["quality"].as_str();
            ([quality(0), quality(1), quality(2)] == [Some("good"), Some("bad"), Some("good")]).then_some(())
        })
        .await;
    let bad = &viewer.values[&ids[1]];
    assert!(bad["reason"].as_str().is_some_and(|reason| !reason.is_empty()), "{bad}");
    let status = viewer
        .until("the device is well", PATIENCE, |viewer| {
            let status = viewer.statuses.get(&device)?;
            (status["health"]["state"] == "good" && status["load"]["bad_items"] == 1).then(|| status.clone())
        })
        .await;
    assert_eq!((&status["profile"], &status["load"]["items"]), (&json!("omron"), &json!(3)), "{status}");
    let values = relay.rest.get(&format!("groups/{group}/values")).await.body;
    assert_eq!(values["values"].as_array().map(Vec::len), Some(3), "{values}");
    assert_eq!(values["values"][0]["type"], "BOOL", "{values}");
    relay.stop().await;
}

#[tokio::test]
async fn values_of_a_lost_device_are_stale_with_the_reason_and_come_back_with_it() {
    let plc = Service::simulate("127.0.0.1:0", &["--profile", "logix"]).await;
    let address = plc.address.clone();
    let relay = Relay::start().await;
    let (device, group) = device(&relay.rest, &address, "logix", 100).await;
    let ids = variables(&relay.rest, &group, &["Scalar"]).await;
    let mut viewer = LiveViewer::connect(relay.address).await;
    viewer.watch(&[&group]).await;
    turn(&relay.rest, &group, true).await;
    let quality = |viewer: &LiveViewer, wanted: &str| {
        viewer.values.get(&ids[0]).filter(|value| value["quality"] == wanted).cloned()
    };
    viewer.until("it is good", PATIENCE, |viewer| quality(viewer, "good")).await;
    requests(plc).await;
    let stale = viewer.until("it is stale", PATIENCE, |viewer| quality(viewer, "stale")).await;
    assert!(stale["reason"].as_str().is_some_and(|reason| !reason.is_empty()), "{stale}");
    assert_eq!(stale["type"], "DINT", "the last value is still there: {stale}");
    viewer
        .until("the device is lost", PATIENCE, |viewer| {
            (viewer.statuses.get(&device)?["health"]["state"] == "lost").then_some(())
        })
        .await;
    let _plc = Service::simulate(&address, &["--profile", "logix"]).await;
    viewer.until("it is good again", PATIENCE, |viewer| quality(viewer, "good")).await;
    relay.stop().await;
}

#[tokio::test]
async fn a_device_that_is_not_on_the_list_is_not_asked_and_says_why() {
    let relay = Relay::start().await;
    for profile in ["auto", "omron"] {
        let (device, group) = device(&relay.rest, "192.0.2.1", profile, 100).await;
        let ids = variables(&relay.rest, &group, &["TAG1"]).await;
        let mut viewer = LiveViewer::connect(relay.address).await;
        viewer.watch(&[&group]).await;
        turn(&relay.rest, &group, true).await;
        let words = viewer
            .until("it is denied", PATIENCE, |viewer| {
                let health = &viewer.statuses.get(&device)?["health"];
                (health["state"] == "denied").then(|| health["words"].as_str().unwrap_or_default().to_owned())
            })
            .await;
        assert!(words.contains("192.0.2.1:44818 is not on the list of allowed targets"), "{words}");
        let value = viewer
            .until("its values say so", PATIENCE, |viewer| {
                viewer.values.get(&ids[0]).filter(|value| value["quality"] == "bad").cloned()
            })
            .await;
        assert!(value["reason"].as_str().is_some_and(|reason| reason.contains("not on the list")), "{value}");
    }
    relay.stop().await;
}

#[tokio::test]
async fn a_list_of_variables_with_one_bad_line_stores_nothing_and_a_file_comes_back() {
    let relay = Relay::start().await;
    let (device, group) = device(&relay.rest, "127.0.0.1:9", "omron", 1000).await;
    let path = format!("groups/{group}/variables");
    let new = json!({ "variables": [
        { "name": "motor", "address": "stMotor", "type": "STRUCT{speed: REAL; run: BOOL}" },
        { "parent_address": "stMotor", "name": "speed", "address": "speed", "unit": "1/min", "writable": true },
        { "name": "wrong", "address": "a b" },
    ]});
    let reply = relay.rest.post(&path, &new).await;
    reply.is_problem(422, "findings");
    assert_eq!(reply.body["findings"][0]["field"], "variables[2].address", "{reply:?}");
    assert_eq!(relay.rest.get(&path).await.body, json!([]));

    let mut right = new.clone();
    right["variables"].as_array_mut().expect("a list").pop();
    made(&relay.rest, &path, &right).await;
    let file = relay.rest.get(&format!("{path}.csv")).await;
    let text = file.body.as_str().expect("a file").to_owned();
    assert!(text.starts_with("parent,name,address,type,"), "{text}");

    let other = made(&relay.rest, "groups", &json!({ "device": device, "name": "other" })).await;
    let other = format!("groups/{}/variables", id(&other));
    let broken = text.replace("yes", "perhaps");
    let reply = relay.rest.post(&format!("{other}.csv"), &json!({ "csv": broken })).await;
    reply.is_problem(422, "findings");
    assert_eq!(reply.body["findings"][0]["field"], "line 3.writable", "{reply:?}");
    assert_eq!(relay.rest.get(&other).await.body, json!([]));
    made(&relay.rest, &format!("{other}.csv"), &json!({ "csv": text })).await;
    let again = relay.rest.get(&format!("{other}.csv")).await.body;
    assert_eq!(again.as_str(), Some(text.as_str()));

    let copy = json!({ "name": "copy", "path": "4,127.0.0.1:10" });
    let copy = made(&relay.rest, &format!("devices/{device}/copy"), &copy).await;
    let tree = relay.rest.get("devices").await.body;
    let groups = tree["groups"].as_array().expect("groups");
    let copied = groups.iter().find(|it| it["device"] == copy["id"]).expect("a copied group");
    let file = relay.rest.get(&format!("groups/{}/variables.csv", id(copied))).await;
    assert_eq!(file.body.as_str(), Some(text.as_str()), "parents and parts are copied");

    // Whoever has not seen the newest changes nothing.
    let gone = relay.rest.delete(&format!("devices/{device}?revision=7")).await;
    gone.is_problem(409, "stale_revision");
    assert_eq!(relay.rest.delete(&format!("devices/{device}?revision=1")).await.status, 204);
    relay.rest.get(&path).await.is_problem(404, "not_found");
    relay.stop().await;
}

/// Asks for a ticket, and writes with it.
async fn write(rest: &Rest, variable: &str, text: &str) -> (Value, cipdeck_tests::rest::Reply) {
    let offer = rest.post(&format!("variables/{variable}/offer"), &json!({ "text": text })).await;
    assert_eq!(offer.status, 200, "{text}: {offer:?}");
    let ticket = json!({ "ticket": offer.body["ticket"] });
    let written = rest.post(&format!("variables/{variable}/write"), &ticket).await;
    let again = rest.post(&format!("variables/{variable}/write"), &ticket).await;
    again.is_problem(403, "not_permitted");
    (offer.body, written)
}

#[tokio::test]
async fn a_variable_is_written_with_a_ticket_and_read_back() {
    let plc = Service::simulate("127.0.0.1:0", &["--profile", "omron"]).await;
    let relay = Relay::start().await;
    let rest = &relay.rest;
    let (device, group) = device(rest, &plc.address, "auto", 100).await;
    let path = format!("groups/{group}/variables");
    let new = json!({ "variables": [
        { "name": "set", "address": "stSet", "type": "STRUCT{speed: REAL; run: BOOL; count: DINT}" },
        { "parent_address": "stSet", "name": "speed", "address": "speed", "unit": "1/min", "writable": true,
          "scale": { "factor": 2.0 }, "min": 0.0, "max": 4000.0 },
        { "name": "percent", "address": "gnPercent", "writable": true },
        { "name": "version", "address": "gcVersion", "writable": true },
        { "name": "bit", "address": "elWord.3", "writable": true },
        { "name": "element", "address": "arSet[2]", "writable": true },
        { "name": "recipe", "address": "gsRecipe", "writable": true },
        { "name": "fixed", "address": "TAG1" },
    ]});
    let all = made(rest, &path, &new).await;
    let ids: Vec<_> = all.as_array().expect("variables").iter().map(id).collect();
    let offer = |variable: usize, text: &'static str| {
        let path = format!("variables/{}/offer", ids[variable]);
        async move { rest.post(&path, &json!({ "text": text })).await }
    };
    offer(1, "3000").await.is_problem(403, "not_permitted");
    assert_eq!(rest.post("window", &json!({})).await.status, 200);
    offer(7, "FALSE").await.is_problem(403, "not_permitted");

    let (offered, written) = write(rest, &ids[1], "3000.5").await;
    assert_eq!(
        (&offered["old"]["text"], &offered["new"]["text"]),
        (&json!("3000 1/min"), &json!("3000.5 1/min"))
    );
    assert_eq!(offered["new"]["data"], "0088bb44", "1500.25 as a REAL");
    assert_eq!((written.status, &written.body["is_done"]), (200, &json!(true)), "{written:?}");
    assert_eq!(written.body["written"]["is_equal"], true, "{written:?}");
    assert_eq!(written.body["value"]["text"], "3000.5 1/min", "{written:?}");
    let (_, written) = write(rest, &ids[5], "33").await;
    assert_eq!(written.body["value"]["value"], 33, "{written:?}");
    let (_, written) = write(rest, &ids[6], "\"Größe 2\"").await;
    assert_eq!(written.body["value"]["value"], "Größe 2", "{written:?}");

    // What the device refuses, it refuses in its own words.
    for (variable, text) in [(2, "101"), (3, "\"2.0\"")] {
        let (_, written) = write(rest, &ids[variable], text).await;
        assert_eq!((written.status, &written.body["is_done"]), (200, &json!(false)), "{written:?}");
        assert!(written.body["reason"].as_str().is_some_and(|why| !why.is_empty()), "{written:?}");
    }
    // What cannot be meant is refused before.
    for (variable, text) in [(1, "4001"), (1, "fast"), (2, "40000"), (4, "TRUE")] {
        offer(variable, text).await.is_problem(422, "findings");
    }

    let log = rest.get(&format!("devices/{device}/writes")).await.body;
    let entries = log.as_array().expect("entries");
    assert_eq!(entries.len(), 5, "{log}");
    assert_eq!(
        (&entries[4]["old"], &entries[4]["new"]),
        (&json!("3000 1/min"), &json!("3000.5 1/min")),
        "{log}"
    );
    assert_eq!(
        (&entries[4]["address"], &entries[4]["actor"]),
        (&json!("stSet.speed"), &json!("local")),
        "{log}"
    );
    let audit = rest.get("audit?event=write_permitted").await.body;
    let record = &audit["records"].as_array().expect("records")[0];
    assert!(record["name"].as_str().is_some_and(|name| name.contains("gcVersion")), "{record}");

    // Between the offer and the write somebody turns the permission off.
    let offered = offer(2, "60").await.body;
    let mut percent = all[2].clone();
    percent["writable"] = json!(false);
    assert_eq!(rest.put(&format!("variables/{}", ids[2]), &percent).await.status, 200);
    let late = json!({ "ticket": offered["ticket"] });
    rest.post(&format!("variables/{}/write", ids[2]), &late).await.is_problem(403, "not_permitted");
    relay.stop().await;
}

#[tokio::test]
async fn a_bit_of_a_logix_is_written_without_the_others() {
    let plc = Service::simulate("127.0.0.1:0", &["--profile", "logix"]).await;
    let relay = Relay::start().await;
    let (_, group) = device(&relay.rest, &plc.address, "logix", 100).await;
    let new = json!({ "variables": [
        { "name": "bit", "address": "Scalar.0", "writable": true }, { "name": "all", "address": "Scalar", "writable": true },
    ]});
    let all = made(&relay.rest, &format!("groups/{group}/variables"), &new).await;
    assert_eq!(relay.rest.post("window", &json!({})).await.status, 200);
    let (_, written) = write(&relay.rest, &id(&all[0]), "TRUE").await;
    assert_eq!(written.body["value"]["value"], true, "{written:?}");
    let (offered, _) = write(&relay.rest, &id(&all[1]), "7").await;
    assert_eq!(offered["old"]["text"], "43", "42 with its lowest bit");
    relay.stop().await;
}

#[tokio::test]
async fn a_device_is_asked_what_it_has_and_what_its_structures_are_made_of() {
    let relay = Relay::start().await;
    let rest = &relay.rest;
    for (profile, name, structure) in [
        ("omron", "grHWCs_PV", Some(("stMotor", "STRUCT{speed: REAL; run: BOOL; count: DINT}"))),
        ("logix", "Scalar", None),
        ("micro800", "", None),
    ] {
        let plc = Service::simulate("127.0.0.1:0", &["--profile", profile]).await;
        let (device, _) = device(rest, &plc.address, "auto", 100).await;
        let path = format!("devices/{device}/browse");
        assert_eq!(rest.get(&path).await.body["state"], "idle");
        assert_eq!(rest.post(&path, &json!({})).await.status, 202);
        let page = eventually("everything is listed", PATIENCE, async || {
            let page = rest.get(&path).await.body;
            (page["state"] != "running").then_some(page)
        })
        .await;
        assert_eq!(
            (&page["state"], &page["requests"].is_u64()),
            (&json!("done"), &true),
            "{}",
            page["reason"]
        );
        let symbols = page["symbols"].as_array().expect("symbols");
        assert!(
            !symbols.is_empty() && symbols.iter().any(|it| name.is_empty() || it["name"] == name),
            "{page}"
        );
        let next = rest.get(&format!("{path}?from={}", page["next"])).await.body;
        assert_eq!(next["found"], page["found"], "{next}");
        if let Some((name, kind)) = structure {
            let found = symbols.iter().find(|it| it["name"] == name).expect("the structure");
            let of = found["structure"].as_str().expect("its id");
            let told = rest.get(&format!("{path}/type?of={of}")).await;
            assert_eq!((told.status, &told.body["type"]), (200, &json!(kind)), "{told:?}");
        }
        assert_eq!(rest.delete(&path).await.status, 204);
    }
    relay.stop().await;
}

#[tokio::test]
async fn who_may_not_write_gets_no_ticket() {
    use cipdeck_tests::managed::Managed;

    let plc = Service::simulate("127.0.0.1:0", &["--profile", "omron"]).await;
    let relay = Managed::start().await;
    let engineer = relay.user("engineer").await;
    let (_, group) = device(&engineer, &plc.address, "omron", 100).await;
    let new = json!({ "variables": [{ "name": "set", "address": "gnPercent", "writable": true }] });
    let all = made(&engineer, &format!("groups/{group}/variables"), &new).await;
    let path = format!("variables/{}", id(&all[0]));
    assert_eq!(engineer.post("window", &json!({})).await.status, 200);
    let ticket = engineer.post(&format!("{path}/offer"), &json!({ "text": "51" })).await;
    assert_eq!(ticket.status, 200, "{ticket:?}");
    let others = [relay.user("viewer").await, relay.user("operator").await, relay.admin.clone()];
    let mut said = Vec::new();
    for other in &others {
        let refused = other.post(&format!("{path}/offer"), &json!({ "text": "52" })).await;
        refused.is_problem(403, "not_permitted");
        said.push(refused.body["detail"].as_str().expect("why").to_owned());
        let stolen = json!({ "ticket": ticket.body["ticket"] });
        other.post(&format!("{path}/write"), &stolen).await.is_problem(403, "not_permitted");
        other.put(&path, &all[0]).await.is_problem(403, "not_permitted");
    }
    assert!(said[1].contains("of a tag: the list names objects only"), "an operator: {said:?}");
    // It is still there for whom it was made.
    let mine = json!({ "ticket": ticket.body["ticket"] });
    let written = engineer.post(&format!("{path}/write"), &mine).await;
    assert_eq!(written.body["written"]["is_equal"], true, "{written:?}");
}

#[tokio::test]
async fn a_value_of_another_device_is_never_shown_as_good() {
    let plc = Service::simulate("127.0.0.1:0", &["--profile", "omron"]).await;
    let relay = Relay::start().await;
    let (device, group) = device(&relay.rest, &plc.address, "omron", 100).await;
    let ids = variables(&relay.rest, &group, &["gsRecipe"]).await;
    let mut viewer = LiveViewer::connect(relay.address).await;
    viewer.watch(&[&group]).await;
    turn(&relay.rest, &group, true).await;
    let value = |viewer: &LiveViewer, quality: &str| {
        viewer.values.get(&ids[0]).filter(|value| value["quality"] == quality).cloned()
    };
    viewer.until("it is good", PATIENCE, |viewer| value(viewer, "good")).await;
    // Somewhere else, where nobody may go.
    let mut there = relay.rest.get(&format!("devices/{device}")).await.body;
    there["path"] = json!("4,192.0.2.1");
    assert_eq!(relay.rest.put(&format!("devices/{device}"), &there).await.status, 200);
    viewer.values.clear();
    let first = viewer.until("it is said", PATIENCE, |viewer| viewer.values.get(&ids[0]).cloned()).await;
    assert_ne!(first["quality"], "good", "{first}");
    let reason = |value: &Value| value["reason"].as_str().is_some_and(|why| why.contains("not on the list"));
    viewer
        .until("it says why", PATIENCE, |viewer| {
            viewer.values.get(&ids[0]).filter(|it| reason(it)).map(|_| ())
        })
        .await;
    relay.stop().await;
}

#[tokio::test]
async fn whoever_looks_at_values_with_an_ended_session_sees_no_more() {
    use cipdeck_tests::managed::Managed;

    let relay = Managed::start().await;
    let viewer = relay.user("viewer").await;
    let cookie = [("cookie", viewer.header("cookie"))];
    let mut looking = LiveViewer::connect_with(&relay.address, &cookie).await;
    let disabled = Rest::send(
        relay
            .admin
            .request(reqwest::Method::PATCH, "users/viewer")
            .header("content-type", "application/json")
            .body(json!({ "disabled": true }).to_string()),
    )
    .await;
    assert_eq!(disabled.status, 200, "{disabled:?}");
    let frame = looking.closed(PATIENCE).await.expect("a reason");
    assert_eq!(u16::from(frame.code), 4401, "{frame:?}");
}

#[tokio::test]
async fn a_group_that_is_on_goes_on_after_a_restart_of_the_relay() {
    let plc = Service::simulate("127.0.0.1:0", &["--profile", "micro800"]).await;
    let relay = Relay::start().await;
    let (_, group) = device(&relay.rest, &plc.address, "auto", 100).await;
    let ids = variables(&relay.rest, &group, &["Counter"]).await;
    turn(&relay.rest, &group, true).await;
    let relay = Relay::start_in(relay.stop().await).await;
    let mut viewer = LiveViewer::connect(relay.address).await;
    viewer.watch(&[&group]).await;
    viewer
        .until("it is read", PATIENCE, |viewer| {
            viewer.values.get(&ids[0]).filter(|value| value["quality"] == "good").map(|_| ())
        })
        .await;
    relay.stop().await;
}

#[tokio::test]
async fn a_message_that_is_none_is_answered_and_the_viewer_stays() {
    let relay = Relay::start().await;
    let mut viewer = LiveViewer::connect(relay.address).await;
    for text in ["", "[]", r#"{"type":"run"}"#, r#"{"type":"watch","groups":["b1"]}"#] {
        viewer.say(text).await;
        let problem = |viewer: &LiveViewer| viewer.last.get("problem").cloned();
        viewer.until("an answer", Duration::from_secs(5), problem).await;
        viewer.last.clear();
    }
    let (_, group) = device(&relay.rest, "127.0.0.1:9", "omron", 1000).await;
    viewer.until("the tree has changed", PATIENCE, |viewer| viewer.last.get("tree").cloned()).await;
    viewer.watch(&[&group, "g999"]).await;
    viewer.until("its values", PATIENCE, |viewer| viewer.last.get("values").cloned()).await;
    variables(&relay.rest, &group, &["x"]).await;
    viewer
        .until("its variables have changed", PATIENCE, |viewer| viewer.last.get("variables").cloned())
        .await;
    relay.stop().await;
}
