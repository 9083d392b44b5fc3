//! A relay in this process, and the smallest HTTP client that can ask it.

#![allow(dead_code, reason = "each test takes what it needs")]

use std::net::SocketAddr;

use cipdeck_relay::{RunError, Settings};
use cipdeck_shared::api::Role;
use tokio::io::{AsyncReadExt, AsyncWriteExt};
use tokio::net::{TcpListener, TcpStream};
use tokio::sync::oneshot;
use tokio::task::JoinHandle;

/// For whoever is at this machine, and for devices on it.
pub(crate) fn local(settings: Settings) -> Settings {
    settings.with_local(Role::Engineer).allowing("127.0.0.1:* via *")
}

/// A running relay.
#[derive(Debug)]
pub(crate) struct Relay {
    /// Where it listens.
    pub(crate) address: SocketAddr,
    stop: oneshot::Sender<()>,
    task: JoinHandle<Result<(), RunError>>,
}

impl Relay {
    /// Starts one on a free port.
    pub(crate) async fn start(settings: Settings) -> Self {
        let listener = TcpListener::bind("127.0.0.1:0").await.unwrap();
        let address = listener.local_addr().unwrap();
        let (stop, stopped) = oneshot::channel();
        let task = tokio::spawn(cipdeck_relay::run(settings, listener, async {
            let _ = stopped.await;
        }));
        Self { address, stop, task }
    }

    /// Stops it as a signal would, and waits for its end.
    pub(crate) async fn stop(self) {
        self.stop.send(()).unwrap();
        self.task.await.unwrap().unwrap();
    }

    /// One request with the usual headers.
    pub(crate) async fn ask(&self, method: &str, path: &str, body: &str) -> Reply {
        Self::ask_at(self.address, method, path, body).await
    }

    /// One request to a relay at this address.
    pub(crate) async fn ask_at(address: SocketAddr, method: &str, path: &str, body: &str) -> Reply {
        request(address, method, path, &[("Host", &address.to_string())], body).await
    }
}

/// One request with these headers.
pub(crate) async fn request(
    address: SocketAddr,
    method: &str,
    path: &str,
    headers: &[(&str, &str)],
    body: &str,
) -> Reply {
    let headers: String = headers.iter().map(|(name, value)| [name, ": ", value, "\r\n"].concat()).collect();
    let has_type = headers.to_lowercase().contains("content-type:");
    let headers = if has_type { headers } else { format!("{headers}Content-Type: application/json\r\n") };
    let length = body.len();
    let text = format!(
        "{method} {path} HTTP/1.1\r\nConnection: close\r\nContent-Length: {length}\r\n{headers}\r\n{body}"
    );
    let mut socket = TcpStream::connect(address).await.unwrap();
    socket.write_all(text.as_bytes()).await.unwrap();
    let mut reply = Vec::new();
    socket.read_to_end(&mut reply).await.unwrap();
    Reply::read(&String::from_utf8(reply).unwrap())
}

/// What came back.
#[derive(Debug)]
pub(crate) struct Reply {
    pub(crate) status: u16,
    pub(crate) headers: String,
    pub(crate) body: String,
}

impl Reply {
    fn read(text: &str) -> Self {
        let (head, body) = text.split_once("\r\n\r\n").expect("a head and a body");
        let (first, headers) = head.split_once("\r\n").expect("headers");
        let status = first.split(' ').nth(1).unwrap().parse().unwrap();
        Self { status, headers: headers.to_lowercase(), body: body.to_owned() }
    }

    /// The body as JSON.
    pub(crate) fn json(&self) -> serde_json::Value {
        serde_json::from_str(&self.body).unwrap_or_else(|error| panic!("{error}: {self:?}"))
    }

    /// The `code` of a problem.
    pub(crate) fn problem(&self) -> (u16, String) {
        assert!(self.headers.contains("content-type: application/problem+json"), "{self:?}");
        assert_eq!(self.json()["status"], self.status);
        (self.status, self.json()["code"].as_str().unwrap().to_owned())
    }
}
