//! A TCP conversation around bytes that went both ways.

use std::time::SystemTime;

use super::file::Packet;
use super::packet::{Kind, Segment};
use crate::runner::{Direction, Ends};

/// Payload of one packet: what fits into an IP packet beside the headers.
const MAX_PAYLOAD: usize = 65_000;

/// Where each side begins to count its bytes. Any number is right; these are easy to recognise.
const FIRST_SEQUENCE: [u32; 2] = [1_000, 5_000];

/// Both sides of one connection, and how far each has come.
#[derive(Clone, Copy, Debug)]
pub struct Conversation {
    ends: Ends,
    /// Number of the next byte from here, and from the target.
    next: [u32; 2],
}

impl Conversation {
    /// Opens the connection: SYN, SYN-ACK, ACK.
    pub fn open(ends: Ends, at: SystemTime) -> (Self, Vec<Packet>) {
        let mut conversation = Self { ends, next: FIRST_SEQUENCE };
        let packets =
            [(Direction::Out, Kind::Syn), (Direction::In, Kind::SynAck), (Direction::Out, Kind::Ack)]
                .into_iter()
                .filter_map(|(direction, kind)| conversation.packet(direction, kind, &[], at))
                .collect();
        (conversation, packets)
    }

    /// Bytes that one side has written, in as many packets as they need.
    pub fn data(&mut self, direction: Direction, bytes: &[u8], at: SystemTime) -> Vec<Packet> {
        bytes.chunks(MAX_PAYLOAD).filter_map(|piece| self.packet(direction, Kind::Data, piece, at)).collect()
    }

    /// Closes the connection; `direction` is that of the first farewell.
    pub fn close(&mut self, direction: Direction, at: SystemTime) -> Vec<Packet> {
        let other = match direction {
            Direction::Out => Direction::In,
            Direction::In => Direction::Out,
        };
        [(direction, Kind::Fin), (other, Kind::Fin), (direction, Kind::Ack)]
            .into_iter()
            .filter_map(|(direction, kind)| self.packet(direction, kind, &[], at))
            .collect()
    }

    fn packet(&mut self, direction: Direction, kind: Kind, payload: &[u8], at: SystemTime) -> Option<Packet> {
        let [ours, theirs] = &mut self.next;
        let Ends { local, peer } = self.ends;
        let (from, to, sequence, acknowledgement) = match direction {
            Direction::Out => (local, peer, ours, *theirs),
            Direction::In => (peer, local, theirs, *ours),
        };
        let segment = Segment { from, to, sequence: *sequence, acknowledgement, kind };
        let bytes = segment.packet(payload)?;
        // SYN and FIN count as one byte each.
        let length = match kind {
            Kind::Syn | Kind::SynAck | Kind::Fin => 1,
            Kind::Ack => 0,
            Kind::Data => u32::try_from(payload.len()).unwrap_or(u32::MAX),
        };
        *sequence = sequence.wrapping_add(length);
        Some(Packet { at, bytes })
    }
}

#[cfg(test)]
mod tests {
    use etherparse::{SlicedPacket, TransportSlice};

    use super::*;

    fn ends(local: &str, peer: &str) -> Ends {
        Ends { local: local.parse().unwrap(), peer: peer.parse().unwrap() }
    }

    /// Source port, sequence, acknowledgement and payload.
    fn read(packet: &Packet) -> (u16, u32, u32, usize) {
        let sliced = SlicedPacket::from_ethernet(&packet.bytes).unwrap();
        let Some(TransportSlice::Tcp(tcp)) = sliced.transport else { panic!("no TCP: {sliced:?}") };
        (tcp.source_port(), tcp.sequence_number(), tcp.acknowledgment_number(), tcp.payload().len())
    }

    #[test]
    fn each_side_acknowledges_what_the_other_has_sent() {
        for ends in [ends("10.0.0.1:5000", "10.0.0.2:44818"), ends("[fe80::1]:5000", "[fe80::2]:44818")] {
            let at = SystemTime::now();
            let (mut conversation, mut packets) = Conversation::open(ends, at);
            packets.extend(conversation.data(Direction::Out, &[1; 28], at));
            packets.extend(conversation.data(Direction::In, &[2; 28], at));
            packets.extend(conversation.close(Direction::Out, at));
            let read: Vec<_> = packets.iter().map(read).collect();
            assert_eq!(
                read,
                [
                    (5_000, 1_000, 0, 0),
                    (44_818, 5_000, 1_001, 0),
                    (5_000, 1_001, 5_001, 0),
                    (5_000, 1_001, 5_001, 28),
                    (44_818, 5_001, 1_029, 28),
                    (5_000, 1_029, 5_029, 0),
                    (44_818, 5_029, 1_030, 0),
                    (5_000, 1_030, 5_030, 0),
                ]
            );
        }
    }

    #[test]
    fn the_longest_frame_is_cut_into_packets_that_follow_each_other() {
        let at = SystemTime::now();
        let (mut conversation, _) = Conversation::open(ends("10.0.0.1:5000", "10.0.0.2:44818"), at);
        let packets = conversation.data(Direction::Out, &vec![0; 65_535], at);
        let read: Vec<_> =
            packets.iter().map(read).map(|(_, sequence, _, length)| (sequence, length)).collect();
        assert_eq!(read, [(1_001, 65_000), (66_001, 535)]);
        assert_eq!(conversation.data(Direction::In, &[], at).len(), 0);
    }
}
