//! What the byte view says about bytes.
#![allow(clippy::unwrap_used, clippy::expect_used, clippy::indexing_slicing, reason = "a test may fail")]

mod common;

use cipdeck_shared::dissect::{self, Node};
use cipdeck_shared::wire::{GeneralStatus, MessageRouterReply, ServiceCode};
use hex_literal::hex;

#[cfg(target_arch = "wasm32")]
use wasm_bindgen_test::wasm_bindgen_test as test;

const PRODUCT_NAME: [u8; 8] = hex!("0E 03 20 01 24 01 30 07");

/// The leaves follow each other from the first byte to the last.
fn assert_covered(node: &Node, length: usize) {
    let mut at = 0;
    for leaf in node.leaves() {
        assert_eq!(leaf.from, at, "{node}");
        assert!(leaf.to > leaf.from || length == 0, "{node}");
        at = leaf.to;
    }
    assert_eq!(at, length, "{node}");
    assert_nested(node);
}

fn assert_nested(node: &Node) {
    for child in &node.children {
        assert!(node.from <= child.from && child.to <= node.to, "{node}");
        assert_nested(child);
    }
}

/// The text of the first node of that name.
fn text_of<'a>(node: &'a Node, name: &str) -> Option<&'a str> {
    if node.name == name {
        return Some(&node.text);
    }
    node.children.iter().find_map(|child| text_of(child, name))
}

#[test]
fn a_request_is_explained_byte_by_byte() {
    let node = dissect::request(&PRODUCT_NAME);
    assert_eq!(
        node.to_string(),
        "0..8 request\n  \
           0..1 service: 0x0e Get_Attribute_Single. Reads one attribute.\n  \
           1..2 path size: 3 words, 6 bytes\n  \
           2..8 path\n    \
             2..4 class: 1 (0x01) Identity\n    \
             4..6 instance: 1 (0x01)\n    \
             6..8 attribute: 7 (0x07)\n"
    );
}

#[test]
fn a_reply_to_a_known_attribute_has_its_type() {
    let reply = common::message("opener.product_name_reply");
    let node = dissect::reply(&reply, Some(&PRODUCT_NAME));
    assert_covered(&node, reply.len());
    assert_eq!(text_of(&node, "general status"), Some("0x00 Success. Request carried out."));
    assert_eq!(text_of(&node, "product name"), Some("SHORT_STRING OpENer PC"));
    let request = common::message("opener.identity_all_request");
    let all = dissect::reply(&common::message("opener.identity_all_reply"), Some(&request));
    assert_eq!(text_of(&all, "vendor id"), Some("UINT 1 Rockwell Automation / Allen-Bradley"));
    assert_eq!(text_of(&all, "device type"), Some("UINT 12 Communications Adapter"));
    let unasked = dissect::reply(&reply, None);
    assert_eq!(text_of(&unasked, "product name"), None);
    assert!(text_of(&unasked, "type unknown").unwrap().starts_with("guess: "), "{unasked}");
}

#[test]
fn a_refusal_is_explained_in_words() {
    let reply = common::message("opener.unknown_class_reply");
    let node = dissect::reply(&reply, Some(&common::message("opener.unknown_class_request")));
    let status = text_of(&node, "general status").unwrap();
    assert!(status.starts_with("0x05 Path destination unknown. Class, instance"), "{status}");
    assert!(status.contains("hex/decimal"), "{status}");

    let node = dissect::frame(&common::frame("opener.forward_open_refused_reply"));
    let word = text_of(&node, "additional status").unwrap();
    assert!(word.starts_with("0x0315 Invalid segment in connection path"), "{word}");
}

#[test]
fn what_does_not_fit_is_marked_at_its_bytes() {
    let rows: [(&str, &[u8], &str); 6] = [
        ("nothing", &[], "! 0..0 request: 1 more bytes expected at byte 0\n"),
        ("path cut", &hex!("0E 03 20 01"), "! 2..4 path: 4 more bytes expected at byte 4\n"),
        ("segment cut", &hex!("0E 01 21 00"), "! 2..4 segment: 2 more bytes expected at byte 4\n"),
        ("unknown segment", &hex!("0E 02 20 01 F0 00"), "! 4..6 segment: segment cannot be 0xf0 at byte 4\n"),
        ("symbol cut", &hex!("4C 01 91 04"), "! 2..4 symbol: 4 more bytes expected at byte 4\n"),
        ("no path", &hex!("0E"), "! 0..1 request: 1 more bytes expected at byte 1\n"),
    ];
    for (name, bytes, line) in rows {
        let node = dissect::request(bytes);
        assert!(node.to_string().contains(line), "{name}: {node}");
        assert!(node.is_broken(), "{name}");
        assert_covered(&node, bytes.len());
    }
    let other = dissect::reply(&hex!("8F 00 00 00"), Some(&PRODUCT_NAME));
    assert!(text_of(&other, "service").unwrap().contains("Another service was asked: 0x0e"), "{other}");
}

#[test]
fn symbolic_paths_name_the_tag_and_its_services() {
    let node = dissect::request(&hex!("4C 03 91 04 54 41 47 31 01 00"));
    assert_eq!(text_of(&node, "symbol"), Some("TAG1"));
    assert!(text_of(&node, "service").unwrap().starts_with("0x4c Read_Tag."), "{node}");
    let odd = dissect::request(&hex!("4C 04 91 03 54 41 47 00 28 01 01 00"));
    assert_eq!((text_of(&odd, "symbol"), text_of(&odd, "member")), (Some("TAG"), Some("1 (0x01)")));
}

#[test]
fn every_recorded_frame_is_understood_to_its_last_byte() {
    for (name, bytes) in common::frames() {
        let node = dissect::frame(&bytes);
        assert!(!node.is_broken(), "{name}: {node}");
        assert_covered(&node, bytes.len());
    }
}

#[test]
fn the_articles_frames_dissect_to_the_common_packet() {
    let frames = common::frames();
    let messages: Vec<_> =
        frames.iter().filter(|(name, bytes)| name.starts_with("omron_nx") && bytes[0] == 0x6F).collect();
    assert_eq!(messages.len(), 6);
    for (name, bytes) in messages {
        let node = dissect::frame(bytes);
        assert_eq!(text_of(&node, "item count"), Some("2"), "{name}");
        assert_eq!(text_of(&node, "item type"), Some("0x0000 null address"), "{name}");
        let asks = name.ends_with("request");
        assert_eq!(text_of(&node, "request").is_some(), asks, "{name}");
        assert_eq!(text_of(&node, "reply").is_some(), !asks, "{name}");
    }
    let node = dissect::frame(&common::frame("omron_nx.read_tag_request"));
    assert!(text_of(&node, "service").unwrap().starts_with("0x52 Unconnected_Send"), "{node}");
}

#[test]
fn a_routed_message_is_explained_around_and_inside() {
    // the bytes of the wire's own test: 3000 ms, slot 0
    let bytes = hex!("52 02 20 06 24 01 04 BC 08 00 0E 03 20 0F 24 27 30 01 01 00 01 00");
    let node = dissect::request(&bytes);
    assert_eq!(
        node.to_string(),
        "0..22 request\n  \
           0..1 service: 0x52 Unconnected_Send. Passes a request on along a route. Reply to a routed request is the embedded reply (e.g. 0xCC), reply 0xD2 only when the router itself fails.\n  \
           1..2 path size: 2 words, 4 bytes\n  \
           2..6 path\n    \
             2..4 class: 6 (0x06) Connection Manager\n    \
             4..6 instance: 1 (0x01)\n  \
           6..22 Unconnected_Send\n    \
             6..7 time tick: 4: a tick is 16 ms\n    \
             7..8 timeout ticks: 188 ticks, 3008 ms\n    \
             8..10 embedded message length: 8 bytes\n    \
             10..18 embedded message\n      \
               10..11 service: 0x0e Get_Attribute_Single. Reads one attribute.\n      \
               11..12 path size: 3 words, 6 bytes\n      \
               12..18 embedded path\n        \
                 12..14 class: 15 (0x0f) Parameter\n        \
                 14..16 instance: 39 (0x27)\n        \
                 16..18 attribute: 1 (0x01)\n    \
             18..19 route size: 1 words, 2 bytes\n    \
             19..20 reserved: 00\n    \
             20..22 route\n      \
               20..22 port: 1: backplane, slot 0\n"
    );
    let odd = hex!("52 02 20 06 24 01 00 FA 09 00 10 03 20 04 24 96 30 03 55 00 01 00 01 00");
    let node = dissect::request(&odd);
    assert_covered(&node, odd.len());
    assert_eq!(text_of(&node, "pad"), Some("the embedded message has an odd length"));
    assert_eq!(text_of(&node, "type unknown"), Some("guess: USINT 85"));
    let cut = dissect::request(&bytes[..15]);
    assert!(cut.is_broken(), "{cut}");
    assert_covered(&cut, 15);
}

#[test]
fn opening_and_closing_a_connection_is_explained() {
    let classic = hex!(
        "54 02 20 06 24 01 0A 0E 00000000 44332211 0100 3713 EFBEADDE 03 000000"
        "80841E00 F843 80841E00 F843 A3 03 01 00 20 02 24 01"
    );
    let node = dissect::request(&classic[..]);
    let texts = [
        ("T→O connection id", "0x11223344, in replies"),
        ("originator serial number", "0xdeadbeef"),
        ("timeout multiplier", "3: silent for 32 intervals, the connection ends"),
        ("O→T requested interval", "2000000 µs"),
        ("O→T parameters", "at most 504 bytes, point to point"),
        ("transport", "0xa3: class 3, server"),
    ];
    for (name, text) in texts {
        assert_eq!(text_of(&node, name), Some(text), "{node}");
    }
    let large = hex!(
        "5B 02 20 06 24 01 0A 0E 00000000 44332211 0100 3713 EFBEADDE 03 000000"
        "80841E00 A20F0042 80841E00 A20F0042 A3 02 20 02 24 01"
    );
    let node = dissect::request(&large);
    assert_covered(&node, large.len());
    assert_eq!(text_of(&node, "T→O parameters"), Some("at most 4002 bytes, point to point"));
    let opened = hex!("DB000000 0A000000 44332211 0100 3713 EFBEADDE 80841E00 80841E00 00 00");
    let node = dissect::reply(&opened, Some(&large));
    assert!(!node.is_broken(), "{node}");
    assert_eq!(text_of(&node, "O→T connection id"), Some("0x0000000a, in requests"));
    assert_eq!(text_of(&node, "T→O actual interval"), Some("2000000 µs"));

    let close = hex!("4E 02 20 06 24 01 0A 0E 0100 3713 EFBEADDE 03 00 01 00 20 02 24 01");
    let node = dissect::request(&close);
    assert!(!node.is_broken(), "{node}");
    assert_eq!(text_of(&node, "port"), Some("1: backplane, slot 0"));
    let node = dissect::reply(&hex!("CE000000 0100 3713 EFBEADDE 00 00"), Some(&close));
    assert_eq!(text_of(&node, "originator vendor id"), Some("4919 (0x1337)"));
}

#[test]
fn a_router_that_refuses_is_told_from_the_target() {
    // as a ControlLogix answers: st-one-io/node-red-contrib-pccc issue 9
    let node = dissect::reply(&hex!("D2 00 01 01 15 03 01 00"), Some(&PRODUCT_NAME));
    assert_covered(&node, 8);
    let service = text_of(&node, "service").unwrap();
    assert!(service.contains("Unconnected_Send") && service.contains("a router"), "{service}");
    assert_eq!(text_of(&node, "remaining path size"), Some("1 words, 2 bytes of the path were left"));
    // 01/0113 and the three numbers: no connection for the request.
    let node = dissect::reply(&hex!("D4 00 01 01 13 01 0100 3713 EFBEADDE 00 00"), Some(&PRODUCT_NAME));
    assert!(!node.is_broken(), "{node}");
    let service = text_of(&node, "service").unwrap();
    assert!(
        service.contains("Forward_Open") && service.contains("the connection that the request needed"),
        "{service}"
    );
    // Logix' Read_Tag_Fragmented has the same number.
    let tag = hex!("52 03 91 04 54 41 47 31 01 00 00 00 00 00");
    let node = dissect::reply(&hex!("D2 00 00 00 C4 00 2A 00 00 00"), Some(&tag));
    assert!(text_of(&node, "service").unwrap().contains("Read_Tag_Fragmented"), "{node}");
    assert_eq!(text_of(&node, "remaining path size"), None);
}

#[test]
fn a_connected_frame_has_its_connection_and_its_sequence_count() {
    let node = dissect::frame(&common::frame("opener.connected_request"));
    assert!(text_of(&node, "connection id").is_some_and(|id| id.starts_with("0x")), "{node}");
    assert!(text_of(&node, "sequence count").is_some(), "{node}");
}

#[test]
fn devices_are_named_in_list_identity() {
    let node = dissect::frame(&common::frame("opener.list_identity_reply"));
    assert_eq!(text_of(&node, "product name"), Some("OpENer PC"));
    assert_eq!(text_of(&node, "socket address"), Some("0.0.0.0:44820"));
    let vendor = text_of(&node, "vendor id").unwrap();
    assert_eq!(vendor, "1 (0x0001) Rockwell Automation / Allen-Bradley");
    let node = dissect::frame(&common::frame("opener.list_services_reply"));
    assert_eq!(text_of(&node, "service name"), Some("Communications"));
}

#[test]
fn every_prefix_of_a_recorded_frame_is_covered_and_broken() {
    for (name, bytes) in common::frames() {
        for end in 0..bytes.len() {
            let node = dissect::frame(&bytes[..end]);
            assert_covered(&node, end);
            assert!(node.is_broken(), "{name} up to {end}: {node}");
        }
    }
}

/// Type, text and guess of each value, without the positions.
fn decoded(request: &[u8], data: &[u8]) -> Vec<(String, String, bool)> {
    let service = request.first().copied().map(ServiceCode).expect("a request");
    let mut reply = Vec::new();
    MessageRouterReply::success(service, data).encode(&mut reply);
    let values = dissect::decode(request, &reply).into_iter();
    values.map(|value| (value.type_name.into_owned(), value.text, value.guess)).collect()
}

#[test]
fn the_decoded_values_look_as_the_interface_promises() {
    let reply = hex!("8E 00 00 00 01 00");
    let values = dissect::decode(&hex!("0E 03 20 01 24 01 30 01"), &reply);
    assert_eq!(
        serde_json::to_string(&values).unwrap(),
        r#"[{"from":0,"to":2,"type":"UINT","name":"vendor id","text":"1"}]"#
    );
    let values = dissect::decode(&hex!("0E 03 20 04 24 64 30 03"), &hex!("8E 00 00 00 2A"));
    assert_eq!(
        serde_json::to_string(&values).unwrap(),
        r#"[{"from":0,"to":1,"type":"USINT","name":"data","text":"42","guess":true}]"#
    );
    let parsed: Vec<dissect::Decoded> =
        serde_json::from_str(&serde_json::to_string(&values).unwrap()).unwrap();
    assert_eq!(parsed, values);
}

#[test]
fn known_attributes_are_decoded_and_what_follows_is_a_guess() {
    let request = common::message("opener.identity_all_request");
    let reply = common::message("opener.identity_all_reply");
    let values = dissect::decode(&request, &reply);
    let texts: Vec<_> = values.iter().map(|value| (value.name.as_ref(), value.text.as_str())).collect();
    assert_eq!(
        texts,
        [
            ("vendor id", "1"),
            ("device type", "12"),
            ("product code", "65001"),
            ("major revision", "2"),
            ("minor revision", "3"),
            ("status", "0x0000"),
            ("serial number", "123456789"),
            ("product name", "OpENer PC"),
        ]
    );
    let address = common::message("opener.tcp_ip_configuration_reply");
    let values = dissect::decode(&common::message("opener.tcp_ip_configuration_request"), &address);
    assert_eq!((values.len(), values[0].text.as_str(), values[5].text.as_str()), (6, "0.0.0.0", ""));
    let mac = decoded(&common::message("opener.mac_address_request"), &hex!("02 00 DE AD BE EF"));
    assert_eq!(mac, [("USINT[6]".into(), "02:00:de:ad:be:ef".into(), false)]);
    let extra = decoded(&hex!("0E 03 20 01 24 01 30 01"), &hex!("01 00 07"));
    assert_eq!(
        extra,
        [("UINT".into(), "1".into(), false), ("USINT".into(), "7".into(), true)],
        "more bytes than the attribute has"
    );
    let short = decoded(&hex!("0E 03 20 01 24 01 30 01"), &hex!("05"));
    assert_eq!(short, [("USINT".into(), "5".into(), true)], "fewer bytes than the attribute has");
}

#[test]
fn unknown_data_is_guessed_in_the_plain_readings() {
    let parameter = hex!("0E 03 20 93 24 01 30 09");
    let guess = |kind: &str, text: &str| (kind.to_string(), text.to_string(), true);
    let rows: [(&[u8], Vec<_>); 7] = [
        (&[], vec![]),
        (&[200], vec![guess("USINT", "200")]),
        (&hex!("FE FF"), vec![guess("UINT", "65534"), guess("INT", "-2")]),
        (
            &hex!("00 00 48 42"),
            vec![guess("DINT", "1112014848"), guess("UDINT", "1112014848"), guess("REAL", "50.0")],
        ),
        (&hex!("01 02 03"), vec![guess("bytes", "01 02 03")]),
        (b"\x04CHP1", vec![guess("bytes", "04 43 48 50 31"), guess("SHORT_STRING", "CHP1")]),
        (b"drive", vec![guess("bytes", "64 72 69 76 65"), guess("ASCII", "drive")]),
    ];
    for (data, expected) in rows {
        assert_eq!(decoded(&parameter, data), expected, "{data:?}");
    }
}

#[test]
fn a_refusal_and_the_reply_of_another_service_have_no_types() {
    let mut refusal = Vec::new();
    MessageRouterReply::refusal(ServiceCode::GetAttributeSingle, GeneralStatus(0x14)).encode(&mut refusal);
    assert!(dissect::decode(&PRODUCT_NAME, &refusal).is_empty());
    let other = dissect::decode(&PRODUCT_NAME, b"\x8F\x00\x00\x00\x04CHP1");
    assert!(other.iter().all(|value| value.guess), "{other:?}");
    let all = dissect::decode(&PRODUCT_NAME, b"\x81\x00\x00\x00\x01\x00");
    assert!(all.iter().all(|value| value.guess), "{all:?}");
}

#[cfg(not(target_arch = "wasm32"))]
mod any_bytes {
    use super::*;
    use proptest::collection::vec;
    use proptest::prelude::*;

    proptest! {
        #[test]
        fn any_request_is_covered(bytes in vec(any::<u8>(), 0..100)) {
            assert_covered(&dissect::request(&bytes), bytes.len());
        }

        #[test]
        fn any_request_to_the_connection_manager_is_covered(
            service in prop::sample::select(vec![0x4E_u8, 0x52, 0x54, 0x5B]),
            data in vec(any::<u8>(), 0..80),
        ) {
            let request = [&[service, 2, 0x20, 6, 0x24, 1][..], &data].concat();
            assert_covered(&dissect::request(&request), request.len());
            let reply = [&[service | 0x80, 0, 0, 0][..], &data].concat();
            assert_covered(&dissect::reply(&reply, Some(&request)), reply.len());
            assert_covered(&dissect::reply(&reply, None), reply.len());
        }

        #[test]
        fn any_reply_is_covered(request in vec(any::<u8>(), 0..20), mut bytes in vec(any::<u8>(), 0..100)) {
            assert_covered(&dissect::reply(&bytes, Some(&request)), bytes.len());
            // As if it answered a read of a known attribute.
            for (byte, value) in bytes.iter_mut().zip([0x8E, 0, 0, 0]) {
                *byte = value;
            }
            for attribute in 0..10 {
                for class in [0x01, 0xF5, 0xF6] {
                    let request = [0x0E, 3, 0x20, class, 0x24, 1, 0x30, attribute];
                    assert_covered(&dissect::reply(&bytes, Some(&request)), bytes.len());
                    let mut at = 0;
                    for value in dissect::decode(&request, &bytes) {
                        prop_assert!(value.from == at || value.guess);
                        at = value.to;
                    }
                    prop_assert!(at == 0 || at == bytes.len() - 4);
                }
            }
        }

        #[test]
        fn any_frame_is_covered(
            command in prop::sample::select(vec![0x04_u8, 0x63, 0x65, 0x6F, 0x70, 0x99]),
            length in any::<u8>(),
            mut bytes in vec(any::<u8>(), 0..120),
        ) {
            assert_covered(&dissect::frame(&bytes), bytes.len());
            for (byte, value) in bytes.iter_mut().zip([command, 0, length, 0]) {
                *byte = value;
            }
            assert_covered(&dissect::frame(&bytes), bytes.len());
        }
    }
}
