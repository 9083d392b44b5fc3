//! Over real sockets: who is answered where, and who is cut off.

use std::sync::Arc;
use std::time::Duration;

use axum::extract::ConnectInfo;
use axum::extract::ws::{WebSocket, WebSocketUpgrade};
use axum::routing::get;
use rustls::ClientConfig;
use rustls::pki_types::pem::PemObject;
use rustls::pki_types::{CertificateDer, ServerName};
use tempfile::TempDir;
use tokio::io::{AsyncRead, AsyncReadExt, AsyncWrite, AsyncWriteExt};
use tokio::net::TcpStream;
use tokio::sync::mpsc;
use tokio::task::JoinHandle;
use tokio::time::Instant;
use tokio_rustls::TlsConnector;

use super::*;
use crate::metrics::Metrics;
use crate::settings::Limits;

/// A relay's doors, in this process.
struct House {
    folder: TempDir,
    is_set_up: watch::Sender<bool>,
    heard: mpsc::UnboundedReceiver<Listening>,
    task: JoinHandle<RunError>,
}

impl House {
    async fn open(change: impl FnOnce(&mut Settings)) -> Self {
        let folder = TempDir::new().unwrap();
        let mut settings = Settings::stored_in(folder.path());
        change(&mut settings);
        let tls = tls(&settings).unwrap();
        let limits = settings.limits;
        let seats = Seats::new(limits.connections, limits.connections_per_client, Metrics::default());
        let site = Site { listen: settings.listen, tls, seats, router: Box::new(|_, _| router()) };
        let listener = bind("127.0.0.1:0".parse().unwrap()).await.unwrap();
        let is_set_up = watch::Sender::new(false);
        let (say, heard) = mpsc::unbounded_channel();
        let mut ready = move |listening: &Listening| drop(say.send(listening.clone()));
        let mut doors = Doors::open(listener, &site, is_set_up.subscribe(), &mut ready).await.unwrap();
        let task = tokio::spawn(async move { doors.keep(&site, &mut ready).await });
        Self { folder, is_set_up, heard, task }
    }

    async fn listening(&mut self) -> Listening {
        self.heard.recv().await.unwrap()
    }

    /// A connection that trusts the relay's own certificate and nothing else.
    async fn secure(&self, address: SocketAddr) -> impl AsyncRead + AsyncWrite + Unpin {
        let chain = std::fs::read(self.folder.path().join("tls/cert.pem")).unwrap();
        let mut roots = rustls::RootCertStore::empty();
        roots.add(CertificateDer::from_pem_slice(&chain).unwrap()).unwrap();
        let provider = Arc::new(rustls::crypto::ring::default_provider());
        let config = ClientConfig::builder_with_provider(provider)
            .with_safe_default_protocol_versions()
            .unwrap()
            .with_root_certificates(roots)
            .with_no_client_auth();
        let name = ServerName::try_from("localhost").unwrap();
        let socket = TcpStream::connect(address).await.unwrap();
        TlsConnector::from(Arc::new(config)).connect(name, socket).await.unwrap()
    }
}

fn router() -> Router {
    Router::new()
        .route("/", get(|ConnectInfo(peer): ConnectInfo<SocketAddr>| async move { peer.ip().to_string() }))
        .route(
            "/ws",
            get(|upgrade: WebSocketUpgrade| async {
                upgrade.on_upgrade(async |mut socket: WebSocket| while socket.recv().await.is_some() {})
            }),
        )
}

impl Drop for House {
    fn drop(&mut self) {
        self.task.abort();
    }
}

async fn ask(mut stream: impl AsyncRead + AsyncWrite + Unpin) -> String {
    let text = "GET / HTTP/1.1\r\nHost: localhost\r\nConnection: close\r\n\r\n";
    stream.write_all(text.as_bytes()).await.unwrap();
    let mut reply = String::new();
    stream.read_to_string(&mut reply).await.unwrap();
    reply
}

#[tokio::test]
async fn until_there_is_an_administrator_only_this_machine_is_answered_and_then_only_with_tls() {
    let mut house = House::open(|settings| settings.listen = "0.0.0.0:0".parse().unwrap()).await;
    let first = house.listening().await;
    assert!(first.address.ip().is_loopback() && first.fingerprint.is_none(), "{first:?}");
    let plain = ask(TcpStream::connect(first.address).await.unwrap()).await;
    assert!(plain.starts_with("HTTP/1.1 200") && plain.ends_with("127.0.0.1"), "{plain}");

    house.is_set_up.send(true).unwrap();
    let second = house.listening().await;
    assert!(second.address.ip().is_unspecified(), "{second:?}");
    assert!(second.to_string().contains("certificate SHA-256 "), "{second}");
    TcpStream::connect(first.address).await.expect_err("nothing listens there any more");
    let port = second.address.port();
    let address = SocketAddr::from(([127, 0, 0, 1], port));
    let secure = ask(house.secure(address).await).await;
    assert!(secure.starts_with("HTTP/1.1 200"), "{secure}");
    let mut plain = TcpStream::connect(address).await.unwrap();
    plain.write_all(b"GET / HTTP/1.1\r\nHost: localhost\r\n\r\n").await.unwrap();
    let mut reply = Vec::new();
    let _ = plain.read_to_end(&mut reply).await;
    assert!(!reply.starts_with(b"HTTP"), "plain HTTP is not answered");
}

#[tokio::test]
async fn a_relay_with_an_administrator_starts_where_it_was_told_to() {
    // The port that the first listener has had.
    let free = bind("127.0.0.1:0".parse().unwrap()).await.unwrap().local_addr().unwrap().port();
    let mut house = House::open(|settings| settings.listen = ([0, 0, 0, 0], free).into()).await;
    let first = house.listening().await.address;
    house.is_set_up.send(true).unwrap();
    let second = house.listening().await.address;
    assert_eq!((second.port(), second == first), (free, false));
}

#[tokio::test]
async fn on_loopback_nothing_moves() {
    let mut house = House::open(|_| ()).await;
    let first = house.listening().await;
    house.is_set_up.send(true).unwrap();
    let reply = ask(TcpStream::connect(first.address).await.unwrap()).await;
    assert!(reply.starts_with("HTTP/1.1 200"), "{reply}");
    assert!(house.heard.try_recv().is_err());
}

#[tokio::test(start_paused = true)]
async fn who_sends_a_request_too_slowly_is_cut_off() {
    let mut house = House::open(|_| ()).await;
    let address = house.listening().await.address;
    let beginnings = ["", "G", "GET / HTTP/1.1\r\nHost: localhost\r\n"];
    for beginning in beginnings {
        let begun = Instant::now();
        let mut slow = TcpStream::connect(address).await.unwrap();
        slow.write_all(beginning.as_bytes()).await.unwrap();
        let mut reply = Vec::new();
        slow.read_to_end(&mut reply).await.unwrap();
        let took = begun.elapsed();
        assert!((14..=20).contains(&took.as_secs()), "{beginning:?} took {took:?}");
    }
}

#[tokio::test(start_paused = true)]
async fn who_does_not_finish_a_handshake_is_cut_off() {
    let tls = |settings: &mut Settings| settings.tls = Some(crate::settings::Tls::default());
    let mut house = House::open(tls).await;
    let address = house.listening().await.address;
    let begun = Instant::now();
    let mut slow = TcpStream::connect(address).await.unwrap();
    slow.write_all(b"\x16\x03\x01").await.unwrap();
    assert_eq!(slow.read_to_end(&mut Vec::new()).await.unwrap(), 0);
    assert!((9..=15).contains(&begun.elapsed().as_secs()), "{:?}", begun.elapsed());
}

#[tokio::test]
async fn a_connection_too_many_is_closed_at_once_and_a_websocket_keeps_its_seat() {
    let few = |settings: &mut Settings| {
        settings.limits = Limits { connections: 8, connections_per_client: 2, ..Limits::default() };
    };
    let mut house = House::open(few).await;
    let address = house.listening().await.address;
    let viewer = tokio_tungstenite::connect_async(format!("ws://{address}/ws")).await.unwrap();
    let second = TcpStream::connect(address).await.unwrap();
    // The third waits for nothing.
    let mut third = TcpStream::connect(address).await.unwrap();
    assert!(!matches!(third.read(&mut [0]).await, Ok(1..)));
    drop(viewer);
    drop(second);
    let deadline = Instant::now() + Duration::from_secs(10);
    loop {
        let mut stream = TcpStream::connect(address).await.unwrap();
        let text = "GET / HTTP/1.1\r\nHost: localhost\r\nConnection: close\r\n\r\n";
        let mut reply = String::new();
        let _ = stream.write_all(text.as_bytes()).await;
        if stream.read_to_string(&mut reply).await.is_ok() && reply.starts_with("HTTP/1.1 200") {
            break;
        }
        assert!(Instant::now() < deadline, "the seats are not free again");
    }
}
