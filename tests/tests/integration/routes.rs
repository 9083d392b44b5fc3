//! Routes from the command line through the simulated chassis, which checks them.

use cipdeck_tests::block;
use cipdeck_tests::command::{Ended, Service, cipdeck};
use serde_json::json;

#[tokio::test]
async fn every_route_reaches_its_module() {
    let device = Service::simulate("127.0.0.1:0", &[]).await;
    for (route, name) in [
        ("", "cipdeck demo drive"),
        (",1,0", "cipdeck demo drive"),
        (",1,1", "cipdeck demo I/O"),
        (",1,3", "cipdeck demo bridge"),
        (",2,192.168.1.20", "cipdeck demo remote"),
        (",1,3,2,192.168.1.20", "cipdeck demo remote"),
    ] {
        for way in [&[][..], &["--connected"]] {
            let ended = read_name(&device, route, &[&["--json"], way].concat()).await;
            assert_eq!(ended.code, 0, "{route} {way:?}: {ended:?}");
            assert_eq!(ended.json()["ResData"], block::short_string(name), "{route} {way:?}");
        }
    }
}

#[tokio::test]
async fn what_a_router_refuses_is_told_in_numbers_and_in_words() {
    let device = Service::simulate("127.0.0.1:0", &[]).await;
    for (route, extended, words, remaining) in [
        (",1,9", 0x0312, "Link address not valid", 1),
        (",7,1", 0x0311, "Port not available", 1),
        (",1,1,2,192.168.1.20", 0x0311, "Port not available", 7),
    ] {
        let ended = read_name(&device, route, &["--json"]).await;
        let status = ended.json();
        assert_eq!(
            (ended.code, &status["Status"]["ErrorID"], &status["Status"]["SubErrorID"]),
            (3, &json!(224), &json!(1)),
            "{route}: {ended:?}"
        );
        assert_eq!(status["Status"]["ExtErrorID"], extended, "{route}: {status}");
        let cause = &status["cause"];
        assert_eq!(
            (&cause["by"], &cause["remaining_path"]),
            (&json!("router"), &json!(remaining)),
            "{cause}"
        );
        let people = read_name(&device, route, &[]).await;
        let told = format!("Extended status 0x{extended:04X}: {words}");
        assert!(people.stdout.contains(&told) && people.stdout.contains("router"), "{people:?}");
    }
}

#[tokio::test]
async fn a_refused_connection_says_who_refused_it() {
    let device = Service::simulate("127.0.0.1:0", &[]).await;
    let ended = read_name(&device, ",1,9", &["--json", "--connected"]).await;
    let status = ended.json();
    assert_eq!((ended.code, &status["Status"]["ExtErrorID"]), (3, &json!(0x0312)), "{ended:?}");
    assert_eq!(
        (&status["Status"]["StatusBits"], &status["cause"]["by"]),
        (&json!(11), &json!("forward_open")),
        "{status}"
    );
}

#[tokio::test]
async fn the_devices_own_refusal_is_not_the_routers() {
    let device = Service::simulate("127.0.0.1:0", &[]).await;
    let path = format!("4,{},1,1", device.address);
    let missing = ["send", &path, "--service", "14", "--class", "238", "--instance", "1", "--attribute", "1"];
    let ended = cipdeck(&[&missing[..], &["--json"]].concat()).await;
    let status = ended.json();
    assert_eq!((ended.code, &status["Status"]["SubErrorID"]), (3, &json!(5)), "{ended:?}");
    assert_eq!(status["cause"]["by"], json!(null), "{status}");
}

/// Reads Identity 1/1/7 along a route.
async fn read_name(device: &Service, route: &str, more: &[&str]) -> Ended {
    let path = format!("4,{}{route}", device.address);
    let read = ["send", &path, "--service", "14", "--class", "1", "--instance", "1", "--attribute", "7"];
    cipdeck(&[&read[..], more].concat()).await
}
