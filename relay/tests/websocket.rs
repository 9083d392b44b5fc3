//! The WebSocket over a real socket: who may connect, and how it ends.

#![expect(clippy::unwrap_used, reason = "a test ends where it fails")]

mod common;

use cipdeck_relay::Settings;
use futures_util::{SinkExt, StreamExt};
use serde_json::{Value, json};
use tokio_tungstenite::connect_async;
use tokio_tungstenite::tungstenite::client::IntoClientRequest;
use tokio_tungstenite::tungstenite::protocol::frame::coding::CloseCode;
use tokio_tungstenite::tungstenite::{Error, Message};

use self::common::{Relay, local};

type Socket = tokio_tungstenite::WebSocketStream<tokio_tungstenite::MaybeTlsStream<tokio::net::TcpStream>>;

async fn connect(relay: &Relay, headers: &[(&'static str, String)]) -> Result<Socket, Error> {
    let mut request = format!("ws://{}/api/v1/ws", relay.address).into_client_request().unwrap();
    for (name, value) in headers {
        request.headers_mut().insert(*name, value.parse().unwrap());
    }
    connect_async(request).await.map(|(socket, _)| socket)
}

async fn next(socket: &mut Socket) -> Value {
    let Some(Ok(Message::Text(text))) = socket.next().await else { panic!("a text message") };
    serde_json::from_str(&text).unwrap()
}

async fn close_code(socket: &mut Socket) -> CloseCode {
    loop {
        match socket.next().await {
            Some(Ok(Message::Close(Some(frame)))) => return frame.code,
            Some(Ok(_)) => {}
            other => panic!("a close frame, not {other:?}"),
        }
    }
}

#[tokio::test]
async fn the_conversation_is_as_documented() {
    let relay = Relay::start(local(Settings::in_memory())).await;
    let mut socket = connect(&relay, &[("origin", format!("http://{}", relay.address))]).await.unwrap();
    assert_eq!(
        next(&mut socket).await,
        json!({"type":"hello","protocol":2,"relay":env!("CARGO_PKG_VERSION")})
    );
    assert_eq!(next(&mut socket).await, json!({"type":"access","window":null,"read_only":false}));
    assert_eq!(next(&mut socket).await, json!({"type":"snapshot","seq":1,"blocks":[],"statuses":[]}));
    let block = json!({
        "name": "name", "AppCfg": {"Service": 14, "Class": 1, "Instance": 1, "Attribute": 7},
        "TargetCfg": {"Path": "0,0"},
    });
    relay.ask("POST", "/api/v1/blocks", &block.to_string()).await;
    let changes = next(&mut socket).await;
    assert_eq!(
        (&changes["type"], &changes["seq"], &changes["blocks"][0]["id"]),
        (&json!("changes"), &json!(2), &json!("b1"))
    );
    socket.send(Message::text(r#"{"type":"run","id":"c1","block":"b1"}"#)).await.unwrap();
    let answer = loop {
        let message = next(&mut socket).await;
        if message["type"] == "answer" {
            break message;
        }
    };
    assert_eq!((&answer["id"], &answer["status"]["Status"]["StatusBits"]), (&json!("c1"), &json!(17)));
    relay.ask("DELETE", "/api/v1/blocks/b1?revision=1", "").await;
    let removed = loop {
        let message = next(&mut socket).await;
        if message["removed"] != Value::Null {
            break message;
        }
    };
    assert_eq!(removed["removed"], json!(["b1"]));
    let (code, ()) = tokio::join!(close_code(&mut socket), relay.stop());
    assert_eq!(code, CloseCode::Away);
}

#[tokio::test]
async fn a_foreign_page_cannot_connect() {
    let relay = Relay::start(local(Settings::in_memory())).await;
    for (name, value) in
        [("origin", "http://foreign.example"), ("origin", "null"), ("host", "foreign.example")]
    {
        let refused = connect(&relay, &[(name, value.to_owned())]).await;
        let Err(Error::Http(response)) = refused else { panic!("{name}: {value}: {refused:?}") };
        assert_eq!(response.status(), 403, "{name}: {value}");
    }
    let plain = relay.ask("GET", "/api/v1/ws", "").await;
    assert_eq!(plain.problem(), (400, "unreadable".to_owned()));
    relay.stop().await;
}

#[tokio::test]
async fn messages_over_64_kib_close_with_1009() {
    let relay = Relay::start(local(Settings::in_memory())).await;
    for length in [64 * 1024 + 1, 200_000, 2_000_000] {
        let mut socket = connect(&relay, &[]).await.unwrap();
        // A relay that has closed already may break the write: what it said is still there to be read.
        let _ = socket.send(Message::text(" ".repeat(length))).await;
        assert_eq!(close_code(&mut socket).await, CloseCode::Size, "{length}");
    }
    relay.stop().await;
}
