//! What opens something is nowhere but with whom it belongs to.

use std::fs;
use std::path::{Path, PathBuf};

use cipdeck_tests::PATIENCE;
use cipdeck_tests::block;
use cipdeck_tests::command::cipdeck;
use cipdeck_tests::managed::{Managed, PASSWORD};
use cipdeck_tests::rest::Rest;
use reqwest::Method;
use serde_json::json;
use tempfile::TempDir;

/// All files below a folder.
fn files(folder: &Path, found: &mut Vec<PathBuf>) {
    for entry in fs::read_dir(folder).expect("a folder") {
        let path = entry.expect("an entry").path();
        if path.is_dir() { files(&path, found) } else { found.push(path) }
    }
}

fn over_tls(address: &str, data: &Path) -> Rest {
    Rest::over_tls(address, &fs::read(data.join("tls/cert.pem")).expect("a certificate"))
}

#[tokio::test]
async fn no_secret_is_in_any_artefact() {
    let scratch = TempDir::new().unwrap();
    let path = |name: &str| scratch.path().join(name).to_str().unwrap().to_owned();
    fs::write(path("cipdeck.toml"), "[tls]\n").unwrap();
    let arguments = ["--config", &path("cipdeck.toml"), "--log", "trace"];
    let mut relay = Managed::start_with(&arguments, over_tls).await;
    let data = relay.folder().to_owned();
    let mut secrets = vec![
        ("the set-up code", relay.code.clone()),
        ("the set-up code", relay.code.replace('-', "")),
        ("a password", PASSWORD.to_owned()),
    ];

    // Everything that makes a secret, and everything that takes one, rightly and wrongly.
    let engineer = relay.user("engineer").await;
    for person in [&relay.admin, &engineer] {
        let cookie = person.header("cookie").split_once('=').expect("a cookie").1;
        secrets.push(("a session", cookie.to_owned()));
        secrets.push(("a CSRF token", person.header("x-csrf-token").to_owned()));
    }
    let token = relay.token("engineer").await;
    secrets.push(("a token", token.rsplit('_').next().expect("a secret").to_owned()));
    let link = relay.admin.post("view-links", &json!({ "name": "hall", "hours": 1 })).await.body;
    let link = link["url"].as_str().expect("an address").rsplit('/').next().expect("a secret").to_owned();
    let stranger = over_tls(&relay.address, &data);
    let opened = Rest::send(stranger.at(Method::GET, &format!("/view/{link}"))).await;
    assert!(opened.status < 400, "{opened:?}");
    secrets.push(("a view link", link));
    for (name, password) in [("root", "a mistyped secret"), ("a mistyped secret", PASSWORD)] {
        let form = json!({ "name": name, "password": password });
        assert_eq!(stranger.post("session", &form).await.status, 401);
    }
    let short = json!({ "name": "otto", "role": "viewer", "password": "a mistyped secret" });
    assert_eq!(engineer.post("users", &short).await.status, 403);
    secrets.push(("a mistyped password", "a mistyped secret".to_owned()));
    stranger.with_token(&format!("{token}0")).get("blocks").await.is_problem(401, "signed_out");

    // A write by a person, and one by a script.
    let write = block::set("0,0", 4, 150, 3, &"2a".repeat(32));
    let id = engineer.create(&write).await;
    let ticket = engineer.ticket(&id, 1).await;
    let ran = engineer.post(&format!("blocks/{id}/run"), &json!({ "ticket": ticket })).await;
    assert_eq!((ran.status, &ran.body["Q"]), (200, &json!(true)), "{ran:?}");
    secrets.push(("a used ticket", ticket));
    secrets.push(("an unused ticket", engineer.ticket(&id, 1).await));
    fs::write(path("token"), &token).unwrap();
    fs::write(path("block.json"), write.to_string()).unwrap();
    let fingerprint = |line: &str| line.strip_prefix("certificate SHA-256 ").map(str::to_owned);
    let fingerprint = relay.process.line("its fingerprint", PATIENCE, fingerprint).await;
    let url = format!("https://{}", relay.address);
    let (token_file, block_file) = (path("token"), path("block.json"));
    let script =
        ["--relay", &url, "--token-file", &token_file, "--fingerprint", &fingerprint, "--log", "trace"];
    let script = cipdeck(&[&script[..], &["run", &block_file]].concat()).await;
    assert_eq!(script.code, 0, "{script:?}");
    let key = fs::read_to_string(data.join("tls/key.pem")).unwrap();
    let lines = key.lines().filter(|line| !line.starts_with("-----") && line.len() > 20);
    secrets.extend(lines.map(|line| ("the private key", line.to_owned())));
    assert!(secrets.iter().any(|(what, _)| *what == "the private key"), "the key has lines");
    assert!(secrets.iter().all(|(_, secret)| secret.len() >= 12), "long enough to be looked for");

    // What anybody could get hold of.
    let mut artefacts =
        vec![("the script's output".to_owned(), [script.stdout, script.stderr].concat().into())];
    let api = |path: &str| format!("/api/v1/{path}");
    for path in [
        "audit.jsonl",
        "audit",
        "audit/state",
        "history.csv",
        "history",
        "openapi.json",
        "users",
        "sessions",
        "tokens",
        "view-links",
        "blocks",
        "window",
        "targets",
        "allow/targets",
        "health",
        "ready",
    ]
    .map(api)
    .into_iter()
    .chain([format!("/api/v1/blocks/{id}/exchange"), "/metrics".to_owned()])
    {
        // The history is a little behind.
        let reply = Rest::send(relay.admin.at(Method::GET, &path)).await;
        assert_eq!(reply.status, 200, "{path}: {reply:?}");
        artefacts.push((path, reply.body.to_string().into_bytes()));
    }
    let mut there = Vec::new();
    files(&data, &mut there);
    relay.process.interrupt();
    relay.process.ended(PATIENCE).await;
    files(&data, &mut there);
    for file in there.into_iter().filter(|file| file.exists() && !file.ends_with("tls/key.pem")) {
        artefacts.push((file.display().to_string(), fs::read(&file).expect("a file")));
    }
    let log = relay.process.output();
    assert!(log.iter().any(|line| line.contains("TRACE")), "the finest level");
    // It is said to whoever has started the relay.
    let log: Vec<_> = log.into_iter().filter(|line| !line.starts_with("set-up code: ")).collect();
    artefacts.push(("the log".to_owned(), log.join("\n").into_bytes()));
    for named in ["audit.jsonl", "cipdeck.sqlite", "history.sqlite", "cert.pem", "/metrics"] {
        assert!(artefacts.iter().any(|(name, bytes)| name.ends_with(named) && !bytes.is_empty()), "{named}");
    }
    nothing_opens(&artefacts, &secrets);
}

/// No artefact holds a secret; each with its name.
fn nothing_opens(artefacts: &[(String, Vec<u8>)], secrets: &[(&str, String)]) {
    for (name, bytes) in artefacts {
        for (what, secret) in secrets {
            let at = bytes.windows(secret.len()).position(|window| window == secret.as_bytes());
            let around = at.map(|at| {
                let end = bytes.len().min(at + secret.len() + 80);
                String::from_utf8_lossy(&bytes[at.saturating_sub(200)..end]).into_owned()
            });
            assert_eq!(around, None, "{what} is in {name}");
        }
    }
}
