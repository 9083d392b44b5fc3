//! Who may call a relay as it is shipped: from the set-up code on its terminal to the end of a session.

use std::path::Path;
use std::time::Duration;

use cipdeck_tests::command::cipdeck;
use cipdeck_tests::process::Process;
use cipdeck_tests::rest::{Reply, Rest};
use cipdeck_tests::tools;
use cipdeck_tests::wait::within;
use cipdeck_tests::{PATIENCE, block};
use futures_util::StreamExt as _;
use reqwest::{Method, RequestBuilder};
use serde_json::{Value, json};
use tempfile::TempDir;
use tokio_tungstenite::connect_async;
use tokio_tungstenite::tungstenite::client::IntoClientRequest as _;

const PASSWORD: &str = "correct horse battery staple";

/// `cipdeck serve` as it starts on a new machine, with its log at the finest level.
struct Relay {
    process: Process,
    address: String,
    rest: Rest,
}

/// Somebody who has signed in.
struct Session {
    cookie: String,
    csrf: String,
}

impl Relay {
    fn start(folder: &Path) -> Process {
        let folder = folder.to_str().expect("a path in UTF-8");
        let arguments = ["serve", "--listen", "127.0.0.1:0", "--data", folder, "--log", "trace"];
        Process::start(&tools::cipdeck(), arguments)
    }

    async fn new(folder: &Path) -> Self {
        let process = Self::start(folder);
        let address = |line: &str| Some(line.strip_prefix("cipdeck listens on http://")?.to_string());
        let address = process.line("where it listens", PATIENCE, address).await;
        Self { rest: Rest::new(&address), process, address }
    }

    async fn code(&self) -> String {
        let code = |line: &str| Some(line.strip_prefix("set-up code: ")?.to_string());
        self.process.line("the set-up code", PATIENCE, code).await
    }

    /// Makes the administrator `root`.
    async fn set_up(&self) -> Session {
        let form = json!({ "code": self.code().await, "name": "root", "password": PASSWORD });
        self.enter("setup", &form).await
    }

    async fn enter(&self, path: &str, form: &Value) -> Session {
        let request = self.rest.request(Method::POST, path).header("content-type", "application/json");
        let response = request.body(form.to_string()).send().await.expect("the relay answers");
        assert_eq!(response.status(), 200);
        let cookie = response.headers()["set-cookie"].to_str().expect("a cookie").to_string();
        let body: Value = serde_json::from_str(&response.text().await.expect("a body")).expect("JSON");
        let cookie = cookie.split(';').next().expect("a cookie").to_string();
        Session { cookie, csrf: body["caller"]["csrf"].as_str().expect("a token").to_string() }
    }

    fn as_session(&self, session: &Session, method: Method, path: &str) -> RequestBuilder {
        let request = self.rest.request(method, path).header("content-type", "application/json");
        request.header("cookie", &session.cookie).header("x-csrf-token", &session.csrf)
    }

    async fn post(&self, session: &Session, path: &str, body: &Value) -> Reply {
        Rest::send(self.as_session(session, Method::POST, path).body(body.to_string())).await
    }
}

#[tokio::test]
async fn the_first_administrator_has_the_code_of_the_terminal() {
    let folder = TempDir::new().expect("a folder");
    let relay = Relay::new(folder.path()).await;
    relay.rest.get("blocks").await.is_problem(401, "signed_out");
    assert_eq!(relay.rest.get("session").await.body["state"], "set_up");
    let root = relay.set_up().await;
    assert_eq!(Rest::send(relay.as_session(&root, Method::GET, "blocks")).await.status, 200);
    let new = json!({ "name": "vera", "role": "viewer", "password": PASSWORD });
    assert_eq!(relay.post(&root, "users", &new).await.status, 201);
    drop(relay);

    // Users outlive the relay, sessions do not, and there is no second code.
    let relay = Relay::new(folder.path()).await;
    Rest::send(relay.as_session(&root, Method::GET, "blocks")).await.is_problem(401, "signed_out");
    let vera = relay.enter("session", &json!({ "name": "vera", "password": PASSWORD })).await;
    relay.post(&vera, "users", &new).await.is_problem(403, "not_permitted");
    let said = relay.process.output().join("\n");
    assert!(!said.contains("set-up code"), "{said}");
}

#[tokio::test]
async fn two_relays_have_two_codes() {
    let (one, two) = (TempDir::new().expect("a folder"), TempDir::new().expect("a folder"));
    let (first, second) = (Relay::new(one.path()).await, Relay::new(two.path()).await);
    assert_ne!(first.code().await, second.code().await);
}

#[tokio::test]
async fn who_watches_is_shown_out_within_a_second_of_the_revocation() {
    let folder = TempDir::new().expect("a folder");
    let relay = Relay::new(folder.path()).await;
    let root = relay.set_up().await;
    let new = json!({ "name": "vera", "role": "viewer", "password": PASSWORD });
    assert_eq!(relay.post(&root, "users", &new).await.status, 201);
    let vera = relay.enter("session", &json!({ "name": "vera", "password": PASSWORD })).await;
    let mut request = format!("ws://{}/api/v1/ws", relay.address).into_client_request().expect("a request");
    request.headers_mut().insert("cookie", vera.cookie.parse().expect("a header"));
    let (mut socket, _) = connect_async(request).await.expect("the relay takes a WebSocket");
    let sessions = Rest::send(relay.as_session(&root, Method::GET, "sessions")).await.body;
    let of_vera = sessions.as_array().expect("a list").iter().find(|entry| entry["name"] == "vera");
    let path = format!("sessions/{}", of_vera.expect("a session")["id"]);
    assert_eq!(Rest::send(relay.as_session(&root, Method::DELETE, &path)).await.status, 204);
    let frame = within("the WebSocket is closed", Duration::from_secs(1), async {
        loop {
            match socket.next().await {
                Some(Ok(frame)) if frame.is_close() => return frame,
                Some(Ok(_)) => {}
                other => panic!("without a word: {other:?}"),
            }
        }
    })
    .await;
    assert!(frame.to_string().contains("sign in again"), "{frame}");
}

/// What opens something is told once, to whom it belongs, and is nowhere else.
#[tokio::test]
async fn no_secret_is_in_the_log_at_any_level_nor_in_any_file() {
    let folder = TempDir::new().expect("a folder");
    let relay = Relay::new(folder.path()).await;
    let code = relay.code().await;
    let root = relay.set_up().await;
    let token = json!({ "name": "nightly", "role": "engineer", "days": 1 });
    let token =
        relay.post(&root, "tokens", &token).await.body["secret"].as_str().expect("a secret").to_string();
    let link = relay.post(&root, "view-links", &json!({ "name": "hall", "hours": 1 })).await.body;
    let link = link["url"].as_str().expect("an address").rsplit('/').next().expect("a secret").to_string();
    let mistyped = "my-mistyped-password";
    // Everything is used, also wrongly, and from elsewhere.
    for (name, password) in [("root", mistyped), (mistyped, PASSWORD)] {
        let reply = relay.rest.post("session", &json!({ "name": name, "password": password })).await;
        assert_eq!(reply.status, 401, "{reply:?}");
    }
    for (header, value) in [("authorization", format!("Bearer {token}")), ("cookie", root.cookie.clone())] {
        let request = relay.rest.request(Method::GET, "blocks").header(header, &value);
        assert_eq!(Rest::send(request).await.status, 200);
        let request = relay.rest.request(Method::GET, "blocks").header(header, format!("{value}0"));
        assert_eq!(Rest::send(request).await.status, 401);
        let mut request =
            format!("ws://{}/api/v1/ws", relay.address).into_client_request().expect("a request");
        request.headers_mut().insert(header, value.parse().expect("a header"));
        drop(connect_async(request).await.expect("the relay takes a WebSocket"));
    }
    let opened = |host: String| {
        let request = relay.rest.request(Method::GET, &format!("../../view/{link}")).header("host", host);
        Rest::send(request)
    };
    assert_ne!(opened(relay.address.clone()).await.status, 401);
    assert_eq!(opened("evil.example".to_string()).await.status, 403);
    let change = json!({ "old": PASSWORD, "new": format!("{PASSWORD} again") });
    let changed = relay.post(&root, "session/password", &change).await.status;
    assert!(matches!(changed, 204 | 429), "{changed}");
    let mut relay = relay;
    relay.process.interrupt();
    relay.process.ended(PATIENCE).await;

    let cookie = root.cookie.split_once('=').expect("a cookie").1;
    let token = token.rsplit('_').next().expect("a secret");
    let plain = code.replace('-', "");
    let secrets = [PASSWORD, mistyped, &plain, cookie, &root.csrf, token, &link];
    let log = relay.process.output();
    assert!(log.iter().any(|line| line.contains("TRACE")), "the finest level");
    let log =
        log.iter().filter(|line| !line.starts_with("set-up code: ")).cloned().collect::<Vec<_>>().join("\n");
    let mut artefacts = vec![("the log".to_string(), log.into_bytes())];
    for entry in std::fs::read_dir(folder.path()).expect("a folder") {
        let path = entry.expect("an entry").path();
        if path.is_file() {
            artefacts.push((path.display().to_string(), std::fs::read(&path).expect("a file")));
        }
    }
    assert!(artefacts.len() >= 3, "log, database, audit: {}", artefacts.len());
    for (name, bytes) in &artefacts {
        for secret in secrets.iter().copied().chain([code.as_str()]) {
            let at = bytes.windows(secret.len()).position(|window| window == secret.as_bytes());
            let around =
                at.map(|at| String::from_utf8_lossy(&bytes[at.saturating_sub(200)..at + 80]).into_owned());
            assert_eq!(around, None, "{secret} is in {name}");
        }
    }
}

#[tokio::test]
async fn a_script_believes_the_certificate_that_the_relay_has_printed_and_no_other() {
    let folder = TempDir::new().expect("a folder");
    let config = folder.path().join("cipdeck.toml");
    std::fs::write(&config, "listen = \"127.0.0.1:0\"\n[tls]\n").expect("a file");
    let block = folder.path().join("block.json");
    std::fs::write(&block, block::get("0,0", 1, 1, 7).to_string()).expect("a file");
    let data = folder.path().join("data");
    let path = |path: &Path| path.to_str().expect("a path in UTF-8").to_string();
    let arguments = ["serve", "--config", &path(&config), "--data", &path(&data)];
    let process = Process::start(&tools::cipdeck(), arguments);
    let after = |prefix: &'static str| move |line: &str| Some(line.strip_prefix(prefix)?.to_string());
    let address = process.line("where it listens", PATIENCE, after("cipdeck listens on https://")).await;
    let fingerprint = process.line("its certificate", PATIENCE, after("certificate SHA-256 ")).await;
    let url = format!("https://{address}");
    let run = async |fingerprint: &[&str]| {
        cipdeck(&[&["--relay", &url], fingerprint, &["run", &path(&block)]].concat()).await
    };
    let unknown = run(&[]).await;
    assert_eq!(unknown.code, 4, "{unknown:?}");
    assert!(unknown.stderr.contains("certificate"), "{unknown:?}");
    let other = fingerprint.replace(&fingerprint[..2], "00");
    let other = run(&["--fingerprint", &other]).await;
    assert!(other.code == 4 && other.stderr.contains(&fingerprint), "{other:?}");
    let right = run(&["--fingerprint", &fingerprint]).await;
    assert!(right.code == 4 && right.stderr.contains("there is no administrator yet"), "{right:?}");
}
