//! Our simulated device, asked by clients that nobody here wrote.

use std::net::SocketAddrV4;

use cipdeck_tests::PATIENCE;
use cipdeck_tests::command::Service;
use cipdeck_tests::peers::cpppo_client;
use cipdeck_tests::wait::within;
use ciplink::cip::{CipDriver, CipOptions, GenericMessage, GenericReply};
use rseip::ClientError;
use rseip::cip::codec::decode::message_reply::decode_unconnected_send;
use rseip::cip::epath::{EPath, PortSegment, Segment};
use rseip::cip::{MessageReply, MessageRequest};
use rseip::client::{EipClient, EipConnection, EipContext, OpenOptions};
use rseip::precludes::{CommonServices as _, MessageService as _};
use tokio::net::TcpStream;

/// The input assembly as eight UDINTs: the first is a count of milliseconds.
type Input = [u32; 8];

#[tokio::test]
async fn rseip_reads_the_simulated_device() {
    let device = Service::simulate("127.0.0.1:0", &[]).await;
    let stream = TcpStream::connect(&device.address).await.expect("it listens");
    let mut context = EipContext::<_, ClientError>::new(stream);
    context.register_session().await.expect("a session");
    let packet = context.send_rrdata(MessageRequest::new(0x0E, current(), ())).await.expect("a reply");
    let reply: MessageReply<f32> = decode_unconnected_send(packet).expect("a REAL");
    assert!((3.1..5.3).contains(&reply.data), "{}", reply.data);
    context.unregister_session().await.expect("the end");
    assert_eq!(counters(device).await, counted(1, 0, 0, 0));
}

#[tokio::test]
async fn rseip_reads_through_the_chassis() {
    let device = Service::simulate("127.0.0.1:0", &[]).await;
    for (slot, serial) in [(0, 0x00C1_DEC0), (1, 0x00C1_DEC1), (3, 0x00C1_DEC3)] {
        let mut client = EipClient::new(address(&device)).with_connection_path(backplane(slot));
        let found: u32 = client.get_attribute_single(path(1, 1, 6)).await.expect("a serial number");
        assert_eq!(found, serial, "slot {slot}");
        client.close().await.expect("the end");
    }
    let mut client = EipClient::new(address(&device)).with_connection_path(backplane(9));
    let refused: Result<u32, _> = client.get_attribute_single(path(1, 1, 6)).await;
    let refused = refused.expect_err("slot 9 is empty").to_string();
    assert!(refused.contains("extended status: 786"), "0x0312: {refused}");
    assert_eq!(counters(device).await, counted(4, 0, 0, 0));
}

#[tokio::test]
async fn rseip_reads_a_moving_value_over_a_connection() {
    for route in [None, Some(0), Some(1)] {
        let device = Service::simulate("127.0.0.1:0", &["--delay", "1"]).await;
        let mut connection = EipConnection::new(address(&device), options(route));
        let mut moments = Vec::new();
        for _ in 0..100 {
            let read = connection.get_attribute_single::<Input>(path(4, 100, 3));
            let [millis, .., output] = within("rseip gets a reply", PATIENCE, read).await.expect("the input");
            assert_eq!(output, 0, "what nobody has written");
            moments.push(millis);
        }
        assert!(moments.is_sorted() && moments[99] >= moments[0] + 99, "a millisecond each: {moments:?}");
        connection.close().await.expect("Forward_Close is answered");
        assert_eq!(counters(device).await, counted(0, 1, 100, 1), "{route:?}");
    }
}

#[tokio::test]
async fn ciplink_reads_through_the_chassis_and_over_a_connection() {
    let device = Service::simulate("127.0.0.1:0", &["--delay", "1"]).await;
    let routed = GenericMessage { connected: false, unconnected_send: true, ..name() };
    let asked = ask(&device, "/bp/1", vec![routed]).await;
    assert_eq!(asked[0].data(), Some(&b"\x10cipdeck demo I/O"[..]));
    let asked = ask(&device, "/bp/3/enet/192.168.1.20", vec![name(); 2]).await;
    assert_eq!(asked[1].data(), Some(&b"\x13cipdeck demo remote"[..]));
    let input =
        GenericMessage { class_code: 4.into(), instance: 100.into(), attribute: Some(3.into()), ..name() };
    let asked = ask(&device, "", vec![input; 100]).await;
    let moments: Vec<_> = asked.iter().map(millis).collect();
    assert!(moments.is_sorted() && moments[99] >= moments[0] + 99, "a millisecond each: {moments:?}");
    assert_eq!(counters(device).await, counted(1, 2, 102, 2));
}

#[tokio::test]
async fn ciplink_falls_back_to_a_small_connection() {
    for flags in [&["--no-large"][..], &["--connection-size", "500"]] {
        let device = Service::simulate("127.0.0.1:0", flags).await;
        let asked = ask(&device, "", vec![name()]).await;
        assert_eq!(asked[0].data(), Some(&b"\x12cipdeck demo drive"[..]), "{flags:?}");
        assert_eq!(counters(device).await, counted(0, 1, 1, 1), "{flags:?}");
    }
}

#[tokio::test]
async fn rseip_is_told_that_there_are_no_more_connections() {
    let device = Service::simulate("127.0.0.1:0", &["--max-connections", "1"]).await;
    let mut first = EipConnection::new(address(&device), options(None));
    let serial: u32 = first.get_attribute_single(path(1, 1, 6)).await.expect("a serial number");
    assert_eq!(serial, 0x00C1_DEC0);
    let mut second = EipConnection::new(address(&device), options(None));
    let refused: Result<u32, _> = second.get_attribute_single(path(1, 1, 6)).await;
    let refused = refused.expect_err("one is all").to_string();
    assert!(refused.contains("forward open failed"), "{refused}");
    first.close().await.expect("Forward_Close is answered");
    assert_eq!(counters(device).await, counted(0, 1, 1, 1));
}

#[tokio::test]
async fn cpppo_reads_the_simulated_device() {
    let device = Service::simulate("127.0.0.1:0", &[]).await;
    // Several requests are written before the first answer is read.
    let tags = ["-S", "-a", &device.address, "@1/1/7", "@1/1/2", "@4/100/4", "@238/1/1", "@1/1/7"];
    let said = cpppo_client("get_attribute", &tags).await;
    assert_eq!(said.matches(&product_name(1, "cipdeck demo drive")).count(), 2, "{said}");
    assert!(said.contains("@0x00EE/1/1 == None"), "a class that is not there: {said}");
}

#[tokio::test]
async fn cpppo_reads_through_the_chassis() {
    let device = Service::simulate("127.0.0.1:0", &[]).await;
    for (route, name) in [
        ("1/0", "cipdeck demo drive"),
        ("1/1", "cipdeck demo I/O"),
        ("2/192.168.1.20", "cipdeck demo remote"),
        ("1/3/2/192.168.1.20", "cipdeck demo remote"),
    ] {
        let arguments = ["-a", &device.address, "--route-path", route, "@1/1/7"];
        let said = cpppo_client("get_attribute", &arguments).await;
        assert!(said.contains(&product_name(1, name)), "{route}: {said}");
    }
}

#[tokio::test]
async fn cpppo_finds_the_simulated_device() {
    let device = Service::simulate("127.0.0.1:0", &[]).await;
    for more in [&["--udp"][..], &[]] {
        let arguments = [&["--list-identity", "-a", &device.address], more].concat();
        let said = cpppo_client("client", &arguments).await;
        assert!(said.contains("cipdeck demo drive"), "{more:?}: {said}");
    }
}

/// What it says when it is stopped.
async fn counters(mut device: Service) -> String {
    device.process.interrupt();
    device.process.ended(PATIENCE).await;
    let last = |line: &str| line.starts_with("unconnected ").then(|| line.to_owned());
    device.process.line("what it has done", PATIENCE, last).await
}

fn counted(unconnected: u32, opened: u32, connected: u32, closed: u32) -> String {
    format!(
        "unconnected {unconnected}, connections opened {opened}, connected requests {connected}, closed {closed}, \
         timed out 0, unregistered 0, repeated 0, dropped 0"
    )
}

fn address(device: &Service) -> SocketAddrV4 {
    device.address.parse().expect("an IPv4 address")
}

/// `class/instance/attribute`, as rseip builds it.
fn path(class: u16, instance: u16, attribute: u16) -> EPath {
    EPath::from(vec![Segment::Class(class), Segment::Instance(instance), Segment::Attribute(attribute)])
}

/// Output current of the drive: moves.
fn current() -> EPath {
    path(147, 7, 9)
}

fn backplane(slot: u8) -> EPath {
    EPath::from(vec![Segment::Port(PortSegment { port: 1, link: vec![slot].into() })])
}

/// A connection to the message router, with a hop or without.
fn options(slot: Option<u8>) -> OpenOptions {
    let mut path = slot.map(backplane).unwrap_or_default();
    path.push(Segment::Class(2));
    path.push(Segment::Instance(1));
    // Its own interval is 17 ms: a pause of the machine would end the connection.
    OpenOptions::default().connection_path(path).o_t_rpi(2_000_000).t_o_rpi(2_000_000)
}

/// The product name, over a connection.
fn name() -> GenericMessage {
    GenericMessage {
        service: 0x0E,
        class_code: 1.into(),
        instance: 1.into(),
        attribute: Some(7.into()),
        ..GenericMessage::default()
    }
}

/// Opens ciplink's client, which blocks, asks, and closes it.
async fn ask(device: &Service, route: &str, messages: Vec<GenericMessage>) -> Vec<GenericReply> {
    let path = format!("{}{route}", device.address);
    let asked = tokio::task::spawn_blocking(move || {
        let driver = CipDriver::new(&path, CipOptions::default()).expect("a path");
        assert!(driver.open().expect("ciplink connects"), "a session");
        let ask = |message| driver.generic_message(message).expect("ciplink gets a reply");
        let replies = messages.iter().map(ask).collect();
        driver.close().expect("ciplink closes");
        replies
    });
    within("ciplink is done", PATIENCE, asked).await.expect("ciplink does not panic")
}

fn millis(reply: &GenericReply) -> u32 {
    let [b0, b1, b2, b3, ..] = reply.data().expect("the input") else { panic!("too short: {reply:?}") };
    u32::from_le_bytes([*b0, *b1, *b2, *b3])
}

/// As cpppo prints it.
fn product_name(instance: u32, name: &str) -> String {
    let length = u8::try_from(name.len()).expect("a short name");
    let bytes: Vec<_> = [length].iter().chain(name.as_bytes()).map(u8::to_string).collect();
    format!("@0x0001/{instance}/7 == [{}]", bytes.join(", "))
}
