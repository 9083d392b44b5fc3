//! `cipdeck --relay URL run FILE`: a script lets a relay send.

#![expect(clippy::unwrap_used, reason = "a test ends where it fails")]

mod common;

use std::path::Path;
use std::process::Stdio;

use cipdeck_relay::Settings;
use serde_json::{Value, json};
use tokio::process::Command;

use self::common::{Relay, Reply, local, request};

struct Ended {
    code: i32,
    stdout: String,
    stderr: String,
}

async fn cipdeck(arguments: &[&str]) -> Ended {
    let output = Command::new(env!("CARGO_BIN_EXE_cipdeck"))
        .args(arguments)
        .env_remove("CIPDECK_TOKEN")
        .stdin(Stdio::null())
        .output()
        .await
        .unwrap();
    let text = |bytes| String::from_utf8(bytes).unwrap();
    Ended { code: output.status.code().unwrap(), stdout: text(output.stdout), stderr: text(output.stderr) }
}

/// A file with a block for the demo device.
fn file(folder: &Path, service: u8, object: [u16; 3], data: &str) -> String {
    let [class, instance, attribute] = object;
    let block = json!({
        "name": "script", "TargetCfg": {"Path": "0,0"}, "ReqData": data,
        "AppCfg": {"Service": service, "Class": class, "Instance": instance, "Attribute": attribute},
    });
    let path = folder.join(format!("{service}.json"));
    std::fs::write(&path, block.to_string()).unwrap();
    path.to_str().unwrap().to_owned()
}

async fn blocks(relay: &Relay) -> Value {
    relay.ask("GET", "/api/v1/blocks", "").await.json()
}

#[tokio::test]
async fn a_relay_runs_a_block_from_a_file_and_forgets_it() {
    let folder = tempfile::tempdir().unwrap();
    let relay = Relay::start(local(Settings::in_memory())).await;
    let url = format!("http://{}", relay.address);
    let read = file(folder.path(), 14, [1, 1, 7], "");
    let ended = cipdeck(&["--relay", &url, "run", &read, "--json"]).await;
    assert_eq!((ended.code, ended.stderr.as_str()), (0, ""));
    let report: Value = serde_json::from_str(&ended.stdout).unwrap();
    assert_eq!(
        (&report["Q"], &report["decoded"][0]["type"]),
        (&json!(true), &json!("SHORT_STRING")),
        "{report}"
    );
    let ended = cipdeck(&["run", &read, "--relay", &url, "--repeat", "3"]).await;
    assert_eq!((ended.code, ended.stdout.lines().count()), (0, 3), "{}", ended.stdout);
    let refused = file(folder.path(), 14, [1, 1, 99], "");
    let ended = cipdeck(&["--relay", &url, "run", &refused]).await;
    assert_eq!(ended.code, 3, "{}", ended.stdout);
    assert_eq!(blocks(&relay).await, json!([]), "nothing stays behind");
    relay.stop().await;
    let ended = cipdeck(&["--relay", &url, "run", &read]).await;
    assert_eq!(ended.code, 4, "{}", ended.stderr);
    assert!(ended.stderr.contains(&url), "{}", ended.stderr);
}

#[tokio::test]
async fn a_write_needs_an_open_window_and_says_what_it_replaces() {
    let folder = tempfile::tempdir().unwrap();
    let relay = Relay::start(local(Settings::in_memory())).await;
    let url = format!("http://{}", relay.address);
    let write = file(folder.path(), 16, [4, 150, 3], &"2a".repeat(32));
    let ended = cipdeck(&["--relay", &url, "run", &write]).await;
    assert_eq!((ended.code, ended.stdout.as_str()), (4, ""));
    assert!(ended.stderr.contains("window"), "{}", ended.stderr);
    assert_eq!(relay.ask("POST", "/api/v1/window", "").await.status, 200);
    let ended = cipdeck(&["--relay", &url, "run", &write, "--repeat", "2"]).await;
    assert_eq!((ended.code, ended.stdout.lines().count()), (0, 2), "{}{}", ended.stdout, ended.stderr);
    assert_eq!(ended.stderr.matches("writes ").count(), 2, "a ticket for each: {}", ended.stderr);
    assert!(ended.stderr.contains(" over ") && ended.stderr.contains("read back "), "{}", ended.stderr);
    assert_eq!(blocks(&relay).await, json!([]));
    relay.stop().await;
}

/// The header of a reply, without what follows its `;`.
fn header(reply: &Reply, name: &str) -> String {
    let line = reply.headers.lines().find_map(|line| line.strip_prefix(&format!("{name}: ")));
    line.unwrap().split(';').next().unwrap().to_owned()
}

#[tokio::test]
async fn a_token_says_who_the_script_is() {
    let folder = tempfile::tempdir().unwrap();
    let data = folder.path().join("data");
    let add = ["user", "add", "root", "--role", "admin", "--data", data.to_str().unwrap()];
    let mut child =
        Command::new(env!("CARGO_BIN_EXE_cipdeck")).args(add).stdin(Stdio::piped()).spawn().unwrap();
    tokio::io::AsyncWriteExt::write_all(&mut child.stdin.take().unwrap(), b"correct horse battery\n")
        .await
        .unwrap();
    assert!(child.wait().await.unwrap().success());
    let relay = Relay::start(Settings::stored_in(&data)).await;
    let (url, host) = (format!("http://{}", relay.address), relay.address.to_string());
    let form = json!({ "name": "root", "password": "correct horse battery" }).to_string();
    let signed_in = relay.ask("POST", "/api/v1/session", &form).await;
    let (cookie, csrf) = (header(&signed_in, "set-cookie"), signed_in.json()["caller"]["csrf"].clone());
    let cookie = cookie.replace("__host-cipdeck", "__Host-cipdeck");
    let make = async |role: &str| {
        let new = json!({ "name": role, "role": role, "days": 1 }).to_string();
        let headers =
            [("Host", host.as_str()), ("Cookie", cookie.as_str()), ("X-CSRF-Token", csrf.as_str().unwrap())];
        let made = request(relay.address, "POST", "/api/v1/tokens", &headers, &new).await.json();
        let path = folder.path().join(role);
        std::fs::write(&path, format!("{}\n", made["secret"].as_str().unwrap())).unwrap();
        path.to_str().unwrap().to_owned()
    };
    let (engineer, viewer) = (make("engineer").await, make("viewer").await);
    let read = file(folder.path(), 14, [1, 1, 7], "");
    let ended = cipdeck(&["--relay", &url, "run", &read]).await;
    assert_eq!(ended.code, 4);
    assert!(ended.stderr.contains("sign in first"), "{}", ended.stderr);
    let ended = cipdeck(&["--relay", &url, "--token-file", &engineer, "run", &read]).await;
    assert_eq!(ended.code, 0, "{}", ended.stderr);
    let ended = cipdeck(&["--relay", &url, "--token-file", &viewer, "run", &read]).await;
    assert_eq!(ended.code, 4);
    assert!(ended.stderr.contains("engineers"), "{}", ended.stderr);
    relay.stop().await;
}

#[tokio::test]
async fn what_cannot_be_meant_is_said_before_anything_is_sent() {
    let folder = tempfile::tempdir().unwrap();
    let read = file(folder.path(), 14, [1, 1, 7], "");
    for (arguments, why) in [
        (&["--relay", "http://192.0.2.1:8818", "run", &read][..], "https://"),
        (&["--relay", "192.0.2.1:8818", "run", &read], "--relay"),
        (&["--relay", "https://192.0.2.1", "--fingerprint", "A1", "run", &read], "64 hexadecimal"),
        (&["--relay", "https://192.0.2.1", "--token-file", "/nowhere", "run", &read], "/nowhere"),
        (&["--relay", "https://192.0.2.1", "run", &read, "--pcap", "x"], "--pcap"),
        (&["--fingerprint", "A1", "run", &read], "--relay"),
        (&["--relay", "https://192.0.2.1", "check", &read], "go with run"),
    ] {
        let ended = cipdeck(arguments).await;
        assert_eq!(ended.code, 2, "{arguments:?}: {}", ended.stderr);
        assert!(ended.stderr.contains(why), "{arguments:?}: {}", ended.stderr);
    }
}
