//! A client of the WebSocket for devices, written from its document: it keeps the newest of everything.

use std::collections::{BTreeMap, BTreeSet};
use std::time::Duration;

use futures_util::{SinkExt as _, StreamExt as _};
use serde_json::{Value, json};
use tokio::net::TcpStream;
use tokio_tungstenite::tungstenite::Message;
use tokio_tungstenite::tungstenite::client::IntoClientRequest as _;
use tokio_tungstenite::tungstenite::protocol::CloseFrame;
use tokio_tungstenite::{MaybeTlsStream, WebSocketStream, connect_async};

use crate::wait::within;

/// Somebody who looks at values.
#[derive(Debug)]
pub struct LiveViewer {
    socket: WebSocketStream<MaybeTlsStream<TcpStream>>,
    /// What came last of each type.
    pub last: BTreeMap<String, Value>,
    /// Newest values by variable.
    pub values: BTreeMap<String, Value>,
    /// Newest statuses by device.
    pub statuses: BTreeMap<String, Value>,
    /// All times at which each variable was read.
    pub times: BTreeMap<String, BTreeSet<String>>,
}

impl LiveViewer {
    /// Connects, and has seen `hello`, `access` and the tree.
    pub async fn connect(address: impl std::fmt::Display) -> Self {
        Self::connect_with(address, &[]).await
    }

    /// Connects with more headers: a cookie, a token.
    pub async fn connect_with(address: impl std::fmt::Display, headers: &[(&'static str, &str)]) -> Self {
        let mut request = format!("ws://{address}/api/v1/live").into_client_request().expect("an address");
        for (name, value) in headers {
            request.headers_mut().insert(*name, value.parse().expect("a value of a header"));
        }
        let (socket, _) = connect_async(request).await.expect("the relay takes a WebSocket");
        let mut viewer = Self {
            socket,
            last: BTreeMap::new(),
            values: BTreeMap::new(),
            statuses: BTreeMap::new(),
            times: BTreeMap::new(),
        };
        for kind in ["hello", "access", "tree"] {
            viewer.take().await;
            assert!(viewer.last.contains_key(kind), "{kind} is missing: {:?}", viewer.last);
        }
        viewer
    }

    /// From now on the values of these groups.
    pub async fn watch(&mut self, groups: &[&str]) {
        self.say(&json!({ "type": "watch", "groups": groups }).to_string()).await;
    }

    /// Sends any text.
    pub async fn say(&mut self, text: &str) {
        self.socket.send(Message::text(text)).await.expect("the relay reads");
    }

    /// Reads until `found` gives a value; fails the test when `limit` has passed.
    pub async fn until<T>(
        &mut self,
        what: &str,
        limit: Duration,
        mut found: impl FnMut(&Self) -> Option<T>,
    ) -> T {
        within(what, limit, async {
            loop {
                if let Some(value) = found(self) {
                    return value;
                }
                self.take().await;
            }
        })
        .await
    }

    /// Reads until the relay closes, and why it does.
    pub async fn closed(&mut self, limit: Duration) -> Option<CloseFrame> {
        within("the relay closes", limit, async {
            loop {
                match self.socket.next().await {
                    Some(Ok(Message::Close(frame))) => return frame,
                    Some(Ok(_)) => {}
                    other => panic!("the end of the connection without a word: {other:?}"),
                }
            }
        })
        .await
    }

    /// Reads one message.
    pub async fn take(&mut self) {
        let message = loop {
            match self.socket.next().await.expect("the relay is there").expect("the relay speaks") {
                Message::Text(text) => break serde_json::from_str::<Value>(&text).expect("JSON"),
                Message::Close(frame) => panic!("the relay closed: {frame:?}"),
                _ => {}
            }
        };
        let list = |name: &str| message[name].as_array().cloned().unwrap_or_default();
        match message["type"].as_str().expect("a type") {
            "values" => {
                for value in list("values") {
                    let id = value["variable"].as_str().expect("an id").to_owned();
                    if let Some(at) = value["at"].as_str() {
                        // To the ms: the same reading may be told again.
                        let at = at.get(..23).unwrap_or(at).to_owned();
                        self.times.entry(id.clone()).or_default().insert(at);
                    }
                    self.values.insert(id, value);
                }
            }
            "status" => {
                for status in list("devices") {
                    let id = status["device"].as_str().expect("an id").to_owned();
                    self.statuses.insert(id, status);
                }
            }
            _ => {}
        }
        let kind = message["type"].as_str().expect("a type").to_owned();
        self.last.insert(kind, message);
    }
}
