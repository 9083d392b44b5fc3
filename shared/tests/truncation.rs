//! Bytes that end too early, and bytes that are nothing: an error at a byte that is there, never a panic.
#![allow(clippy::unwrap_used, clippy::expect_used, clippy::indexing_slicing, reason = "a test may fail")]

mod common;

use cipdeck_shared::wire::{
    CommonPacketFormat, DecodeError, DecodeErrorKind, Deframer, Encapsulation, Epath, ListIdentityItem,
    ListServicesItem, MessageRouterReply, MessageRouterRequest, MultipleServicePacket, Reader,
    RegisterSession, SendRrData,
};

#[cfg(target_arch = "wasm32")]
use wasm_bindgen_test::wasm_bindgen_test as test;

/// A decoder by its name, and where its positions start to count.
type Decoder = (&'static str, usize, fn(&[u8]) -> Result<(), DecodeError>);

const DECODERS: [Decoder; 10] = [
    ("Encapsulation", 0, |bytes| Encapsulation::decode(bytes).map(drop)),
    ("RegisterSession", 24, |bytes| RegisterSession::decode(bytes).map(drop)),
    ("SendRrData", 24, |bytes| SendRrData::decode(bytes).and_then(|data| data.unconnected().map(drop))),
    ("CommonPacketFormat", 0, |bytes| CommonPacketFormat::read(&mut Reader::new(bytes)).map(drop)),
    ("ListIdentityItem", 0, |bytes| ListIdentityItem::decode(bytes).map(drop)),
    ("ListServicesItem", 0, |bytes| ListServicesItem::decode(bytes).map(drop)),
    ("Epath", 0, |bytes| Epath::decode(bytes).map(drop)),
    ("MessageRouterRequest", 0, |bytes| MessageRouterRequest::decode(bytes).map(drop)),
    ("MultipleServicePacket", 0, |bytes| MultipleServicePacket::decode(bytes).map(drop)),
    ("MessageRouterReply", 0, |bytes| MessageRouterReply::decode(bytes).map(drop)),
];

/// Runs every decoder; an error is at a byte, or just behind the last one, and prints it.
fn decode_with_all(bytes: &[u8]) {
    for (name, start, decode) in DECODERS {
        if let Err(error) = decode(bytes) {
            assert!(error.at <= start + bytes.len(), "{name}: {error} in {} bytes", bytes.len());
            assert!(error.to_string().ends_with(&format!("at byte {}", error.at)), "{name}: {error}");
        }
    }
}

#[test]
fn every_prefix_of_a_frame_says_how_much_is_missing() {
    for (name, bytes) in common::frames() {
        for end in 0..bytes.len() {
            let error = Encapsulation::decode(&bytes[..end]).expect_err(&name);
            assert_eq!(error.at, end, "{name}");
            let DecodeErrorKind::Truncated { needed } = error.kind else { panic!("{name}: {error}") };
            assert!((1..=bytes.len() - end).contains(&needed), "{name}: {error}");
        }
    }
}

#[test]
fn every_prefix_of_a_message_is_decoded_or_refused_at_a_byte() {
    for (_, bytes) in common::frames() {
        for start in [0, 24, 40, 46] {
            let part = bytes.get(start..).unwrap_or_default();
            for end in 0..=part.len() {
                decode_with_all(&part[..end]);
            }
        }
    }
}

#[test]
fn a_stream_waits_for_the_rest_of_a_frame() {
    for (name, bytes) in common::frames() {
        let mut deframer = Deframer::new();
        for (at, byte) in bytes.iter().enumerate() {
            assert_eq!(deframer.next_frame(), Ok(None), "{name} after {at} bytes");
            deframer.push(&[*byte]);
        }
        assert!(deframer.next_frame().is_ok_and(|frame| frame.is_some()), "{name}");
    }
}

#[cfg(not(target_arch = "wasm32"))]
mod any_bytes {
    use super::*;
    use proptest::collection::vec;
    use proptest::prelude::*;

    proptest! {
        #[test]
        fn never_panic(bytes in vec(any::<u8>(), 0..128)) {
            decode_with_all(&bytes);
        }

        #[test]
        fn in_a_recorded_frame_never_panic(
            index in any::<prop::sample::Index>(), changes in vec((any::<prop::sample::Index>(), any::<u8>()), 1..4),
        ) {
            let frames = common::frames();
            let (_, mut bytes) = index.get(&frames).clone();
            for (place, value) in changes {
                *place.get_mut(&mut bytes) = value;
            }
            for start in [0, 24, 40, 46] {
                decode_with_all(bytes.get(start..).unwrap_or_default());
            }
        }

        #[test]
        fn in_a_stream_never_panic_and_never_pile_up(parts in vec(vec(any::<u8>(), 0..64), 0..20)) {
            let mut deframer = Deframer::new();
            for part in parts {
                deframer.push(&part);
                while let Ok(Some(_)) = deframer.next_frame() {}
                prop_assert!(deframer.pending() <= 24 + 65_511 + part.len());
            }
        }
    }
}
