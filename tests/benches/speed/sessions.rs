//! The clients that are compared: one open session of each.

use std::future::Future;
use std::net::SocketAddr;

use cipdeck_relay::client::{Client, Message};
use cipdeck_shared::config::{Channel, MsgCipGeneric};
use ciplink::cip::{CipDriver, CipOptions, GenericMessage};
use rseip::cip::codec::decode::message_reply::decode_unconnected_send;
use rseip::cip::{MessageReply, MessageRequest, epath};
use rseip::client::{EipClient, EipConnection, EipContext, OpenOptions};
use rseip::precludes::{CommonServices as _, MessageService as _};
use tokio::net::TcpStream;

use crate::way::Way;

/// An open session.
pub(crate) trait Session: Send + 'static {
    /// One request; panics unless it is answered well.
    fn ask(&mut self) -> impl Future<Output = ()> + Send;
    /// In order.
    fn close(self) -> impl Future<Output = ()> + Send;
}

/// One message of ours.
pub(crate) struct Ours(Message);

/// All share one client. Opens nothing yet: the first request does.
pub(crate) async fn ours(way: Way, targets: Vec<SocketAddr>) -> Vec<Ours> {
    let client = Client::start();
    let open = |target: &SocketAddr| {
        let hop = if way == Way::Routed { ",1,0" } else { "" };
        let mut config = MsgCipGeneric::product_name(&format!("4,{target}{hop}"));
        config.channel = Channel::Monitor;
        config.app_cfg.attribute = 1;
        config.target_cfg.cip_conn_mode = i64::from(way == Way::Connected);
        Ours(client.message(&config.into()).expect("a message that can be sent"))
    };
    targets.iter().map(open).collect()
}

impl Session for Ours {
    async fn ask(&mut self) {
        let answer = self.0.run().await.expect("it is started");
        assert!(answer.view.q, "{:?}", answer.view);
    }

    /// Its session ends with the message that uses it.
    async fn close(self) {}
}

/// A session of ciplink.
pub(crate) struct Ciplink {
    driver: CipDriver,
    message: GenericMessage,
}

impl Ciplink {
    /// With a session.
    pub(crate) fn open(way: Way, target: SocketAddr) -> Self {
        let route = if way == Way::Routed { "/bp/0" } else { "" };
        let driver = CipDriver::new(&format!("{target}{route}"), CipOptions::default()).expect("a path");
        assert!(driver.open().expect("ciplink connects"), "a session");
        let message = GenericMessage {
            service: 0x0E,
            class_code: 1_u32.into(),
            instance: 1_u32.into(),
            attribute: Some(1_u32.into()),
            connected: way == Way::Connected,
            unconnected_send: way == Way::Routed,
            ..GenericMessage::default()
        };
        Self { driver, message }
    }

    /// One request; panics unless it is answered well.
    pub(crate) fn ask(&self) {
        let reply = self.driver.generic_message(&self.message).expect("ciplink gets a reply");
        assert_eq!(reply.data().map(<[u8]>::len), Some(2), "a vendor's number");
    }

    /// In order.
    pub(crate) fn close(self) {
        self.driver.close().expect("ciplink closes");
    }
}

/// A session of rseip, which has three ways to talk.
#[expect(clippy::large_enum_variant, reason = "one per session")]
pub(crate) enum Rseip {
    /// Without a route.
    Unconnected(EipContext<TcpStream, rseip::ClientError>),
    /// With one.
    Routed(EipClient),
    /// A class 3 connection.
    Connected(EipConnection),
}

/// One for each target.
pub(crate) async fn rseip(way: Way, targets: Vec<SocketAddr>) -> Vec<Rseip> {
    let mut sessions = Vec::new();
    for target in &targets {
        sessions.push(rseip_session(way, *target).await);
    }
    sessions
}

async fn rseip_session(way: Way, target: SocketAddr) -> Rseip {
    let SocketAddr::V4(address) = target else { panic!("rseip has IPv4 only") };
    match way {
        Way::Unconnected => {
            let stream = TcpStream::connect(target).await.expect("the target listens");
            let mut context = EipContext::new(stream);
            context.register_session().await.expect("a session");
            Rseip::Unconnected(context)
        }
        Way::Routed => {
            let slot = epath::Segment::Port(epath::PortSegment::default());
            Rseip::Routed(EipClient::new(address).with_connection_path(epath::EPath::from(vec![slot])))
        }
        Way::Connected => {
            let router = vec![epath::Segment::Class(2), epath::Segment::Instance(1)];
            let options = OpenOptions::default()
                .connection_path(epath::EPath::from(router))
                .originator_serial_number(u32::from(target.port()))
                // Its own value is 17 ms: a pause of the machine would end the connection.
                .o_t_rpi(2_000_000)
                .t_o_rpi(2_000_000);
            Rseip::Connected(EipConnection::new(address, options))
        }
    }
}

impl Session for Rseip {
    async fn ask(&mut self) {
        let path = vec![epath::Segment::Class(1), epath::Segment::Instance(1), epath::Segment::Attribute(1)];
        let path = epath::EPath::from(path);
        let vendor: Result<u16, rseip::ClientError> = match self {
            Self::Unconnected(context) => {
                let packet = context.send_rrdata(MessageRequest::new(0x0E, path, ())).await;
                let reply: Result<MessageReply<u16>, _> = packet.and_then(decode_unconnected_send);
                reply.map(|reply| reply.data)
            }
            Self::Routed(client) => client.get_attribute_single(path).await,
            Self::Connected(connection) => connection.get_attribute_single(path).await,
        };
        vendor.expect("rseip gets a reply");
    }

    async fn close(self) {
        let closed = match self {
            Self::Unconnected(mut context) => context.unregister_session().await,
            Self::Routed(mut client) => client.close().await,
            Self::Connected(mut connection) => connection.close().await,
        };
        closed.expect("rseip closes");
    }
}
