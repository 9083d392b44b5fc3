//! Finding devices with `ListIdentity`, on loopback only.

use std::net::SocketAddr;

use cipdeck_tests::command::{Ended, Service, cipdeck};
use cipdeck_tests::frame::encapsulate;
use cipdeck_tests::peers::Cpppo;
use cipdeck_tests::relay::Relay;
use cipdeck_tests::rest::Rest;
use reqwest::Method;
use serde_json::{Value, json};
use tokio::net::UdpSocket;
use tokio::task::JoinHandle;

const LIST_IDENTITY: u16 = 0x63;
const LIST_SERVICES: u16 = 0x04;

#[tokio::test]
async fn the_simulated_device_introduces_itself() {
    let simulator = Service::simulate("127.0.0.1:0", &[]).await;
    let port: u16 = simulator.address.rsplit(':').next().unwrap().parse().unwrap();
    let ended = cipdeck(&["discover", &simulator.address, "--timeout", "2000", "--json"]).await;
    assert_eq!(ended.code, 0, "{ended:?}");
    assert_eq!(
        ended.json(),
        json!([{
            "address": "127.0.0.1", "port": port,
            "vendor": "0xffff", "vendor_id": 65535,
            "device_type": "AC Drive Device", "device_type_id": 2,
            "product_code": 1, "revision": "1.001",
            "status": "no I/O connection", "status_word": 0x30,
            "serial": "00c1dec0", "name": "cipdeck demo drive",
            "state": "operational", "state_code": 3,
        }])
    );
    let ended = cipdeck(&["discover", &simulator.address, "--timeout", "2000"]).await;
    assert_eq!(ended.code, 0, "{ended:?}");
    let lines: Vec<_> = ended.stdout.lines().collect();
    assert_eq!(lines.len(), 2, "{ended:?}");
    assert_eq!(lines[0].find("name"), lines[1].find("cipdeck demo drive"), "{ended:?}");
}

#[tokio::test]
async fn cpppo_introduces_itself() {
    let cpppo = Cpppo::start().await;
    let ended = cipdeck(&["discover", &cpppo.udp().to_string(), "--timeout", "3000", "--json"]).await;
    let devices = ended.json();
    assert_eq!(devices.as_array().map(Vec::len), Some(1), "{ended:?}");
    assert_eq!(devices[0]["name"], Cpppo::PRODUCT_NAME);
    assert_eq!(devices[0]["vendor"], "Rockwell Automation / Allen-Bradley");
    assert_eq!(devices[0]["device_type"], "Programmable Logic Controller");
    assert_eq!(devices[0]["revision"], "20.011");
    assert_eq!(ended.code, 0, "{ended:?}");
}

#[tokio::test]
async fn garbage_and_repetitions_do_not_hide_the_devices() {
    let responder = Responder::start("127.0.0.1:0", |context| {
        let good = identity(*context, 7, "pump");
        let mut refused = good.clone();
        refused[8] = 1;
        vec![
            b"nonsense".to_vec(),
            encapsulate(LIST_IDENTITY, 0, 0, *context, &[]),
            encapsulate(LIST_SERVICES, 0, 0, *context, &good[24..]),
            good[..good.len() - 3].to_vec(),
            refused,
            good.clone(),
            good,
            // Another device behind the same address, which does not send the context back.
            identity([0; 8], 8, "fan"),
        ]
    })
    .await;
    let ended = cipdeck(&["discover", &responder.address, "--timeout", "2000", "--json"]).await;
    assert_eq!(ended.code, 0, "{ended:?}");
    assert_eq!(members(&ended.json(), "name"), ["pump", "fan"]);
    assert_eq!(members(&ended.json(), "serial"), ["00000007", "00000008"]);
    assert_eq!(members(&ended.json(), "announced"), ["10.1.2.3:44818", "10.1.2.3:44818"]);
}

#[tokio::test]
async fn one_question_of_24_bytes_is_asked() {
    let socket = UdpSocket::bind("127.0.0.1:0").await.unwrap();
    let address = socket.local_addr().unwrap().to_string();
    nobody(&cipdeck(&["discover", &address, "--timeout", "400"]).await);
    let mut buffer = [0; 64];
    assert_eq!(socket.try_recv(&mut buffer).unwrap(), 24);
    assert_eq!(buffer[..12], [0x63, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0]);
    assert_eq!(buffer[12..14], [200, 0], "devices may take half of the time");
    assert!(socket.try_recv(&mut buffer).is_err(), "and no second one");
}

/// The loopback network is the only one that a test may shout into.
#[cfg(target_os = "linux")]
#[tokio::test]
async fn everybody_in_an_own_network_is_asked_by_its_broadcast_address() {
    let responder =
        Responder::start("127.255.255.255:0", |context| vec![identity(*context, 7, "pump")]).await;
    let ended = cipdeck(&["discover", &responder.address, "--timeout", "2000", "--json"]).await;
    assert_eq!(members(&ended.json(), "name"), ["pump"], "{ended:?}");
    assert_eq!(members(&ended.json(), "address"), ["127.0.0.1"], "who has answered, not who was asked");
}

#[tokio::test]
async fn a_silent_network_exits_with_4_and_says_what_to_try() {
    let silent = UdpSocket::bind("127.0.0.1:0").await.unwrap();
    let address = silent.local_addr().unwrap().to_string();
    let ended = cipdeck(&["discover", &address, "--timeout", "100", "--json"]).await;
    assert_eq!(ended.stdout.trim(), "[]");
    nobody(&ended);
    assert!(ended.stderr.contains("--timeout"), "{ended:?}");
}

#[tokio::test]
async fn what_may_not_be_asked_exits_with_2() {
    for (address, word) in [
        ("203.0.113.255", "this machine's own networks"),
        ("255.255.255.255", "this machine's own networks"),
        ("239.192.1.1", "multicast"),
        ("0.0.0.0", "not the address of a device"),
        ("drive-1", "192.168.1.100:44818"),
        ("[::1]:44818", "not an IPv4 address"),
    ] {
        let ended = cipdeck(&["discover", address, "--json"]).await;
        assert_eq!((ended.code, ended.stdout.as_str()), (2, ""), "{ended:?}");
        assert!(ended.stderr.contains(word), "{ended:?}");
    }
    for timeout in ["99", "10001", "soon"] {
        assert_eq!(cipdeck(&["discover", "127.0.0.1", "--timeout", timeout]).await.code, 2);
    }
}

#[tokio::test]
async fn rest_finds_the_same_devices() {
    let simulator = Service::simulate("127.0.0.1:0", &[]).await;
    let relay = Relay::start().await;
    let request = json!({ "addresses": [simulator.address], "timeout_ms": 2_000 });
    let reply = relay.rest.post("discover", &request).await;
    assert_eq!(reply.status, 200, "{reply:?}");
    assert_eq!(reply.body["errors"], json!([]));
    let by_command = cipdeck(&["discover", &simulator.address, "--timeout", "2000", "--json"]).await;
    assert_eq!(reply.body["devices"], by_command.json());
}

#[tokio::test]
async fn rest_refuses_what_it_does_not_ask() {
    let relay = Relay::start().await;
    for body in [
        json!({ "addresses": ["224.0.0.1"] }),
        json!({ "addresses": ["10.0.0.255"] }),
        json!({ "addresses": ["here"] }),
        json!({ "addresses": vec!["127.0.0.1"; 257] }),
        json!({ "addresses": ["127.0.0.1"], "timeout_ms": 99 }),
        json!({ "addresses": ["127.0.0.1"], "timeout_ms": 10_001 }),
        json!({ "addresses": ["127.0.0.1"], "timeout_ms": -1 }),
        json!({ "adresses": ["127.0.0.1"] }),
    ] {
        relay.rest.post("discover", &body).await.is_problem(400, "unreadable");
    }
    let foreign =
        relay.rest.request(Method::POST, "discover").header("origin", "http://evil.example").body("{}");
    Rest::send(foreign).await.is_problem(403, "not_permitted");
}

#[tokio::test]
async fn one_discovery_at_a_time() {
    let listener = UdpSocket::bind("127.0.0.1:0").await.unwrap();
    let relay = Relay::start().await;
    let body = json!({ "addresses": [listener.local_addr().unwrap().to_string()], "timeout_ms": 10_000 });
    let rest = relay.rest.clone();
    let first = tokio::spawn({
        let body = body.clone();
        async move { rest.post("discover", &body).await }
    });
    listener.recv(&mut [0; 64]).await.unwrap();
    relay.rest.post("discover", &body).await.is_problem(409, "busy");
    // Who goes away does not leave it locked.
    first.abort();
    let quick = json!({ "addresses": ["127.0.0.1:9"], "timeout_ms": 100 });
    let free = async || {
        let reply = relay.rest.post("discover", &quick).await;
        (reply.status == 200).then_some(())
    };
    cipdeck_tests::wait::eventually("the next one is made", cipdeck_tests::PATIENCE, free).await;
}

/// A device written by hand: what it sends for each question.
struct Responder {
    address: String,
    answering: JoinHandle<()>,
}

impl Responder {
    async fn start(listen: &str, answers: impl Fn(&[u8; 8]) -> Vec<Vec<u8>> + Send + 'static) -> Self {
        let ears = UdpSocket::bind(listen).await.expect("a free port");
        let address = ears.local_addr().expect("the port that is bound").to_string();
        // Nobody can speak from a broadcast address.
        let mouth = UdpSocket::bind("127.0.0.1:0").await.expect("a free port");
        let answering = tokio::spawn(async move {
            let mut question = [0; 64];
            loop {
                let (length, from): (usize, SocketAddr) =
                    ears.recv_from(&mut question).await.expect("a question");
                assert_eq!((length, question[0]), (24, 0x63));
                for answer in answers(question[12..20].try_into().expect("8 bytes")) {
                    mouth.send_to(&answer, from).await.expect("it is taken");
                }
            }
        });
        Self { address, answering }
    }
}

impl Drop for Responder {
    fn drop(&mut self) {
        self.answering.abort();
    }
}

/// A reply to ListIdentity, by hand: the device thinks that it is 10.1.2.3:44818.
fn identity(context: [u8; 8], serial: u32, name: &str) -> Vec<u8> {
    let length = |bytes: &[u8]| u8::try_from(bytes.len()).expect("a short item");
    let mut item = vec![1, 0, 0, 2, 0xAF, 0x12, 10, 1, 2, 3, 0, 0, 0, 0, 0, 0, 0, 0];
    item.extend([0x01, 0x00, 0x02, 0x00, 0x09, 0x00, 3, 12, 0x65, 0x00]);
    item.extend(serial.to_le_bytes());
    item.push(length(name.as_bytes()));
    item.extend(name.as_bytes());
    item.push(3);
    let mut data = vec![1, 0, 0x0C, 0x00, length(&item), 0];
    data.extend(item);
    encapsulate(LIST_IDENTITY, 0, 0, context, &data)
}

fn members<'a>(devices: &'a Value, member: &str) -> Vec<&'a str> {
    devices.as_array().into_iter().flatten().filter_map(|device| device[member].as_str()).collect()
}

fn nobody(ended: &Ended) {
    assert_eq!(ended.code, 4, "{ended:?}");
    assert!(ended.stderr.contains("nobody answered"), "{ended:?}");
}

/// A relay that asks wherever it is told would be a way into every network that it can reach.
#[tokio::test]
async fn rest_asks_nobody_whom_the_lists_do_not_allow() {
    let relay = Relay::start().await;
    for address in ["127.0.0.2", "203.0.113.7", "203.0.113.7:161"] {
        let body = json!({ "addresses": [address], "timeout_ms": 100 });
        relay.rest.post("discover", &body).await.is_problem(403, "not_permitted");
    }
}
