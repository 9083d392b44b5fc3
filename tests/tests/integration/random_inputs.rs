//! Sign-ins, tokens, cookies and WebSocket frames that nobody would send, in great number.

use cipdeck_tests::PATIENCE;
use cipdeck_tests::block;
use cipdeck_tests::fake_plc::{self, FakePlc};
use cipdeck_tests::managed::{Managed, PASSWORD};
use cipdeck_tests::measure::measured;
use cipdeck_tests::random::Random;
use cipdeck_tests::rest::{Reply, Rest};
use cipdeck_tests::wait::within;
use futures_util::{SinkExt as _, StreamExt as _, stream};
use reqwest::{Method, RequestBuilder};
use serde_json::{Value, json};
use tokio::net::TcpStream;
use tokio_tungstenite::tungstenite::Message;
use tokio_tungstenite::tungstenite::client::IntoClientRequest as _;
use tokio_tungstenite::tungstenite::protocol::frame::Frame;
use tokio_tungstenite::tungstenite::protocol::frame::coding::{Data, OpCode};
use tokio_tungstenite::{MaybeTlsStream, WebSocketStream, connect_async};

/// How many, unless `CIPDECK_RANDOM_INPUTS` says otherwise; `cargo xtask test --long` says 1,000,000.
const INPUTS: usize = 20_000;

/// Frames between two looks at what has been answered.
const BATCH: usize = 64;

/// What the relay may take more at the end than at the beginning: two passwords at once, and what allocators keep.
const MEMORY: u64 = 64 * 1024 * 1024;

#[tokio::test]
async fn random_sign_ins_and_messages_open_nothing() {
    let count = std::env::var("CIPDECK_RANDOM_INPUTS").map_or(INPUTS, |text| text.parse().expect("a number"));
    let relay = Managed::start().await;
    let plc = FakePlc::start(fake_plc::answering(&[])).await;
    let (engineer, viewer) = (relay.user("engineer").await, relay.user("viewer").await);
    let block = engineer.create(&block::set(&plc.path(), 4, 150, 3, "01020304")).await;
    let lists = listed(&relay).await;
    assert_eq!(block, "b1", "as the commands name it");

    let began = std::time::Instant::now();
    let mut statuses = std::collections::BTreeMap::new();
    let mut memory = vec![relay.process.memory()];
    for (tenth, share) in (0..10).map(|tenth| (tenth, count / 20)) {
        let (answered, (), ()) = tokio::join!(
            requests(&relay, tenth, share),
            frames(&relay.address, &viewer, 100 + tenth, share / 2),
            frames(&relay.address, &engineer, 200 + tenth, share / 2),
        );
        for status in answered {
            *statuses.entry(status).or_insert(0) += 1;
        }
        memory.push(relay.process.memory());
    }
    let audit = std::fs::metadata(relay.folder().join("audit.jsonl")).expect("the audit").len();
    let log = relay.process.output();
    measured(format!(
        "{count} inputs in {:?}: answers {statuses:?}, {memory:?} bytes of memory, {audit} bytes of audit, {} lines of log",
        began.elapsed(),
        log.len(),
    ));
    assert!(memory[10] <= memory[0] + MEMORY, "memory grows: {memory:?}");
    assert!(!log.iter().any(|line| line.contains("panicked")), "{}", log.join("\n"));
    assert_eq!(plc.requests().len(), 0, "no device has heard of it");

    // Who is right comes in: at once from where nobody has guessed, after a wait from where somebody has.
    let form = json!({ "name": "root", "password": PASSWORD });
    let somebody = Rest::new(&relay.address);
    let admin = somebody.calling_from([127, 0, 0, 99].into()).sign_in("session", &form).await;
    assert_eq!(listed_by(&admin).await, lists, "nothing has changed");
    let there = somebody.calling_from([127, 0, 0, 2].into()).post("session", &form).await;
    assert!(there.status == 200 || waits(&there), "{there:?}");
}

/// What could have been changed.
async fn listed(relay: &Managed) -> Vec<Value> {
    listed_by(&relay.admin).await
}

async fn listed_by(admin: &Rest) -> Vec<Value> {
    let mut all = Vec::new();
    for path in
        ["blocks", "devices", "tokens", "view-links", "allow/targets", "allow/writes", "window", "read-only"]
    {
        all.push(admin.get(path).await.body);
    }
    let users = admin.get("users").await.body;
    let names = users.as_array().into_iter().flatten().map(|user| json!([user["name"], user["role"]]));
    all.extend(names);
    all
}

/// 429 with a wait that ends.
fn waits(reply: &Reply) -> bool {
    let seconds = reply.headers.get("retry-after").and_then(|value| value.to_str().ok()?.parse().ok());
    reply.status == 429 && seconds.is_some_and(|seconds: u64| (1..=301).contains(&seconds))
}

/// From eight addresses, sixteen at once; the statuses.
async fn requests(relay: &Managed, seed: u64, count: usize) -> Vec<u16> {
    let mut random = Random::new(seed);
    let callers: Vec<_> =
        (2..10).map(|last| Rest::new(&relay.address).calling_from([127, 0, 0, last].into())).collect();
    let all = (0..count).map(|number| request(&callers[number % 8], &mut random));
    let answers = stream::iter(all).map(async |(request, what)| {
        let reply = within("an answer", PATIENCE, Rest::send(request)).await;
        let is_refused = (400..500).contains(&reply.status) || reply.status == 503;
        assert!(is_refused && reply.cookie().is_none(), "{what:?}: {reply:?}");
        assert!(reply.status != 429 || waits(&reply), "{reply:?}");
        reply.status
    });
    answers.buffer_unordered(16).collect().await
}

/// A request that must not open anything, and what is special about it.
fn request(rest: &Rest, random: &mut Random) -> (RequestBuilder, String) {
    let body = |path: &str, body: Vec<u8>| {
        let text = String::from_utf8_lossy(&body).chars().take(500).collect();
        (rest.request(Method::POST, path).header("content-type", "application/json").body(body), text)
    };
    let secret = |random: &mut Random, right: &str| {
        let bytes = random.mutated(right.as_bytes());
        let text = String::from_utf8_lossy(&bytes).replace(|c: char| !c.is_ascii_graphic(), "");
        if text.trim() == right { format!("{text}x") } else { text }
    };
    match random.below(10) {
        0 => body("session", random.hard()),
        1 => {
            let length = random.below(200);
            body("session", random.bytes(length))
        }
        2 => {
            let code = json!({ "code": "0000-0000-0000", "name": "root", "password": PASSWORD }).to_string();
            body("setup", random.mutated(code.as_bytes()))
        }
        3 => {
            let token =
                secret(random, "cdt_1_0123456789abcdef0123456789abcdef0123456789abcdef0123456789abcdef");
            (rest.request(Method::GET, "blocks").header("authorization", format!("Bearer {token}")), token)
        }
        4 => {
            let value = secret(random, "0123456789abcdef0123456789abcdef0123456789abcdef0123456789abcdef");
            let cookie = format!("{}={value}", random.pick(&["__Host-cipdeck", "__Host-cipdeck-view"]));
            (rest.request(Method::GET, "users").header("cookie", &cookie), cookie)
        }
        5 => {
            let name =
                random.pick(&["root", "engineer", "viewer", "nobody", "", "ROOT", "root ", "r\u{f6}\u{f6}t"]);
            let password = String::from_utf8_lossy(&random.bytes(16)).into_owned();
            body("session", json!({ "name": name, "password": password }).to_string().into_bytes())
        }
        _ => {
            let form = json!({ "name": "root", "password": PASSWORD });
            let mut bytes = random.mutated(form.to_string().as_bytes());
            if serde_json::from_slice::<Value>(&bytes).is_ok_and(|read| read == form) {
                bytes.pop();
            }
            body("session", bytes)
        }
    }
}

type Socket = WebSocketStream<MaybeTlsStream<TcpStream>>;

async fn open(address: &str, cookie: &str) -> Socket {
    let mut request = format!("ws://{address}/api/v1/ws").into_client_request().expect("an address");
    request.headers_mut().insert("cookie", cookie.parse().expect("a cookie"));
    let connected = within("a WebSocket", PATIENCE, connect_async(request)).await;
    connected.expect("the relay takes a WebSocket").0
}

/// Frames over the WebSocket of somebody who is signed in, and has no write window.
async fn frames(address: &str, person: &Rest, seed: u64, count: usize) {
    let mut random = Random::new(seed);
    let cookie = person.header("cookie");
    let mut socket = open(address, cookie).await;
    for batch in 0..count.div_ceil(BATCH) {
        for _ in 1..BATCH {
            socket.feed(frame(&mut random)).await.expect("the relay reads");
        }
        if random.below(4) == 0 {
            // The relay may close after this one, without harm to anybody else.
            let _ = socket.send(breaking(&mut random)).await;
            within("the end of the WebSocket", PATIENCE, async {
                while let Some(Ok(message)) = socket.next().await {
                    check(&message);
                }
            })
            .await;
            socket = open(address, cookie).await;
            continue;
        }
        let id = format!("marker-{batch}");
        let marker = json!({ "type": "in", "id": id, "block": "b1", "IN": true }).to_string();
        socket.send(Message::text(marker)).await.expect("the relay reads");
        within("the answer to the last command", PATIENCE, async {
            while check(&socket.next().await.expect("it is open").expect("a message")) != Some(id.clone()) {}
        })
        .await;
    }
}

/// Nothing is carried out; the id of an answer.
fn check(message: &Message) -> Option<String> {
    let Message::Text(text) = message else { return None };
    let said: Value = serde_json::from_str(text).expect("JSON");
    assert!(said["type"] != "access" || said["window"].is_null(), "a write window is open: {said}");
    if said["type"] != "answer" {
        return None;
    }
    let status = &said["status"];
    assert!(status.is_null() || (status["IN"] == false && status["runs"] == 0), "something was sent: {said}");
    said["id"].as_str().map(str::to_owned)
}

/// One that a WebSocket survives.
fn frame(random: &mut Random) -> Message {
    let ticket = block::hex(&random.bytes(16));
    let command = match random.below(4) {
        0 => json!({ "type": "run", "id": "r", "block": "b1" }),
        1 => json!({ "type": "run", "id": "t", "block": "b1", "ticket": ticket }),
        2 => json!({ "type": "in", "id": "i", "block": "b1", "IN": true, "ticket": ticket }),
        _ => json!({ "type": "cancel", "id": "c", "block": "b1" }),
    };
    let command = command.to_string();
    match random.below(10) {
        0 => Message::binary(random.mutated(command.as_bytes())),
        1 => {
            let length = random.below(125);
            Message::Ping(random.bytes(length).into())
        }
        2 => Message::text(String::from_utf8_lossy(&random.hard()).into_owned()),
        3 => Message::text(command),
        _ => Message::text(String::from_utf8_lossy(&random.mutated(command.as_bytes())).into_owned()),
    }
}

/// One that is against the rules of WebSockets, or too long.
fn breaking(random: &mut Random) -> Message {
    let length = random.below(200);
    let payload = random.bytes(length);
    let frame = |payload: Vec<u8>, code, is_final| Frame::message(payload, OpCode::Data(code), is_final);
    match random.below(4) {
        0 => Message::Frame(frame([&[0xC3, 0x28, 0xFF][..], &payload].concat(), Data::Text, true)),
        1 => Message::Frame(frame(payload, Data::Reserved(3), true)),
        2 => Message::Frame(frame(payload, Data::Continue, true)),
        _ => Message::text("x".repeat(64 * 1024 + 1 + length)),
    }
}
