//! One Ethernet packet around a piece of a TCP stream.

use std::net::{IpAddr, SocketAddr};

use etherparse::{PacketBuilder, TcpHeader, TcpOptionElement};

/// What kind of segment it is.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Kind {
    /// The first one of the caller.
    Syn,
    /// The answer to it.
    SynAck,
    /// Nothing but an acknowledgement.
    Ack,
    /// Bytes of the stream.
    Data,
    /// The last one of a side.
    Fin,
}

/// Where a segment comes from and belongs in the stream.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) struct Segment {
    pub(super) from: SocketAddr,
    pub(super) to: SocketAddr,
    /// Number of its first byte.
    pub(super) sequence: u32,
    /// Number of the byte that the sender expects next.
    pub(super) acknowledgement: u32,
    pub(super) kind: Kind,
}

/// Bytes that a side may send unacknowledged, with the scale: more than anybody here has under way.
const WINDOW: u16 = u16::MAX;

/// The window counts in units of 2 to the power of this.
const WINDOW_SCALE: u8 = 7;

const TIME_TO_LIVE: u8 = 64;

impl Segment {
    /// The whole packet, with right checksums; `None` if the payload were longer than a packet can be.
    pub(super) fn packet(self, payload: &[u8]) -> Option<Vec<u8>> {
        let ethernet = PacketBuilder::ethernet2(mac(self.from), mac(self.to));
        let ip = match (self.from.ip(), self.to.ip()) {
            (IpAddr::V4(from), IpAddr::V4(to)) => ethernet.ipv4(from.octets(), to.octets(), TIME_TO_LIVE),
            (from, to) => ethernet.ipv6(wide(from), wide(to), TIME_TO_LIVE),
        };
        let tcp = ip.tcp_header(self.header());
        let mut packet = Vec::with_capacity(tcp.size(payload.len()));
        tcp.write(&mut packet, payload).ok().map(|()| packet)
    }

    fn header(self) -> TcpHeader {
        let mut header = TcpHeader::new(self.from.port(), self.to.port(), self.sequence, WINDOW);
        header.syn = matches!(self.kind, Kind::Syn | Kind::SynAck);
        header.psh = self.kind == Kind::Data;
        header.fin = self.kind == Kind::Fin;
        header.ack = self.kind != Kind::Syn;
        if header.ack {
            header.acknowledgment_number = self.acknowledgement;
        }
        if header.syn {
            // One option of three bytes always has room.
            let _ = header.set_options(&[TcpOptionElement::WindowScale(WINDOW_SCALE)]);
        }
        header
    }
}

/// A made-up MAC address, marked as locally administered: the same for the same IP address.
fn mac(address: SocketAddr) -> [u8; 6] {
    let [.., a, b, c, d] = wide(address.ip());
    [0x02, 0, a, b, c, d]
}

fn wide(ip: IpAddr) -> [u8; 16] {
    match ip {
        IpAddr::V4(ip) => ip.to_ipv6_mapped().octets(),
        IpAddr::V6(ip) => ip.octets(),
    }
}
