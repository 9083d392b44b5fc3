use super::*;
use crate::config::{MsgCipGeneric, write_hex};
use crate::plan::MessagePlan;
use crate::wire::{PortSegment, RequestTimeout};
use hex_literal::hex;

const GET: [u8; 8] = hex!("0E 03 20 04 24 64 30 03");
const SET: [u8; 10] = hex!("10 03 20 04 24 64 30 03 01 00");

fn slot(slot: u8) -> Epath {
    Epath::default().hop(PortSegment::new(1, slot).unwrap())
}

fn on(route: Epath, message: &[u8]) -> Vec<u8> {
    UnconnectedSend { timeout: RequestTimeout::at_least(1000), message, route }.request().unwrap().bytes()
}

fn together(parts: &[&[u8]]) -> Vec<u8> {
    MultipleServicePacket::new(parts.to_vec()).unwrap().request().unwrap().bytes()
}

fn access(request: &[u8]) -> Access {
    Access::of_all(effects(request).iter().map(|effect| effect.access))
}

#[test]
fn a_plain_request_is_one_effect_with_its_address() {
    let assembly = Effect {
        route: Epath::default(),
        service: ServiceCode::SetAttributeSingle,
        class: Some(4),
        instance: Some(100),
        attribute: Some(3),
        access: Access::Write,
    };
    assert_eq!(effects(&SET), [assembly]);
}

#[test]
fn the_same_number_is_told_apart_by_the_path() {
    for (name, request, class, expected) in [
        (
            "read fragmented by name",
            &hex!("52 03 91 04 54 41 47 31 01 00 00 00 00 00")[..],
            None,
            Access::Read,
        ),
        ("read fragmented", &hex!("52 02 20 6B 24 01 01 00 00 00 00 00"), Some(0x6B), Access::Read),
        ("write fragmented", &hex!("53 02 20 6B 24 01"), Some(0x6B), Access::Write),
        ("0x52 elsewhere", &hex!("52 02 20 64 24 01"), Some(0x64), Access::Unknown),
        ("Forward_Close", &hex!("4E 02 20 06 24 01"), Some(6), Access::Unknown),
        ("Forward_Open", &hex!("54 02 20 06 24 01"), Some(6), Access::Unknown),
        ("Large_Forward_Open", &hex!("5B 02 20 06 24 01"), Some(6), Access::Unknown),
        ("Read_Modify_Write by name", &hex!("4E 03 91 04 54 41 47 31"), None, Access::Write),
        ("Read_Modify_Write", &hex!("4E 02 20 6B 24 01"), Some(0x6B), Access::Write),
        ("holding registers", &hex!("4E 02 20 44 24 01 00 00 01 00"), Some(0x44), Access::Read),
        ("0x4E elsewhere", &hex!("4E 02 20 64 24 01"), Some(0x64), Access::Unknown),
        ("a vendor's service", &hex!("32 02 20 01 24 01"), Some(1), Access::Unknown),
        ("PCCC", &hex!("4B 02 20 67 24 01"), Some(0x67), Access::Unknown),
        ("0x0A to another class", &hex!("0A 02 20 04 24 01 01 00 04 00 0E 00"), Some(4), Access::Unknown),
    ] {
        let found = effects(request);
        assert_eq!(found.len(), 1, "{name}: {found:?}");
        assert_eq!((found[0].class, found[0].access), (class, expected), "{name}");
        assert_eq!(found[0].service, ServiceCode(request[0]), "{name}");
    }
}

#[test]
fn what_is_carried_counts_and_not_what_carries_it() {
    let routed = on(slot(3), &SET);
    assert_eq!(effects(&routed), [Effect { route: slot(3), ..effects(&SET)[0].clone() }]);
    assert_eq!(access(&on(slot(3), &GET)), Access::Read);
    let both = effects(&together(&[&GET, &SET, &SET]));
    assert_eq!(
        both.iter().map(|effect| effect.access).collect::<Vec<_>>(),
        [Access::Read, Access::Write, Access::Write]
    );
    assert_eq!(access(&together(&[&GET, &GET])), Access::Read);
}

#[test]
fn a_request_in_a_packet_is_judged_as_it_is_alone() {
    let requests: [&[u8]; 8] = [
        &GET,
        &SET,
        // tags: a read, a write, a read of what nobody understands, a read by fragments
        &hex!("4C 03 91 04 54 41 47 31 01 00"),
        &hex!("4D 03 91 04 54 41 47 31 C4 00 01 00 01 00 00 00"),
        &hex!("4C 01 30 01 01 00"),
        &hex!("52 03 91 04 54 41 47 31 01 00 00 00 00 00"),
        // the same numbers for other classes
        &hex!("4C 02 20 6C 24 01 00 00 00 00 10 00"),
        &hex!("0A 02 20 02 24 01 01 00"),
    ];
    for first in requests {
        for second in requests {
            for third in requests {
                let alone: Vec<_> = [first, second, third].into_iter().flat_map(effects).collect();
                assert_eq!(
                    effects(&together(&[first, second, third])),
                    alone,
                    "{first:02x?} {second:02x?} {third:02x?}"
                );
            }
        }
    }
}

#[test]
fn a_write_on_a_route_inside_of_a_packet_is_a_write_with_its_whole_route() {
    let hidden = together(&[&GET, &on(slot(2), &on(slot(5), &SET)), &GET]);
    let found = effects(&hidden);
    assert_eq!(
        found.iter().map(|effect| effect.access).collect::<Vec<_>>(),
        [Access::Read, Access::Write, Access::Read]
    );
    assert_eq!(found[1].route, slot(2).join(&slot(5)));
    assert_eq!((found[0].route.is_empty(), found[2].route.is_empty()), (true, true));
    let reads = together(&[&GET, &on(slot(2), &on(slot(5), &GET)), &GET]);
    assert_eq!(access(&reads), Access::Read);
}

#[test]
fn a_block_that_carries_a_write_writes() {
    let mut block = MsgCipGeneric::product_name("4,192.168.1.100");
    (block.app_cfg.service, block.app_cfg.class, block.app_cfg.attribute) = (0x0A, 2, 0);
    let data_of = |request: Vec<u8>| write_hex(&request[6..]);
    for (inner, expected) in [(&SET[..], Access::Write), (&GET, Access::Read)] {
        block.req_data = data_of(together(&[&GET, &on(slot(2), inner)]));
        let plan = MessagePlan::parse(&block).0.unwrap();
        assert_eq!((plan.access(), plan.effects().len()), (expected, 2));
        block.resume = true;
        assert_eq!(MessagePlan::parse(&block).0.is_some(), expected == Access::Read, "only reads resume");
        block.resume = false;
    }
    block.req_data = "0100".into();
    assert_eq!(MessagePlan::parse(&block).0.unwrap().access(), Access::Unknown);
}

#[test]
fn what_two_readers_could_understand_differently_is_unknown() {
    for (name, request) in [
        ("nothing", &hex!("")[..]),
        ("a reply", &hex!("8E 03 20 01 24 01 30 07")),
        ("no path", &hex!("0E 00")),
        ("a path that is cut", &hex!("0E 03 20 01")),
        ("two classes", &hex!("0E 03 20 01 20 04 24 01")),
        ("two instances", &hex!("0E 03 20 01 24 01 24 02")),
        ("the instance first", &hex!("0E 02 24 01 20 01")),
        ("no class", &hex!("0E 01 24 01")),
        ("a class over 16 bits", &hex!("0E 04 22 00 04 00 01 00 24 01")),
        ("a hop before the class", &hex!("0E 03 01 00 20 01 24 01")),
        ("a hop behind the instance", &hex!("0E 03 20 01 24 01 01 00")),
        ("a name behind a class", &hex!("0E 04 20 01 91 04 54 41 47 31")),
        ("a class behind a name", &hex!("4C 04 91 04 54 41 47 31 20 06")),
        ("a segment of data", &hex!("4C 04 91 04 54 41 47 31 80 03")),
        ("an empty message on a route", &hex!("52 02 20 06 24 01 01 FA 00 00 01 00 01 00")),
        ("a route that is cut", &hex!("52 02 20 06 24 01 01 FA 02 00 0E 00 02 00 01 00")),
        (
            "a route with an object",
            &hex!("52 02 20 06 24 01 01 FA 08 00 0E 03 20 04 24 64 30 03 01 00 24 00"),
        ),
        ("a packet of nothing", &hex!("0A 02 20 02 24 01 00 00")),
        ("a packet that is cut", &hex!("0A 02 20 02 24 01 02 00 06 00")),
    ] {
        let found = effects(request);
        assert_eq!(found.len(), 1, "{name}: {found:?}");
        assert_eq!(found[0].access, Access::Unknown, "{name}: {found:?}");
    }
}

#[test]
fn tags_of_a_program_are_listed_by_a_read_and_never_named_by_a_number() {
    // pycomm3: Get_Instance_Attribute_List of Program:Main, class 6B, instance 0, attributes 1 and 2
    let list = hex!("55 09 91 0C 50 72 6F 67 72 61 6D 3A 4D 61 69 6E 20 6B 24 00 02 00 01 00 02 00");
    let [effect] = &effects(&list)[..] else { panic!("one effect") };
    assert_eq!((effect.access, effect.class, effect.instance), (Access::Read, None, None));
    // The same path written to.
    let write = hex!("4D 09 91 0C 50 72 6F 67 72 61 6D 3A 4D 61 69 6E 20 6B 24 05 C4 00 01 00 00 00 00 00");
    let [effect] = &effects(&write)[..] else { panic!("one effect") };
    assert_eq!((effect.access, effect.class, effect.instance), (Access::Write, None, None));
    // Another class, or something between.
    for path in ["91 01 41 00 20 04 24 01", "91 01 41 00 28 01 20 6B 24 01", "91 01 41 00 20 6B 24 01 30 01"]
    {
        let path = crate::config::read_hex(path).unwrap();
        let request = [&[0x55, u8::try_from(path.len() / 2).unwrap()], path.as_slice()].concat();
        assert_eq!(access(&request), Access::Unknown, "{path:02x?}");
    }
}

#[test]
fn what_lies_too_deep_is_unknown() {
    let wrapped = |times| (0..times).fold(GET.to_vec(), |message, _| on(slot(0), &message));
    assert_eq!(access(&wrapped(MAX_DEPTH)), Access::Read);
    assert_eq!(access(&wrapped(MAX_DEPTH + 1)), Access::Unknown);
}

#[cfg(not(target_arch = "wasm32"))]
mod any_bytes {
    use super::*;
    use proptest::collection::vec;
    use proptest::prelude::*;

    /// A request, and whether it writes: reads and writes inside of each other, and bytes that are nothing.
    fn request() -> impl Strategy<Value = (Vec<u8>, bool)> {
        let leaf = prop_oneof![
            Just((GET.to_vec(), false)),
            Just((SET.to_vec(), true)),
            vec(0x32..0x80_u8, 1..9).prop_map(|bytes| (bytes, true)),
        ];
        leaf.prop_recursive(4, 16, 3, |inner| {
            prop_oneof![
                (inner.clone(), any::<u8>())
                    .prop_map(|((message, writes), link)| (on(slot(link), &message), writes)),
                vec(inner, 1..4).prop_map(|parts| {
                    let all: Vec<&[u8]> = parts.iter().map(|(part, _)| part.as_slice()).collect();
                    (together(&all), parts.iter().any(|(_, writes)| *writes))
                }),
            ]
        })
    }

    proptest! {
        #[test]
        fn never_panic_and_always_say_something(bytes in vec(any::<u8>(), 0..128)) {
            prop_assert!(!effects(&bytes).is_empty());
        }

        #[test]
        fn a_write_is_found_however_it_is_wrapped((bytes, writes) in request()) {
            prop_assert_eq!(access(&bytes).may_write(), writes);
        }

        #[test]
        fn a_changed_byte_never_panics(
            (mut bytes, _) in request(), place in any::<prop::sample::Index>(), value in any::<u8>(),
        ) {
            *place.get_mut(&mut bytes) = value;
            prop_assert!(!effects(&bytes).is_empty());
        }
    }
}

#[test]
fn what_a_structure_is_made_of_is_read() {
    // pycomm3 _read_template: Read Tag of class 6C
    assert_eq!(access(&hex!("4C 02 20 6C 24 05 00 00 00 00 40 00")), Access::Read);
}
