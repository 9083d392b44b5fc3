//! Whatever is cancelled, whenever: a target never sees half of a request followed by another one.

use std::collections::BTreeMap;
use std::sync::atomic::{AtomicBool, Ordering};
use std::sync::{Arc, Mutex, PoisonError};

use cipdeck_tests::PATIENCE;
use cipdeck_tests::block;
use cipdeck_tests::frame::{HEADER, REGISTER_SESSION, SEND_RR_DATA, UNREGISTER_SESSION, encapsulate};
use cipdeck_tests::relay::Relay;
use serde_json::json;
use tokio::io::{AsyncReadExt as _, AsyncWriteExt as _};
use tokio::net::{TcpListener, TcpStream};

/// What has come over each TCP connection.
type Streams = Arc<Mutex<BTreeMap<usize, Vec<u8>>>>;

#[tokio::test]
async fn a_target_that_reads_one_byte_at_a_time_sees_whole_requests_only() {
    let listener = TcpListener::bind(("127.0.0.1", 0)).await.expect("a free port");
    let path = format!("4,{}", listener.local_addr().expect("the port that is bound"));
    let streams = Streams::default();
    let answers = Arc::new(AtomicBool::new(false));
    let target = tokio::spawn(read_slowly(listener, Arc::clone(&streams), Arc::clone(&answers)));

    let relay = Relay::start().await;
    let mut viewer = relay.viewer().await;
    let long = block::with(block::product_name(&path), "/ReqData", "a5".repeat(400));
    let ids = [relay.rest.create(&long).await, relay.rest.create(&long).await];
    for round in 0..40 {
        let id = &ids[round % 2];
        let run = viewer.submit(json!({ "type": "run", "block": id })).await;
        match round % 4 {
            0 => {}
            1 => {
                viewer
                    .status_where("it is on its way", PATIENCE, id, |status| status["phase"] == "sent")
                    .await;
            }
            // Some bytes of it have arrived.
            2 => tokio::task::yield_now().await,
            _ => {
                viewer.submit(json!({ "type": "run", "block": ids[(round + 1) % 2] })).await;
            }
        }
        viewer.cancel(id).await;
        viewer.cancel(&ids[(round + 1) % 2]).await;
        let answer = viewer.answer(&run).await;
        assert_eq!(answer["status"]["Status"]["ErrorID"], 217, "cancelled: {answer}");
    }
    answers.store(true, Ordering::Relaxed);
    let runs = viewer.run(&ids[0]).await;
    assert_eq!(runs["Q"], true, "and then one that nobody cancels: {runs}");
    relay.stop().await;
    target.abort();

    let streams = streams.lock().unwrap_or_else(PoisonError::into_inner);
    assert!(streams.len() > 5, "sockets were replaced: {}", streams.len());
    let requests: usize = streams.values().map(|stream| requests_in(stream)).sum();
    assert!(requests > 0);
}

/// How many whole messages there are; what is cut short is the end of its connection.
fn requests_in(mut stream: &[u8]) -> usize {
    let mut requests = 0;
    while stream.len() >= HEADER {
        let command = u16::from_le_bytes([stream[0], stream[1]]);
        let length = HEADER + usize::from(u16::from_le_bytes([stream[2], stream[3]]));
        assert!([REGISTER_SESSION, UNREGISTER_SESSION, SEND_RR_DATA].contains(&command), "{stream:02x?}");
        assert!(length <= 600, "{stream:02x?}");
        let Some((frame, rest)) = stream.split_at_checked(length) else { return requests };
        if command == SEND_RR_DATA {
            assert!(frame.ends_with(&[0xA5; 400]), "all of its own bytes: {frame:02x?}");
            requests += 1;
        }
        stream = rest;
    }
    requests
}

async fn read_slowly(listener: TcpListener, streams: Streams, answers: Arc<AtomicBool>) {
    let mut connections = tokio::task::JoinSet::new();
    for number in 0.. {
        let Ok((stream, _)) = listener.accept().await else { return };
        connections.spawn(converse(stream, number, Arc::clone(&streams), Arc::clone(&answers)));
    }
}

/// Answers messages only when it is told to.
async fn converse(
    mut stream: TcpStream,
    number: usize,
    streams: Streams,
    answers: Arc<AtomicBool>,
) -> std::io::Result<()> {
    let mut frame = Vec::new();
    loop {
        let byte = stream.read_u8().await?;
        tokio::task::yield_now().await;
        frame.push(byte);
        streams.lock().unwrap_or_else(PoisonError::into_inner).entry(number).or_default().push(byte);
        if frame.len() < HEADER
            || frame.len() < HEADER + usize::from(u16::from_le_bytes([frame[2], frame[3]]))
        {
            continue;
        }
        let context = frame[12..20].try_into().unwrap_or_default();
        let reply = match u16::from_le_bytes([frame[0], frame[1]]) {
            REGISTER_SESSION => encapsulate(REGISTER_SESSION, 7, 0, context, &[1, 0, 0, 0]),
            SEND_RR_DATA if !answers.load(Ordering::Relaxed) => Vec::new(),
            SEND_RR_DATA => {
                let data = cipdeck_tests::frame::unconnected(&[0x8E, 0, 0, 0]);
                encapsulate(SEND_RR_DATA, 7, 0, context, &data)
            }
            _ => return Ok(()),
        };
        stream.write_all(&reply).await?;
        frame.clear();
    }
}
