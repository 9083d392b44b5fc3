//! `cipdeck user`: what somebody at the relay's machine does.

#![expect(clippy::unwrap_used, reason = "a test ends where it fails")]

mod common;

use std::io::Write;
use std::path::Path;
use std::process::{Command, Stdio};

use cipdeck_relay::Settings;
use common::{Relay, request};

struct Ended {
    code: i32,
    stdout: String,
    stderr: String,
}

fn user(folder: &Path, arguments: &[&str], stdin: &str) -> Ended {
    let mut child = Command::new(env!("CARGO_BIN_EXE_cipdeck"))
        .arg("user")
        .args(arguments)
        .args(["--data", folder.to_str().unwrap()])
        .stdin(Stdio::piped())
        .stdout(Stdio::piped())
        .stderr(Stdio::piped())
        .spawn()
        .unwrap();
    // It may not want to read it.
    let _ = child.stdin.take().unwrap().write_all(stdin.as_bytes());
    let output = child.wait_with_output().unwrap();
    let text = |bytes| String::from_utf8(bytes).unwrap();
    Ended { code: output.status.code().unwrap(), stdout: text(output.stdout), stderr: text(output.stderr) }
}

async fn sign_in(relay: &Relay, name: &str, password: &str) -> u16 {
    let body = format!(r#"{{"name":"{name}","password":"{password}"}}"#);
    relay.ask("POST", "/api/v1/session", &body).await.status
}

#[tokio::test]
async fn a_lost_administrator_is_replaced_on_the_relays_machine() {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path();
    let refused = user(path, &["list"], "");
    assert_eq!(refused.code, 2, "{}", refused.stderr);
    assert!(refused.stderr.contains("--data"), "{}", refused.stderr);

    let added = user(path, &["add", "root", "--role", "admin"], "correct horse battery\n");
    assert_eq!((added.code, added.stderr.as_str()), (0, ""));
    assert!(added.stdout.starts_with("root ") && added.stdout.contains("admin"), "{}", added.stdout);
    let relay = Relay::start(Settings::stored_in(path)).await;
    assert_eq!(sign_in(&relay, "root", "correct horse battery").await, 200);
    let refused = user(path, &["list"], "");
    assert_eq!(refused.code, 1);
    assert!(refused.stderr.contains("stop it first"), "{}", refused.stderr);
    relay.stop().await;

    assert_eq!(user(path, &["password", "root"], "another long password").code, 0);
    assert_eq!(user(path, &["add", "anna", "--role", "viewer"], "correct horse battery\r\n").code, 0);
    assert_eq!(user(path, &["disable", "anna"], "").code, 0);
    let listed = user(path, &["list"], "").stdout;
    let lines: Vec<_> = listed.lines().collect();
    assert!(lines.len() == 2 && lines[0].starts_with("anna") && lines[0].ends_with("disabled"), "{listed}");
    assert!(lines[1].starts_with("root") && !lines[1].contains("never"), "{listed}");
    let relay = Relay::start(Settings::stored_in(path)).await;
    assert_eq!(sign_in(&relay, "anna", "correct horse battery").await, 401);
    assert_eq!(sign_in(&relay, "root", "another long password").await, 200);
    relay.stop().await;

    assert_eq!(user(path, &["enable", "anna"], "").code, 0);
    assert_eq!(user(path, &["remove", "anna"], "").code, 0);
    for (arguments, why) in [
        (&["remove", "root"][..], "last administrator"),
        (&["disable", "nobody"], "no user nobody"),
        (&["add", "Root", "--role", "admin"], "a-z"),
        (&["add", "x", "--role", "king"], "viewer, operator"),
        (&["password", "root"], "characters"),
    ] {
        let refused = user(path, arguments, "short\n");
        assert_eq!(refused.code, 2, "{arguments:?}");
        assert!(refused.stderr.contains(why), "{arguments:?}: {}", refused.stderr);
    }
    let audit = std::fs::read_to_string(path.join("audit.jsonl")).unwrap();
    for event in ["user_created", "password_changed", "user_changed", "user_deleted", "sign_in"] {
        assert!(audit.contains(&format!("\"{event}\"")), "{event}");
    }
    assert!(!audit.contains("correct horse") && !audit.contains("another long"), "{audit}");
}

#[tokio::test]
async fn before_set_up_nothing_answers_but_the_way_in() {
    let folder = tempfile::tempdir().unwrap();
    let relay = Relay::start(Settings::stored_in(folder.path())).await;
    let session = relay.ask("GET", "/api/v1/session", "").await;
    assert_eq!((session.status, session.json()["state"].as_str()), (200, Some("set_up")));
    let refused = relay.ask("GET", "/api/v1/blocks", "").await;
    assert_eq!(refused.problem(), (401, "signed_out".to_owned()));
    assert!(refused.body.contains("set-up code"), "{}", refused.body);
    let host = relay.address.to_string();
    let form = r#"{"code":"0000-0000-0000","name":"x","password":"correct horse battery"}"#;
    let refused = request(relay.address, "POST", "/api/v1/setup", &[("Host", &host)], form).await;
    assert_eq!(refused.problem(), (403, "not_permitted".to_owned()));
    let refused = request(relay.address, "POST", "/api/v1/setup", &[("Host", &host)], form).await;
    assert_eq!(refused.problem(), (429, "too_many".to_owned()));
    relay.stop().await;
}
