//! `cipdeck read`, `write` and `tags` against the simulated controllers and a server that nobody here wrote.

use cipdeck_tests::command::{Ended, Service, cipdeck};
use cipdeck_tests::peers::Cpppo;
use serde_json::{Value, json};

async fn controller(profile: &str) -> (Service, String) {
    let device = Service::simulate("127.0.0.1:0", &["--profile", profile]).await;
    let path = format!("4,{},1,0", device.address);
    (device, path)
}

async fn read(path: &str, tags: &[&str]) -> Ended {
    cipdeck(&[&["read", path, "--json"], tags].concat()).await
}

/// What was read, tag by tag.
fn values(ended: &Ended) -> Vec<Value> {
    let report = ended.json();
    report["tags"].as_array().expect("tags").iter().map(|tag| tag["value"].clone()).collect()
}

#[tokio::test]
async fn an_omron_tells_its_tags_and_takes_values() {
    let (_device, path) = controller("omron").await;
    let ended = read(&path, &["TAG1", "TAG2", "arSet", "arSet[3]", "stMotor.speed", "grHWCs_PV"]).await;
    assert_eq!(ended.code, 0, "{ended:?}");
    let report = ended.json();
    assert_eq!(report["profile"], "omron");
    assert_eq!((&report["tags"][0]["type"], &report["tags"][5]["type"]), (&json!("BOOL"), &json!("REAL")));
    let all = values(&ended);
    assert_eq!(all[2][3], all[3], "an element is that of the whole array");

    let written = cipdeck(&["write", &path, "TAG1", "TRUE"]).await;
    assert_eq!((written.code, written.stdout.trim().ends_with("-> TRUE")), (0, true), "{written:?}");
    assert_eq!(values(&read(&path, &["TAG1"]).await), [json!(true)]);
}

#[tokio::test]
async fn a_logix_tells_its_tags_and_takes_values() {
    let (_device, path) = controller("logix").await;
    let ended =
        read(&path, &["Scalar", "Arr=DINT[100]", "Status.2", "Status.1", "Recipe", "Program:Main.x"]).await;
    assert_eq!(ended.code, 0, "{ended:?}");
    let all = values(&ended);
    assert_eq!((&all[0], &all[1][99]), (&json!(42), &json!(99)));
    assert_eq!(all[2..], [json!(true), json!(false), json!("Standard"), json!(7)]);

    for (tag, value, read_as) in [
        ("Scalar", "-7", json!(-7)),
        ("Setpoint", "12.5", json!(12.5)),
        ("Recipe", "Söße", json!("Söße")),
        ("Status.1", "TRUE", json!(true)),
        ("Arr[3]=DINT[3]", "[30, 0x1F, 32]", json!([30, 31, 32])),
    ] {
        let written = cipdeck(&["write", &path, tag, value, "--json"]).await;
        assert_eq!((written.code, &written.json()["value"]), (0, &read_as), "{written:?}");
    }
    assert_eq!(values(&read(&path, &["Status", "Arr[4]"]).await), [json!(7), json!(31)]);
}

#[tokio::test]
async fn what_a_controller_refuses_is_exit_3_in_its_own_words() {
    let (_omron, omron) = controller("omron").await;
    let (_logix, logix) = controller("logix").await;
    let missing = read(&omron, &["TAG1", "nowhere"]).await;
    assert_eq!(missing.code, 3, "{missing:?}");
    let tags = &missing.json()["tags"];
    assert!(tags[0]["value"].is_boolean() && tags[1]["error"].is_string(), "the others are read: {tags}");

    let other = cipdeck(&["write", &omron, "TAG1=INT", "1"]).await;
    assert_eq!(other.code, 3, "{other:?}");
    assert!(other.stderr.contains("0x8022") && other.stderr.contains("Data type differs"), "{other:?}");

    let missing = read(&logix, &["nowhere"]).await;
    assert_eq!((missing.code, &missing.json()["tags"][0]["status"]), (3, &json!(4)), "{missing:?}");
    assert!(missing.json()["tags"][0]["error"].as_str().is_some_and(|words| words.contains("Path segment")));
    let other = cipdeck(&["write", &logix, "Scalar=REAL", "1.5"]).await;
    assert_eq!(other.code, 3, "{other:?}");
    assert!(other.stderr.contains("0x2107") && other.stderr.contains("type"), "{other:?}");
}

#[tokio::test]
async fn what_cannot_be_meant_is_exit_2_and_never_sent() {
    let (_device, path) = controller("logix").await;
    for (arguments, words) in [
        (&["read", "4,nowhere:x", "A"][..], "no path"),
        (&["read", &path, "A B"], "character 2"),
        (&["read", &path, "A=REEL"], "neither a type"),
        (&["write", &path, "Scalar", "12,5"], "not a number"),
        (&["write", &path, "Scalar", "2147483648"], "outside of DINT"),
        (&["write", &path, "Setpoint.3", "TRUE"], "no such bit"),
        (&["write", &path, "Recipe", &"a".repeat(83)], "at most 82"),
    ] {
        let ended = cipdeck(arguments).await;
        assert_eq!(ended.code, 2, "{arguments:?}: {ended:?}");
        assert!(ended.stderr.contains(words), "{arguments:?}: {ended:?}");
    }
    assert_eq!(values(&read(&path, &["Scalar"]).await), [json!(42)]);
}

#[tokio::test]
async fn a_micro800_is_asked_over_a_connection_and_one_by_one() {
    let (_device, path) = controller("micro800").await;
    let ended = read(&path, &["Scalar", "Setpoint"]).await;
    assert_eq!(ended.code, 0, "{ended:?}");
    assert_eq!(ended.json()["profile"], "micro800");
}

#[tokio::test]
async fn a_server_that_nobody_here_wrote_tells_its_tags_and_takes_values() {
    let cpppo = Cpppo::with_tags(&["TAG1=DINT", "TAG2=REAL", "Arr=INT[600]"]).await;
    let path = format!("{},1,0", cpppo.path());
    let ended = read(&path, &["TAG1", "TAG2", "Arr=INT[600]", "Arr[7]"]).await;
    assert_eq!(ended.code, 0, "{ended:?}");
    assert_eq!(values(&ended)[2].as_array().map(Vec::len), Some(600), "more than a packet: {ended:?}");
    for (tag, value, read_as) in
        [("TAG1", "-70000", json!(-70000)), ("TAG2", "0.1", json!(0.1)), ("Arr[7]", "77", json!(77))]
    {
        let written = cipdeck(&["write", &path, tag, value, "--json"]).await;
        assert_eq!((written.code, &written.json()["value"]), (0, &read_as), "{written:?}");
    }
    assert_eq!(values(&read(&path, &["Arr[6]=INT[3]"]).await), [json!([0, 77, 0])]);
    // It refuses a message by itself with an encapsulation status, and a part of a packet with a CIP status.
    for tags in [&["nowhere"][..], &["TAG1", "nowhere"]] {
        let missing = read(&path, tags).await;
        assert_eq!(missing.code, 3, "{missing:?}");
    }
    let other = cipdeck(&["write", &path, "TAG1=REAL", "1.5"]).await;
    assert_eq!((other.code, other.stderr.contains("0x2107")), (3, true), "{other:?}");
}

#[tokio::test]
async fn a_controller_lists_its_tags_and_its_structures() {
    for (profile, tag, structure, members) in [
        ("omron", "stMotor", "Motor", "speed: REAL"),
        ("logix", "Program:Main.Motor", "Motor", "Speed: REAL; Run: BOOL"),
    ] {
        let (_device, path) = controller(profile).await;
        let ended = cipdeck(&["tags", &path, "motor", "--structures", "--json"]).await;
        assert_eq!(ended.code, 0, "{ended:?}");
        let all = ended.json();
        let all = all.as_array().expect("a list");
        let found = all.iter().find(|entry| entry["tag"] == tag).unwrap_or_else(|| panic!("{tag}: {all:?}"));
        assert_eq!(found["type"], structure);
        assert!(found["members"].as_str().is_some_and(|text| text.contains(members)), "{found}");
        assert!(
            all.iter()
                .all(|entry| entry["tag"].as_str().is_some_and(|tag| tag.to_lowercase().contains("motor")))
        );
        let kind = found["members"].as_str().expect("members");
        let read = read(&path, &[&format!("{tag}={kind}")]).await;
        assert_eq!(read.code, 0, "what is listed can be read with its type: {read:?}");
        assert!(values(&read)[0].is_object(), "{read:?}");
    }
}
