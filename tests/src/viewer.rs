//! A client of the WebSocket, written from its document: it keeps the newest status of every block.

use std::collections::{BTreeMap, HashMap};
use std::time::Duration;

use futures_util::{SinkExt as _, StreamExt as _};
use serde_json::{Value, json};
use tokio::net::TcpStream;
use tokio_tungstenite::tungstenite::Message;
use tokio_tungstenite::tungstenite::client::IntoClientRequest as _;
use tokio_tungstenite::tungstenite::protocol::CloseFrame;
use tokio_tungstenite::{MaybeTlsStream, WebSocketStream, connect_async};

use crate::PATIENCE;
use crate::wait::within;

/// Somebody who watches the relay.
#[derive(Debug)]
pub struct Viewer {
    socket: WebSocketStream<MaybeTlsStream<TcpStream>>,
    /// What `hello` said.
    pub hello: Value,
    /// The newest `access`: the write window and the switch.
    pub access: Value,
    /// `seq` of the newest snapshot or changes.
    pub seq: u64,
    /// Blocks by id.
    pub blocks: BTreeMap<String, Value>,
    /// Newest statuses by block id.
    pub statuses: BTreeMap<String, Value>,
    /// StatusBits of all edges of each block, in the order in which they came.
    pub edges: BTreeMap<String, Vec<u64>>,
    answers: HashMap<String, Value>,
    commands: u64,
}

impl Viewer {
    /// Connects, and has seen `hello` and the first snapshot.
    pub async fn connect(address: impl std::fmt::Display) -> Self {
        Self::connect_with(address, &[]).await
    }

    /// Connects with more headers: a cookie, a token.
    pub async fn connect_with(address: impl std::fmt::Display, headers: &[(&'static str, &str)]) -> Self {
        let mut request = format!("ws://{address}/api/v1/ws").into_client_request().expect("an address");
        for (name, value) in headers {
            request.headers_mut().insert(*name, value.parse().expect("a value of a header"));
        }
        let (socket, _) = connect_async(request).await.expect("the relay takes a WebSocket");
        let mut viewer = Self {
            socket,
            hello: Value::Null,
            access: Value::Null,
            seq: 0,
            blocks: BTreeMap::new(),
            statuses: BTreeMap::new(),
            edges: BTreeMap::new(),
            answers: HashMap::new(),
            commands: 0,
        };
        viewer.hello = viewer.next().await;
        assert_eq!(viewer.hello["type"], "hello", "the first message");
        let access = viewer.next().await;
        assert_eq!(access["type"], "access", "the second message");
        viewer.take(&access);
        let snapshot = viewer.next().await;
        assert_eq!(snapshot["type"], "snapshot", "the third message");
        viewer.take(&snapshot);
        viewer
    }

    /// Runs a block; the status at DN or ER.
    pub async fn run(&mut self, block: &str) -> Value {
        let answer = self.command(json!({ "type": "run", "block": block })).await;
        answered(&answer)
    }

    /// Sets IN.
    pub async fn set_in(&mut self, block: &str, input: bool) -> Value {
        let answer = self.command(json!({ "type": "in", "block": block, "IN": input })).await;
        answered(&answer)
    }

    /// Cancels what is running.
    pub async fn cancel(&mut self, block: &str) -> Value {
        let answer = self.command(json!({ "type": "cancel", "block": block })).await;
        answered(&answer)
    }

    /// Sends a command with an id of its own and waits for its answer, whatever it is.
    pub async fn command(&mut self, command: Value) -> Value {
        let id = self.submit(command).await;
        self.answer(&id).await
    }

    /// Sends a command with an id of its own; the id.
    pub async fn submit(&mut self, mut command: Value) -> String {
        self.commands += 1;
        let id = format!("c{}", self.commands);
        command["id"] = json!(id);
        self.send_text(command.to_string()).await;
        id
    }

    /// Waits for the answer to a command.
    pub async fn answer(&mut self, id: &str) -> Value {
        self.wait_until("the answer to a command", PATIENCE, |viewer| viewer.answers.remove(id)).await
    }

    /// Sends any text.
    pub async fn send_text(&mut self, text: String) {
        self.socket.send(Message::text(text)).await.expect("the relay reads");
    }

    /// Reads until `found` gives a value; fails the test when `limit` has passed.
    pub async fn wait_until<T>(
        &mut self,
        what: &str,
        limit: Duration,
        mut found: impl FnMut(&mut Self) -> Option<T>,
    ) -> T {
        within(what, limit, async {
            loop {
                if let Some(value) = found(self) {
                    return value;
                }
                let message = self.next().await;
                self.take(&message);
            }
        })
        .await
    }

    /// Waits until the newest status of a block fulfils `condition`; that status.
    pub async fn status_where(
        &mut self,
        what: &str,
        limit: Duration,
        block: &str,
        condition: impl Fn(&Value) -> bool,
    ) -> Value {
        let found =
            |viewer: &mut Self| viewer.statuses.get(block).filter(|status| condition(status)).cloned();
        self.wait_until(what, limit, found).await
    }

    /// Reads until the relay closes; its close frame.
    pub async fn closed(&mut self, limit: Duration) -> Option<CloseFrame> {
        within("the relay closes the WebSocket", limit, async {
            loop {
                match self.socket.next().await {
                    Some(Ok(Message::Close(frame))) => return frame,
                    Some(Ok(_)) => {}
                    Some(Err(_)) | None => return None,
                }
            }
        })
        .await
    }

    /// Reads one message, whatever it is.
    pub async fn news(&mut self) {
        let message = self.next().await;
        self.take(&message);
    }

    async fn next(&mut self) -> Value {
        within("a message of the relay", PATIENCE, async {
            loop {
                match self.socket.next().await {
                    Some(Ok(Message::Text(text))) => return serde_json::from_str(&text).expect("JSON"),
                    Some(Ok(Message::Ping(_) | Message::Pong(_))) => {}
                    other => panic!("the relay ended the WebSocket: {other:?}"),
                }
            }
        })
        .await
    }

    fn take(&mut self, message: &Value) {
        match message["type"].as_str() {
            Some("snapshot") => {
                self.blocks.clear();
                self.statuses.clear();
                self.count(message, false);
            }
            Some("changes") => self.count(message, true),
            Some("answer") => {
                let id = message["id"].as_str().expect("an answer has an id");
                self.answers.insert(id.to_string(), message.clone());
                return;
            }
            Some("access") => {
                self.access = message.clone();
                return;
            }
            other => panic!("a message of type {other:?}"),
        }
        for block in each(message, "blocks") {
            self.blocks.insert(id_of(block, "id"), block.clone());
        }
        for status in each(message, "statuses") {
            let id = id_of(status, "block");
            let edges = status["edges"].as_array().into_iter().flatten().filter_map(|edge| edge[1].as_u64());
            self.edges.entry(id.clone()).or_default().extend(edges);
            self.statuses.insert(id, status.clone());
        }
        for removed in each(message, "removed") {
            let id = removed.as_str().expect("an id");
            self.blocks.remove(id);
            self.statuses.remove(id);
        }
    }

    /// Changes have no gap; only a snapshot may follow one.
    fn count(&mut self, message: &Value, contiguous: bool) {
        let seq = message["seq"].as_u64().expect("seq");
        assert!(!contiguous || seq == self.seq + 1, "changes {seq} after {}", self.seq);
        self.seq = seq;
    }
}

fn answered(answer: &Value) -> Value {
    assert!(answer["problem"].is_null(), "the command is carried out: {answer}");
    answer["status"].clone()
}

fn each<'a>(message: &'a Value, member: &str) -> impl Iterator<Item = &'a Value> {
    message[member].as_array().into_iter().flatten()
}

fn id_of(value: &Value, member: &str) -> String {
    value[member].as_str().unwrap_or_else(|| panic!("{member} in {value}")).to_string()
}
