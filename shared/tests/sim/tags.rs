//! Tags: what is read is what was written, and what cannot be is refused as each family does.

use cipdeck_shared::engine::time::Instant;
use cipdeck_shared::sim::{Device, SimConfig, SimProfile, TagMemory};
use cipdeck_shared::tag::{Dialect, TagData, TagName, Type, Types, Value, request};
use cipdeck_shared::wire::{
    Epath, GeneralStatus, LogicalKind, LogicalSegment, MessageRouterReply, MessageRouterRequest,
    MultipleServicePacket, MultipleServiceReply, Segment, SimpleDataSegment,
};

use super::connections::connected;
use super::frames::{at, connected_of, exchange, ud};
use super::opening::{LARGE_OPEN, OPEN};

#[cfg(target_arch = "wasm32")]
use wasm_bindgen_test::wasm_bindgen_test as test;

/// A controller with a few tags.
fn controller(dialect: Dialect, tags: &str) -> Device {
    let profile = match dialect {
        Dialect::Logix => SimProfile::Logix,
        Dialect::Micro800 => SimProfile::Micro800,
        Dialect::Omron => SimProfile::Omron,
    };
    let memory = TagMemory::from_json(dialect, tags).unwrap();
    Device::new(SimConfig { tags: Some(memory.into()), ..profile.config() })
}

fn path(name: &str) -> Epath {
    name.parse::<TagName>().unwrap().path()
}

/// Status, additional words and data of an answer.
fn ask(device: &mut Device, request: &MessageRouterRequest, now: Instant) -> (u8, Vec<u16>, Vec<u8>) {
    let answer = device.answer(&request.bytes(), now);
    let reply = MessageRouterReply::decode(&answer).unwrap();
    assert_eq!(reply.service, request.service());
    (reply.status.0, reply.additional.words().collect(), reply.data.to_vec())
}

fn read(device: &mut Device, name: &str, count: u16) -> (u8, Vec<u16>, Vec<u8>) {
    ask(device, &request::read(path(name), count).unwrap(), at(0))
}

/// The value of a tag of this type.
fn value(device: &mut Device, dialect: Dialect, name: &str, kind: &str) -> Value {
    let kind: Type = kind.parse().unwrap();
    let count = if dialect == Dialect::Omron { 1 } else { u16::try_from(kind.elements(dialect)).unwrap() };
    let (status, _, data) = read(device, name, count);
    assert_eq!(status, 0, "{name}");
    let data = TagData::decode(&data).unwrap();
    kind.decode(dialect, data.data).unwrap_or_else(|error| panic!("{name}: {error}"))
}

fn write(device: &mut Device, dialect: Dialect, name: &str, kind: &str, text: &str) -> (u8, Vec<u16>) {
    let kind: Type = kind.parse().unwrap();
    let data = kind.encode(dialect, &kind.parse_value(text).unwrap()).unwrap();
    let count = u16::try_from(kind.elements(dialect)).unwrap();
    let head = kind.head(dialect).unwrap();
    let request = request::write(path(name), head, count, &data).unwrap();
    let (status, words, data) = ask(device, &request, at(0));
    assert!(data.is_empty(), "{name}");
    (status, words)
}

const FAMILIES: [Dialect; 2] = [Dialect::Logix, Dialect::Omron];

#[test]
fn what_is_written_is_read_back() {
    let rows = [
        ("BOOL", "TRUE"),
        ("SINT", "-5"),
        ("INT", "-1234"),
        ("DINT", "-123456"),
        ("LINT", "-1234567890123"),
        ("USINT", "200"),
        ("UINT", "60000"),
        ("UDINT", "4000000000"),
        ("ULINT", "12345678901234567890"),
        ("REAL", "0.1"),
        ("LREAL", "3.141592653589793"),
        ("WORD", "42330"),
        ("TIME", "1500"),
        ("STRING[20]", "\"hello\""),
        ("DINT[5]", "[1, 2, 3, 4, 5]"),
        ("INT[2,3]", "[1, 2, 3, 4, 5, 6]"),
        (
            "BOOL[20]",
            "[TRUE, FALSE, TRUE, TRUE, FALSE, FALSE, FALSE, FALSE, TRUE, FALSE, TRUE, FALSE, TRUE, TRUE, FALSE, FALSE, FALSE, FALSE, TRUE, TRUE]",
        ),
    ];
    for dialect in FAMILIES {
        for (kind, text) in rows {
            let mut device = controller(dialect, &format!(r#"[{{"name":"x","type":"{kind}"}}]"#));
            assert_eq!(write(&mut device, dialect, "X", kind, text), (0, vec![]), "{dialect:?} {kind}");
            let read = value(&mut device, dialect, "x", kind);
            let expected: Type = kind.parse().unwrap();
            assert_eq!(read, expected.parse_value(text).unwrap(), "{dialect:?} {kind}");
        }
    }
}

#[test]
fn parts_are_found_in_structures_and_arrays() {
    let table = r#"{"types":[{"name":"In","type":"STRUCT{a: BOOL; b: BOOL; t: REAL; n: STRING[8]}"}],
        "tags":[{"name":"out","type":"STRUCT{in: In; list: In[3]; grid: INT[2,3]}","value":
        {"in":{"a":true,"b":false,"t":1.5,"n":"one"},
         "list":[{"a":false,"b":true,"t":2.5,"n":"two"},{"a":true,"b":true,"t":3.5,"n":"three"},{"a":false,"b":false,"t":4.5,"n":"four"}],
         "grid":[1,2,3,4,5,6]}}]}"#;
    for dialect in FAMILIES {
        let mut device = controller(dialect, table);
        for (name, kind, text) in [
            ("out.in.a", "BOOL", "TRUE"),
            ("out.in.b", "BOOL", "FALSE"),
            ("out.in.t", "REAL", "1.5"),
            ("out.in.n", "STRING[8]", "\"one\""),
            ("out.list[1].b", "BOOL", "TRUE"),
            ("out.list[1].t", "REAL", "3.5"),
            ("OUT.List[2].N", "STRING[8]", "\"four\""),
            ("out.grid[1,2]", "INT", "6"),
        ] {
            let expected: Type = kind.parse().unwrap();
            let found = value(&mut device, dialect, name, kind);
            assert_eq!(found, expected.parse_value(text).unwrap(), "{dialect:?} {name}");
        }
        assert_eq!(write(&mut device, dialect, "out.in.b", "BOOL", "TRUE"), (0, vec![]));
        assert_eq!(write(&mut device, dialect, "out.in.a", "BOOL", "FALSE"), (0, vec![]));
        assert_eq!(value(&mut device, dialect, "out.in.b", "BOOL"), Value::Bool(true), "{dialect:?}");
        assert_eq!(value(&mut device, dialect, "out.in.a", "BOOL"), Value::Bool(false), "{dialect:?}");
        assert_eq!(value(&mut device, dialect, "out.in.t", "REAL"), Value::Real(1.5), "{dialect:?}");
        let (status, _, data) = read(&mut device, "out", 1);
        assert_eq!((status, data[0], data[1]), (0, 0xA0, 2), "{dialect:?}");
    }
}

#[test]
fn each_family_refuses_in_its_own_words() {
    let table = r#"[{"name":"one","type":"DINT"},{"name":"many","type":"DINT[10]"},{"name":"long","type":"DINT[400]"},
        {"name":"seen","type":"DINT","access":"read"},{"name":"unseen","type":"DINT","access":"none"}]"#;
    let status = |dialect: Dialect, name: &str, count: u16| {
        let (status, words, _) = read(&mut controller(dialect, table), name, count);
        (status, words)
    };
    for (name, count, logix, omron) in [
        ("none", 1, (0x04, vec![]), (0x04, vec![])),
        ("unseen", 1, (0x04, vec![]), (0x04, vec![])),
        ("one.part", 1, (0x04, vec![]), (0x04, vec![])),
        ("one", 2, (0xFF, vec![0x2105]), (0x20, vec![0x8017])),
        ("one", 0, (0xFF, vec![0x2105]), (0x20, vec![0x8018])),
        ("many[10]", 1, (0xFF, vec![0x2105]), (0x20, vec![0x8018])),
        ("many[4]", 7, (0xFF, vec![0x2105]), (0x20, vec![0x8018])),
        ("many", 11, (0xFF, vec![0x2105]), (0x20, vec![0x8018])),
        ("long", 400, (0x06, vec![]), (0x11, vec![])),
        ("seen", 1, (0, vec![]), (0, vec![])),
    ] {
        assert_eq!(status(Dialect::Logix, name, count), logix, "Logix {name} {count}");
        assert_eq!(status(Dialect::Omron, name, count), omron, "Omron {name} {count}");
    }
    let status = |dialect: Dialect, name: &str, kind: &str, value: &str| {
        write(&mut controller(dialect, table), dialect, name, kind, value)
    };
    for (name, kind, value, logix, omron) in [
        ("one", "REAL", "1.5", (0xFF, vec![0x2107]), (0x20, vec![0x8022])),
        ("one", "INT", "1", (0xFF, vec![0x2107]), (0x20, vec![0x8022])),
        ("seen", "DINT", "1", (0x0F, vec![]), (0x1F, vec![0x0102, 0x2103])),
        ("unseen", "DINT", "1", (0x04, vec![]), (0x04, vec![])),
        ("many[9]", "DINT[2]", "[1, 2]", (0xFF, vec![0x2105]), (0x20, vec![0x8018])),
    ] {
        assert_eq!(status(Dialect::Logix, name, kind, value), logix, "Logix {name} {kind}");
        assert_eq!(status(Dialect::Omron, name, kind, value), omron, "Omron {name} {kind}");
    }
}

#[test]
fn what_is_cut_or_too_long_is_refused() {
    for dialect in FAMILIES {
        let mut device = controller(dialect, r#"[{"name":"one","type":"DINT","value":7}]"#);
        let head = "DINT".parse::<Type>().unwrap().head(dialect).unwrap();
        // A Logix takes what the count says, and leaves the rest: pycomm3 relies on it.
        let long = if dialect == Dialect::Omron { 0x15 } else { 0 };
        for (data, status) in [(&[1, 2, 3][..], 0x13), (&[], 0x13), (&[7, 0, 0, 0, 5], long)] {
            let request = request::write(path("one"), head, 1, data).unwrap();
            assert_eq!(ask(&mut device, &request, at(0)).0, status, "{dialect:?} {data:?}");
        }
        assert_eq!(value(&mut device, dialect, "one", "DINT"), Value::Signed(7));
        for (bytes, status) in
            [(&b"\x4C\x03\x91\x03one\x00"[..], 0x13), (b"\x4C\x03\x91\x03one\x00\x01\x00\x00", 0x15)]
        {
            assert_eq!(device.answer(bytes, at(0))[2], status, "{dialect:?}");
        }
    }
}

#[test]
fn an_omron_knows_ranges_additional_information_and_parts_by_bytes() {
    let table = r#"[{"name":"percent","type":"INT","range":[0,100]},{"name":"text","type":"STRING[8]","value":"abcdef"},
        {"name":"list","type":"INT[10]","value":[0,1,2,3,4,5,6,7,8,9]},{"name":"bits","type":"BOOL[20]"}]"#;
    let mut device = controller(Dialect::Omron, table);
    assert_eq!(write(&mut device, Dialect::Omron, "percent", "INT", "100"), (0, vec![]));
    assert_eq!(write(&mut device, Dialect::Omron, "percent", "INT", "101"), (0x20, vec![0x8028]));
    let odd = device.answer(b"\x4D\x05\x91\x07percent\x00\xC3\x01\x00\x01\x00\x05\x00", at(0));
    assert_eq!(odd, b"\xCD\x00\x20\x01\x21\x80");
    let part = |device: &mut Device, name: &str, offset, size| {
        let request = request::read_part(path(name), SimpleDataSegment { offset, size }).unwrap();
        ask(device, &request, at(0))
    };
    assert_eq!(part(&mut device, "list", 4, 6), (0, vec![], b"\xC3\x00\x02\x00\x03\x00\x04\x00".to_vec()));
    assert_eq!(part(&mut device, "text", 2, 4), (0, vec![], b"\xD0\x00\x04\x00cdef".to_vec()));
    assert_eq!(part(&mut device, "bits", 0, 4), (0, vec![], b"\xC1\x00\x00\x00\x00\x00".to_vec()));
    assert_eq!(part(&mut device, "list", 18, 4), (0x1F, vec![0x0104, 0x1103], vec![]));
    assert_eq!(part(&mut device, "percent", 0, 2), (0x20, vec![0x8029], vec![]));
    assert_eq!(part(&mut device, "list", 0, 0), (0x20, vec![0x8018], vec![]));
    let segment = Segment::SimpleData(SimpleDataSegment { offset: 4, size: 4 });
    let head = "INT".parse::<Type>().unwrap().head(Dialect::Omron).unwrap();
    let request = request::write(path("list").with(segment), head, 1, &[0x22, 0, 0x33, 0]).unwrap();
    assert_eq!(ask(&mut device, &request, at(0)).0, 0);
    assert_eq!(value(&mut device, Dialect::Omron, "list[3]", "INT"), Value::Signed(0x33));
}

#[test]
fn a_logix_gives_and_takes_what_does_not_fit_in_fragments() {
    let mut device = controller(Dialect::Logix, r#"[{"name":"big","type":"DINT[400]"}]"#);
    let numbers: Vec<u8> = (0..400_i32).flat_map(i32::to_le_bytes).collect();
    let head = "DINT".parse::<Type>().unwrap().head(Dialect::Logix).unwrap();
    for (index, part) in numbers.chunks(400).enumerate() {
        let offset = u32::try_from(index * 400).unwrap();
        let request = request::write_fragment(path("big"), head, 400, offset, part).unwrap();
        assert_eq!(ask(&mut device, &request, at(0)).0, 0);
    }
    let (mut found, mut statuses) = (Vec::new(), Vec::new());
    loop {
        let offset = u32::try_from(found.len()).unwrap();
        let request = request::read_fragment(path("big"), 400, offset).unwrap();
        let (status, _, data) = ask(&mut device, &request, at(0));
        found.extend_from_slice(TagData::decode(&data).unwrap().data);
        statuses.push(status);
        if status != 6 {
            break;
        }
    }
    assert_eq!((found, statuses), (numbers, vec![6, 6, 6, 0]));
    let beyond = request::read_fragment(path("big"), 400, 1_600).unwrap();
    assert_eq!(ask(&mut device, &beyond, at(0)), (0xFF, vec![0x2105], vec![]));
    let beyond = request::write_fragment(path("big"), head, 400, 1_598, &[0; 4]).unwrap();
    assert_eq!(ask(&mut device, &beyond, at(0)).0, 0xFF);
}

#[test]
fn single_bits_are_written_on_a_logix() {
    let mut device = controller(Dialect::Logix, r#"[{"name":"word","type":"DINT","value":5}]"#);
    let on = request::write_bit(path("word"), 4, 4, true).unwrap();
    let off = request::write_bit(path("word"), 4, 0, false).unwrap();
    assert_eq!((ask(&mut device, &on, at(0)).0, ask(&mut device, &off, at(0)).0), (0, 0));
    assert_eq!(value(&mut device, Dialect::Logix, "word", "DINT"), Value::Signed(0x14));
    let wrong = request::write_bit(path("word"), 2, 0, true).unwrap();
    assert_eq!(ask(&mut device, &wrong, at(0)), (0xFF, vec![0x2107], vec![]));
    let mut omron = controller(Dialect::Omron, r#"[{"name":"word","type":"DINT","value":5}]"#);
    assert_eq!(ask(&mut omron, &on, at(0)).0, 0x08);
}

#[test]
fn symbols_of_a_logix_have_numbers() {
    let mut device = controller(
        Dialect::Logix,
        r#"[{"name":"a","type":"DINT","value":1},{"name":"b","type":"DINT[3]","value":[5,6,7]}]"#,
    );
    let path = Epath::object(0x6B, 2).then(LogicalKind::Member, 2);
    let (status, _, data) = ask(&mut device, &request::read(path, 1).unwrap(), at(0));
    assert_eq!((status, data), (0, b"\xC4\x00\x07\x00\x00\x00".to_vec()));
    let nobody = request::read(Epath::object(0x6B, 3), 1).unwrap();
    assert_eq!(ask(&mut device, &nobody, at(0)).0, 0x04);
}

#[test]
fn the_two_tags_of_the_document_come_in_one_packet() {
    // document on Omron NX: TAG1 and TAG2, both TRUE
    let mut device = Device::new(SimProfile::Omron.config());
    let each = ["TAG1", "TAG2"].map(|name| request::read(path(name), 1).unwrap().bytes());
    let packet = MultipleServicePacket::new(each.iter().map(Vec::as_slice).collect()).unwrap();
    let answer = device.answer(&packet.request().unwrap().bytes(), at(0));
    assert_eq!(answer, b"\x8A\x00\x00\x00\x02\x00\x06\x00\x0E\x00\xCC\x00\x00\x00\xC1\x00\x01\x00\xCC\x00\x00\x00\xC1\x00\x01\x00");
    assert_eq!((device.counters().tag_reads, device.counters().packets), (2, 1));
}

#[test]
fn a_packet_tells_which_of_its_requests_failed_and_takes_no_more_than_fits() {
    for dialect in FAMILIES {
        let table = r#"[{"name":"a","type":"DINT","value":1},{"name":"long","type":"DINT[100]"}]"#;
        let mut device = controller(dialect, table);
        let all = if dialect == Dialect::Omron { 1 } else { 100 };
        let names = [("long", all), ("none", 1), ("long", all), ("a", 1)];
        let each = names.map(|(name, count)| request::read(path(name), count).unwrap().bytes());
        let packet = MultipleServicePacket::new(each.iter().map(Vec::as_slice).collect()).unwrap();
        let (status, _, data) = ask(&mut device, &packet.request().unwrap(), at(0));
        assert_eq!(status, GeneralStatus::EmbeddedServiceError.0);
        let reply = MultipleServiceReply::decode(&data).unwrap();
        let statuses: Vec<u8> = reply.parts().iter().map(|part| part[2]).collect();
        // A Logix fills the packet with what fits, and leaves nothing to the next.
        let expected = if dialect == Dialect::Omron { [0, 4, 0x11, 0] } else { [0, 4, 0x06, 0x11] };
        assert_eq!(statuses, expected, "{dialect:?}");
        assert!(data.len() + 4 <= 504, "{dialect:?}");
    }
}

#[test]
fn a_micro800_refuses_what_it_does_not_know() {
    let mut device = Device::new(SimProfile::Micro800.config());
    let read = request::read(path("Scalar"), 1).unwrap();
    assert_eq!(ask(&mut device, &read, at(0)).0, 0x08, "without a connection");
    let bytes = read.bytes();
    let packet = MultipleServicePacket::new(vec![&bytes, &bytes]).unwrap().request().unwrap();
    assert_eq!(ask(&mut device, &packet, at(0)).0, 0x08, "a packet");
    let forwarded =
        b"\x52\x02\x20\x06\x24\x01\x05\x9D\x08\x00\x0E\x03\x20\x01\x24\x01\x30\x07\x01\x00\x01\x00";
    assert_eq!(device.answer(forwarded, at(0))[2], 0x08, "Unconnected_Send");
}

#[test]
fn a_micro800_answers_over_a_connection_and_refuses_without_the_vendors_words() {
    let (mut device, mut connection, session, id) = connected(SimProfile::Micro800.config(), &OPEN);
    let mut sequence = 0;
    let mut ask = |request: &[u8]| {
        sequence += 1;
        let reply = exchange(&mut device, &mut connection, &ud(session, id, sequence, request), at(0));
        let message = connected_of(&reply).2;
        let reply = MessageRouterReply::decode(&message).unwrap();
        (reply.status.0, reply.additional.words().count(), reply.data.to_vec())
    };
    let read = |name: &str, count| request::read(path(name), count).unwrap().bytes();
    assert_eq!(ask(&read("Scalar", 1)), (0, 0, b"\xC4\x00\x2A\x00\x00\x00".to_vec()));
    assert_eq!(ask(&read("Recipe", 1)), (0, 0, b"\xDA\x00\x08Standard".to_vec()), "length and characters");
    let write = |name: &str, kind: &str, value: &str| {
        let kind: Type = kind.parse().unwrap();
        let data = kind.encode(Dialect::Micro800, &kind.parse_value(value).unwrap()).unwrap();
        request::write(path(name), kind.head(Dialect::Micro800).unwrap(), 1, &data).unwrap().bytes()
    };
    assert_eq!(ask(&write("Recipe", "STRING", "\"Quick\"")), (0, 0, vec![]));
    assert_eq!(ask(&read("Recipe", 1)).2, b"\xDA\x00\x05Quick");
    for (request, status) in [
        (read("Nobody", 1), 0x04),
        (read("Scalar", 2), 0xFF),
        (read("Arr[100]", 1), 0xFF),
        (write("Scalar", "REAL", "1.5"), 0xFF),
        (write("Limit", "DINT", "1"), 0x0F),
        (request::write_bit(path("Scalar"), 4, 0, true).unwrap().bytes(), 0x08),
    ] {
        assert_eq!(ask(&request), (status, 0, vec![]), "{request:02X?}");
    }
    let (first, second) = (read("Scalar", 1), read("Enabled", 1));
    let packet = MultipleServicePacket::new(vec![&first, &second]).unwrap().request().unwrap();
    assert_eq!(ask(&packet.bytes()).0, 0x08, "a packet");
}

#[test]
fn a_request_that_is_too_long_is_refused() {
    for (profile, dialect, most) in
        [(SimProfile::Logix, Dialect::Logix, 504), (SimProfile::Omron, Dialect::Omron, 502)]
    {
        let table = r#"[{"name":"bytes","type":"USINT[600]"}]"#;
        let mut device = controller(dialect, table);
        let head = "USINT".parse::<Type>().unwrap().head(dialect).unwrap();
        for (length, status) in [(most - 16, 0), (most - 15, 0x15)] {
            let first = Segment::Logical(LogicalSegment { kind: LogicalKind::Member, value: 0 });
            let count = u16::try_from(length).unwrap();
            let request = request::write(path("bytes").with(first), head, count, &vec![1; length]).unwrap();
            assert_eq!(ask(&mut device, &request, at(0)).0, status, "{profile:?} {}", request.bytes().len());
        }
    }
}

#[test]
fn a_large_connection_carries_more_at_once() {
    let table = r#"[{"name":"big","type":"DINT[900]"}]"#;
    for (dialect, profile, count) in
        [(Dialect::Logix, SimProfile::Logix, 900), (Dialect::Omron, SimProfile::Omron, 400)]
    {
        let memory = TagMemory::from_json(dialect, table).unwrap();
        let config = SimConfig { tags: Some(memory.into()), max_size: 4_002, ..profile.config() };
        let (mut device, mut connection, session, id) = connected(config, &LARGE_OPEN);
        let read = request::read(path("big"), count).unwrap().bytes();
        let reply = exchange(&mut device, &mut connection, &ud(session, id, 1, &read), at(0));
        let message = connected_of(&reply).2;
        assert_eq!((message[2], message.len()), (0, 6 + 4 * usize::from(count)), "{dialect:?}");
    }
}

#[test]
fn values_move() {
    let mut device = Device::new(SimProfile::Omron.config());
    let mut moment = |name: &str, kind: &str, millis| {
        let (status, _, data) = ask(&mut device, &request::read(path(name), 1).unwrap(), at(millis));
        assert_eq!(status, 0, "{name}");
        let data = TagData::decode(&data).unwrap();
        kind.parse::<Type>().unwrap().decode(Dialect::Omron, data.data).unwrap().to_string()
    };
    assert_eq!(moment("grHWCs_PV", "REAL", 0), "63.5");
    let high: f32 = moment("grHWCs_PV", "REAL", 2_500).parse().unwrap();
    assert!((high - 63.5 * 7.0 / 6.0).abs() < 0.01, "{high}");
    assert_eq!(moment("giCounter", "DINT", 0), "0");
    assert_eq!(moment("giCounter", "DINT", 12_300), "123");
    assert_eq!([0, 1_000, 2_000].map(|millis| moment("gbPump", "BOOL", millis)), ["FALSE", "TRUE", "FALSE"]);
    assert_eq!(moment("gsState", "STRING[32]", 2_000), "\"holding\"");
    assert_eq!(moment("stMotor.count", "DINT", 1_000), "17");
    assert_ne!(moment("arTemp[3]", "INT", 1_000), moment("arTemp[3]", "INT", 3_000));
}

#[test]
fn the_usual_tags_have_the_values_of_their_tables() {
    let logix = include_str!("../../src/sim/tags/usual/logix.json");
    let omron = include_str!("../../src/sim/tags/usual/omron.json");
    for (dialect, profile, table, least) in
        [(Dialect::Logix, SimProfile::Logix, logix, 18), (Dialect::Omron, SimProfile::Omron, omron, 35)]
    {
        let table: serde_json::Value = serde_json::from_str(table).unwrap();
        let mut types = Types::default();
        for kind in table["types"].as_array().unwrap() {
            types.add(kind["name"].as_str().unwrap(), kind["type"].as_str().unwrap()).unwrap();
        }
        let (mut device, mut compared) = (Device::new(profile.config()), 0);
        for row in table["tags"].as_array().unwrap() {
            let (name, kind) =
                (row["name"].as_str().unwrap(), types.read(row["type"].as_str().unwrap()).unwrap());
            if row["access"] == "none" || row["moves"].is_string() || row["value"].is_null() {
                continue;
            }
            let count = if dialect == Dialect::Omron { 1 } else { kind.elements(dialect) };
            let (status, _, data) = read(&mut device, name, u16::try_from(count).unwrap());
            assert_eq!(status, 0, "{name}");
            let found = kind.decode(dialect, TagData::decode(&data).unwrap().data);
            let expected = kind.value_of_json(&row["value"]).unwrap();
            // JSON does not keep the order of members.
            assert_eq!(found.unwrap().to_json(), expected.to_json(), "{name}");
            compared += 1;
        }
        assert!(compared >= least, "{dialect:?}: {compared}");
    }
    assert!(TagMemory::usual(Dialect::Micro800).len() >= 20);
}

#[test]
fn a_file_that_cannot_be_used_says_where() {
    let refused = |text: &str| TagMemory::from_json(Dialect::Logix, text).unwrap_err().to_string();
    for (text, expected) in [
        ("[\n{\"name\":\"a\",\n}]", "line 3: "),
        ("[{\"name\":\"a\"}]", "line 1: missing field `type`"),
        ("[{\"name\":\"a\",\"type\":\"DINT\",\"sort\":1}]", "line 1: unknown field `sort`"),
        (
            "[\n{\"name\":\"a\",\"type\":\"DINT\"},\n{\"name\":\"b\",\"type\":\"DIN\"}]",
            "line 3, b: type: \"DIN\" is neither",
        ),
        (
            "[\n{\"name\":\"a\",\"type\":\"INT\",\"value\":70000}]",
            "line 2, a: value: 70000 is outside of INT",
        ),
        (
            "[{\"name\":\"a\",\"type\":\"INT\",\"moves\":\"toggle\"}]",
            "line 1, a: a: \"\" cannot move as toggle",
        ),
        (
            "[{\"name\":\"a\",\"type\":\"INT\",\"moves\":\"jump\"}]",
            "line 1, a: moves: a value moves as one of",
        ),
        ("[{\"name\":\"a\",\"type\":\"INT\",\"access\":\"all\"}]", "line 1, a: access is one of"),
        (
            "[\n{\"name\":\"a\",\"type\":\"INT\"},\n{\"name\":\"A\",\"type\":\"INT\"}]",
            "line 3, A: the name \"A\" is there twice",
        ),
        (
            "[{\"name\":\"a.b\",\"type\":\"INT\"}]",
            "line 1, a.b: the name \"a.b\" is empty, too long, or has a dot",
        ),
        ("[{\"name\":\"a\",\"type\":\"DINT[20000]\"}]", "line 1, a: a: its type takes 80000 bytes"),
    ] {
        let found = refused(text);
        assert!(found.starts_with(expected), "{found:?} does not begin with {expected:?}");
    }
    let many =
        TagMemory::from_json(Dialect::Logix, r#"[{"name":"D###_x","type":"DINT","times":12}]"#).unwrap();
    let mut device = Device::new(SimConfig { tags: Some(many.into()), ..SimProfile::Logix.config() });
    assert_eq!((read(&mut device, "D011_x", 1).0, read(&mut device, "D012_x", 1).0), (0, 4));
}
