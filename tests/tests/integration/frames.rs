//! Wireshark understands every frame that we write, and every frame of others that our codec is tested with.

use std::time::SystemTime;

use cipdeck_relay::capture::{CaptureFile, Conversation, Direction, Ends};
use cipdeck_shared::engine::time::Instant;
use cipdeck_shared::sim::{Device, SimConnection};
use cipdeck_shared::wire::{
    Command, ConnectedMessage, ConnectionId, ConnectionParameters, ConnectionTriad, Encapsulation, Epath,
    ForwardClose, ForwardOpen, ForwardOpenReply, Header, MessageRouterReply, PortSegment, RegisterSession,
    RequestTimeout, SendRrData, SenderContext, SessionHandle, TimeoutMultiplier, UnconnectedMessage,
    UnconnectedSend,
};
use cipdeck_tests::tshark::{Capture, USUAL_PORT};
use tempfile::TempDir;

#[path = "../../../shared/tests/common/mod.rs"]
mod golden;

const PRODUCT_NAME: [u8; 8] = [0x0E, 0x03, 0x20, 0x01, 0x24, 0x01, 0x30, 0x07];

#[tokio::test]
async fn every_frame_of_the_suite() {
    let at = SystemTime::now();
    let mut file = CaptureFile::new(Vec::new()).unwrap();
    let mut conversations: Vec<(String, Conversation)> = Vec::new();
    let frames = golden::frames();
    for (name, frame) in &frames {
        let answer = ["_reply", "_refused"].into_iter().find_map(|ending| name.strip_suffix(ending));
        let subject = answer.or_else(|| name.strip_suffix("_request")).unwrap_or(name);
        if conversations.last().is_none_or(|(last, _)| last != subject) {
            // Each request with its reply on a connection of its own: together they are no dialogue.
            let number = u16::try_from(conversations.len()).unwrap();
            let ends = Ends {
                local: ([10, 0, 0, 1], 50_000 + number).into(),
                peer: ([10, 0, 0, 2], USUAL_PORT).into(),
            };
            let (conversation, packets) = Conversation::open(ends, at);
            file.write(&packets).unwrap();
            conversations.push((subject.to_owned(), conversation));
        }
        let (_, conversation) = conversations.last_mut().unwrap();
        let direction = if answer.is_some() { Direction::In } else { Direction::Out };
        file.write(&conversation.data(direction, frame, at)).unwrap();
    }
    let (capture, _folder) = Capture::stored(file, USUAL_PORT);
    capture.is_clean().await;
    assert_eq!(capture.packets("enip").await.len(), frames.len());
}

#[tokio::test]
async fn routes() {
    let mut dialogue = Dialogue::start();
    let hop = |port, slot| PortSegment::new(port, slot).unwrap();
    let device = |address: &str| PortSegment::with_address(2, address.as_bytes()).unwrap();
    for route in [
        vec![hop(1, 0)],
        vec![hop(1, 3), device("192.168.1.20")],
        // Padded, and not.
        vec![device("192.168.1.10"), hop(1, 1)],
        vec![device("192.168.100.101")],
        vec![hop(1, 9)],
        vec![hop(7, 0)],
        vec![hop(300, 0)],
        vec![PortSegment::with_address(300, b"192.168.1.2").unwrap()],
    ] {
        let route = route.into_iter().fold(Epath::default(), Epath::hop);
        let timeout = RequestTimeout::at_least(3_000);
        let request = UnconnectedSend { timeout, message: &PRODUCT_NAME, route }.request().unwrap();
        dialogue.unconnected(&request.bytes());
    }
    let (capture, _folder) = dialogue.end();
    capture.is_clean().await;
    assert_eq!(capture.counts("cip.service", ["0x52", "0x8e", "0xd2"]).await, [8, 3, 5]);
    assert_eq!(capture.counts("cip.cm.ext_status", ["0x0204", "0x0311", "0x0312"]).await, [1, 3, 1]);
    // 4 x 752 ms, rounded up to what a tick can say.
    let timeouts = capture.field("cip.service == 0x52", "cip.cm.timeout").await;
    assert!(timeouts.iter().all(|timeout| timeout == "3008"), "{timeouts:?}");
}

#[tokio::test]
async fn connections() {
    let mut dialogue = Dialogue::start();
    for (large, size) in [(true, 4_000), (false, 504)] {
        let open = open(u16::from(large), size);
        let reply = dialogue.unconnected(&open.request(large).unwrap().bytes());
        let reply = MessageRouterReply::decode(&reply).unwrap();
        let id = ForwardOpenReply::decode(reply.data).unwrap().o_t_id;
        for sequence in 1..=3 {
            dialogue.connected(id, sequence, &PRODUCT_NAME);
        }
        let close = ForwardClose { timeout: open.timeout, triad: open.triad, path: open.path };
        let close = close.request().unwrap().bytes();
        dialogue.unconnected(&close);
        // There is nothing left to close.
        dialogue.unconnected(&close);
    }
    let (capture, _folder) = dialogue.end();
    capture.is_clean().await;
    assert_eq!(capture.counts("enip.command", ["0x0070"]).await, [12]);
    let services = ["0x5b", "0xdb", "0x54", "0xd4", "0x0e", "0x8e", "0x4e", "0xce"];
    assert_eq!(capture.counts("cip.service", services).await, [1, 1, 1, 1, 6, 6, 4, 4]);
    assert_eq!(capture.packets("cip.service & 0x80 && cip.genstat != 0").await.len(), 2, "the second closes");
}

/// A client of the wire level and the simulated device, without sockets.
struct Dialogue {
    device: Device,
    connection: SimConnection,
    now: Instant,
    session: SessionHandle,
    conversation: Conversation,
    file: CaptureFile<Vec<u8>>,
}

impl Dialogue {
    /// With a session.
    fn start() -> Self {
        let ends = Ends { local: ([10, 0, 0, 1], 50_000).into(), peer: ([10, 0, 0, 2], USUAL_PORT).into() };
        let (conversation, packets) = Conversation::open(ends, SystemTime::now());
        let mut file = CaptureFile::new(Vec::new()).expect("memory takes everything");
        file.write(&packets).expect("memory takes everything");
        let (device, connection) = (Device::default(), SimConnection::new());
        let mut dialogue =
            Self { device, connection, now: Instant::ZERO, session: SessionHandle(0), conversation, file };
        let version = RegisterSession::CURRENT.bytes();
        let reply = dialogue.exchange(&frame(dialogue.header(Command::RegisterSession), &version));
        dialogue.session = Encapsulation::decode(&reply).expect("a frame").header.session;
        dialogue
    }

    /// The message router reply.
    fn unconnected(&mut self, message: &[u8]) -> Vec<u8> {
        let mut out = Vec::new();
        let header = self.header(Command::SendRRData);
        UnconnectedMessage::new(message).expect("a short message").encode(&header, 0, &mut out);
        let reply = self.exchange(&out);
        let frame = Encapsulation::decode(&reply).expect("a frame");
        let data = SendRrData::decode(frame.data()).expect("a common packet");
        data.unconnected().expect("a message").data.to_vec()
    }

    fn connected(&mut self, id: ConnectionId, sequence: u16, message: &[u8]) {
        let mut out = Vec::new();
        let header = self.header(Command::SendUnitData);
        ConnectedMessage::new(message).expect("a short message").encode(&header, id, sequence, &mut out);
        self.exchange(&out);
    }

    fn end(mut self) -> (Capture, TempDir) {
        let farewell = frame(self.header(Command::UnRegisterSession), &[]);
        self.record(Direction::Out, &farewell);
        Capture::stored(self.file, USUAL_PORT)
    }

    fn exchange(&mut self, request: &[u8]) -> Vec<u8> {
        self.record(Direction::Out, request);
        self.connection.handle_input(&mut self.device, request, self.now);
        let mut reply = Vec::new();
        if !self.connection.poll_transmit(&mut reply, self.now) {
            // A router waits for a device that does not answer.
            self.now = self.connection.poll_timeout().expect("the device will answer");
            assert!(self.connection.poll_transmit(&mut reply, self.now), "the device answers");
        }
        self.record(Direction::In, &reply);
        reply
    }

    fn record(&mut self, direction: Direction, bytes: &[u8]) {
        let packets = self.conversation.data(direction, bytes, SystemTime::now());
        self.file.write(&packets).expect("memory takes everything");
    }

    fn header(&self, command: Command) -> Header {
        Header::request(command, self.session, SenderContext::from(7))
    }
}

fn open(serial: u16, size: u16) -> ForwardOpen {
    let interval = 2_000_000;
    ForwardOpen {
        timeout: RequestTimeout::at_least(3_000),
        o_t_id: ConnectionId(0),
        t_o_id: ConnectionId(0x1122_3344),
        triad: ConnectionTriad { serial, vendor: 0x1337, originator: 0xDEAD_BEEF },
        multiplier: TimeoutMultiplier(3),
        o_t_rpi_us: interval,
        o_t: ConnectionParameters::explicit(size),
        t_o_rpi_us: interval,
        t_o: ConnectionParameters::explicit(size),
        transport: ForwardOpen::CLASS_3,
        path: Epath::object(2, 1),
    }
}

fn frame(header: Header, data: &[u8]) -> Vec<u8> {
    let mut out = Vec::new();
    Encapsulation::new(header, data).expect("a short frame").encode(&mut out);
    out
}
