//! What targets that nobody here wrote answer on the wire. These tests know no product code: they pin down the
//! peers, so that a change of a peer is not mistaken for a change of ours.

use cipdeck_tests::frame::{Frame, HEADER, REGISTER_SESSION, SEND_RR_DATA, encapsulate, unconnected};
use cipdeck_tests::peers::{CiplinkAdapter, Cpppo};
use cipdeck_tests::wait::within;
use cipdeck_tests::{PATIENCE, block};
use tokio::io::AsyncWriteExt as _;
use tokio::net::TcpStream;

const PRODUCT_NAME: [u8; 8] = [0x0E, 0x03, 0x20, 0x01, 0x24, 0x01, 0x30, 0x07];
const VENDOR_ID: [u8; 8] = [0x0E, 0x03, 0x20, 0x01, 0x24, 0x01, 0x30, 0x01];
const ATTRIBUTE_99: [u8; 8] = [0x0E, 0x03, 0x20, 0x01, 0x24, 0x01, 0x30, 0x63];
const CLASS_238: [u8; 8] = [0x0E, 0x03, 0x20, 0xEE, 0x24, 0x01, 0x30, 0x01];

#[tokio::test]
async fn ciplink_answers_its_identity_and_refuses_a_class() {
    let adapter = CiplinkAdapter::start();
    let mut session = RawSession::open(&adapter.address().to_string()).await;
    let name = block::short_string(CiplinkAdapter::PRODUCT_NAME);
    assert_eq!(session.ask(&PRODUCT_NAME).await, (0, format!("8e000000{name}")));
    assert_eq!(session.ask(&VENDOR_ID).await, (0, "8e0000000100".into()));
    assert_eq!(session.ask(&ATTRIBUTE_99).await, (0, "8e001400".into()));
    assert_eq!(session.ask(&CLASS_238).await, (0, "8e000500".into()));
}

#[tokio::test]
async fn cpppo_answers_a_class_it_does_not_have_with_an_encapsulation_status() {
    let cpppo = Cpppo::start().await;
    let mut session = RawSession::open(cpppo.path().trim_start_matches("4,")).await;
    let name = block::hex(Cpppo::PRODUCT_NAME.as_bytes());
    assert_eq!(
        session.ask(&PRODUCT_NAME).await,
        (0, format!("8e000000{:02x}{name}", Cpppo::PRODUCT_NAME.len()))
    );
    assert_eq!(session.ask(&ATTRIBUTE_99).await, (0, "8e000800".into()));
    assert_eq!(session.ask(&CLASS_238).await, (0x08, String::new()));
}

struct RawSession {
    stream: TcpStream,
    handle: u32,
}

impl RawSession {
    async fn open(address: &str) -> Self {
        let stream = TcpStream::connect(address).await.expect("the peer listens");
        let mut session = Self { stream, handle: 0 };
        session.handle = session.exchange(REGISTER_SESSION, &[1, 0, 0, 0]).await.session();
        session
    }

    /// The encapsulation status, and the message router bytes as hexadecimal text.
    async fn ask(&mut self, message: &[u8]) -> (u32, String) {
        let reply = self.exchange(SEND_RR_DATA, &unconnected(message)).await;
        let bytes = if reply.0.len() > HEADER { reply.message() } else { &[] };
        (reply.status(), block::hex(bytes))
    }

    async fn exchange(&mut self, command: u16, data: &[u8]) -> Frame {
        let frame = encapsulate(command, self.handle, 0, *b"any text", data);
        self.stream.write_all(&frame).await.expect("the peer reads");
        let reply = within("an answer", PATIENCE, Frame::read(&mut self.stream)).await.expect("a frame");
        assert_eq!((reply.command(), reply.context()), (command, *b"any text"));
        reply
    }
}
