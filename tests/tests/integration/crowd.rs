//! Many connections, and slow ones: others are answered all the same.

use std::net::SocketAddr;

use cipdeck_tests::PATIENCE;
use cipdeck_tests::relay::Relay;
use cipdeck_tests::rest::Rest;
use cipdeck_tests::wait::within;
use futures_util::StreamExt as _;
use futures_util::stream;
use tokio::io::{AsyncReadExt as _, AsyncWriteExt as _};
use tokio::net::{TcpSocket, TcpStream};

/// A connection from another address of this machine, that sends `text`.
async fn from(address: &str, to: SocketAddr, text: &str) -> Option<TcpStream> {
    let socket = TcpSocket::new_v4().ok()?;
    socket.bind(SocketAddr::new(address.parse().ok()?, 0)).ok()?;
    let mut stream = socket.connect(to).await.ok()?;
    // One too many is closed at once.
    stream.write_all(text.as_bytes()).await.ok()?;
    Some(stream)
}

async fn is_open(stream: &mut TcpStream) -> bool {
    let read = tokio::time::timeout(std::time::Duration::from_millis(1), stream.read(&mut [0; 64])).await;
    read.is_err()
}

#[cfg(target_os = "linux")]
#[tokio::test]
async fn ten_thousand_connections_of_one_client_keep_nobody_else_out() {
    let relay = Relay::start().await;
    let mut viewer = relay.viewer().await;
    let id = relay.rest.create(&cipdeck_tests::block::product_name("0,0")).await;
    let to = relay.address;
    let mut held = Vec::new();
    for thousand in 1..=10 {
        let crowd = stream::iter(0..1_000).map(|_| from("127.0.0.2", to, "GET / HTTP/1.1\r\n"));
        let arrived: Vec<_> = crowd.buffer_unordered(64).filter_map(std::future::ready).collect().await;
        for mut stream in arrived {
            if is_open(&mut stream).await {
                held.push(stream);
            }
        }
        assert!(held.len() <= 128, "one client has {} connections", held.len());
        // A new connection from here, and the one that has been there before.
        let health = within("a newcomer is answered", PATIENCE, async { Rest::new(to).get("health").await });
        assert_eq!(health.await.status, 200, "after {thousand},000 connections");
        assert_eq!(viewer.run(&id).await["Q"], true);
    }
    assert!(held.len() > 100, "{} are held", held.len());
    relay.stop().await;
}

#[cfg(target_os = "linux")]
#[tokio::test]
async fn all_seats_together_are_bounded_and_free_again_when_the_crowd_goes() {
    let relay = Relay::start().await;
    let to = relay.address;
    let mut held = Vec::new();
    for client in 2..=6 {
        for _ in 0..128 {
            if let Some(stream) = from(&format!("127.0.0.{client}"), to, "GET").await {
                held.push(stream);
            }
        }
    }
    let mut open = 0;
    for stream in &mut held {
        open += usize::from(is_open(stream).await);
    }
    assert_eq!(open, 512);
    drop(held);
    let answered = cipdeck_tests::wait::eventually("the seats are free", PATIENCE, async || {
        let mut stream = TcpStream::connect(to).await.ok()?;
        let text = format!("GET /api/v1/health HTTP/1.1\r\nHost: {to}\r\nConnection: close\r\n\r\n");
        stream.write_all(text.as_bytes()).await.ok()?;
        let mut reply = String::new();
        stream.read_to_string(&mut reply).await.ok()?;
        reply.starts_with("HTTP/1.1 200").then_some(())
    });
    answered.await;
    relay.stop().await;
}
