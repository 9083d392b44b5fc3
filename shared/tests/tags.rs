//! Values of tags: bytes and texts in both directions, for three families of controllers.
#![allow(clippy::unwrap_used, clippy::panic, clippy::indexing_slicing, reason = "a test may fail")]

extern crate alloc;

use alloc::sync::Arc;

use cipdeck_shared::tag::{
    Dialect, Dimension, Dimensions, Display, Elementary, Member, Place, Scale, Structure, TagData, TagHead,
    TagName, Type, Value, ValueError, View,
};
use hex_literal::hex;

#[cfg(target_arch = "wasm32")]
use wasm_bindgen_test::wasm_bindgen_test as test;

fn kind(text: &str) -> Type {
    text.parse().unwrap()
}

fn both_ways(dialect: Dialect, text: &str, bytes: &[u8], value: &str) {
    let kind = kind(text);
    let decoded = kind.decode(dialect, bytes).unwrap_or_else(|error| panic!("{text}: {error}"));
    assert_eq!(decoded.to_string(), value, "{dialect:?} {text}");
    assert_eq!(kind.encode(dialect, &decoded).unwrap(), bytes, "{dialect:?} {text}");
    assert_eq!(kind.parse_value(value).unwrap(), decoded, "{dialect:?} {text}");
    assert_eq!(kind.value_of_json(&decoded.to_json()).unwrap(), decoded, "{dialect:?} {text}");
}

/// FACTS of Omron W506 8-7 and the document on Omron NX.
#[test]
fn omron_values_are_as_the_manual_lays_them_out() {
    let omron = Dialect::Omron;
    both_ways(omron, "BOOL", &hex!("01 00"), "TRUE");
    both_ways(omron, "BOOL", &hex!("00 00"), "FALSE");
    both_ways(omron, "INT", &hex!("01 80"), "-32767");
    both_ways(omron, "REAL", &hex!("00 00 48 42"), "50");
    both_ways(omron, "LREAL", &hex!("9A 99 99 99 99 99 B9 3F"), "0.1");
    both_ways(omron, "ULINT", &hex!("FF FF FF FF FF FF FF FF"), "18446744073709551615");
    both_ways(omron, "TIME", &hex!("40 42 0F 00 00 00 00 00"), "1000000");
    both_ways(omron, "UDINT_BCD", &hex!("78 56 34 12"), "12345678");
    both_ways(omron, "STRING", &hex!("03 00 41 42 43"), "\"ABC\"");
    both_ways(omron, "BOOL[3]", &hex!("01 00 01"), "[TRUE, FALSE, TRUE]");
    both_ways(omron, "INT[2,2]", &hex!("01 00 02 00 03 00 04 00"), "[1, 2, 3, 4]");
    // One byte, written without the pad of the manual's picture, read with or without.
    both_ways(omron, "USINT", &hex!("7B"), "123");
    assert_eq!(kind("USINT").decode(omron, &hex!("7B 00")), Ok(Value::Unsigned(123)));
    // BOOL in a word, REAL at 4, packed array at 8, text of fixed size, all padded to 4.
    both_ways(
        omron,
        "STRUCT{run: BOOL; speed: REAL; in: BOOL[5]; name: STRING[4]}",
        &hex!("01 00 00 00  00 00 48 42  15 00 41 42 00 00 00 00"),
        "{run: TRUE, speed: 50, in: [TRUE, FALSE, TRUE, FALSE, TRUE], name: \"AB\"}",
    );
}

/// pycomm3 and pylogix.
#[test]
fn logix_values_are_as_its_clients_lay_them_out() {
    let logix = Dialect::Logix;
    both_ways(logix, "BOOL", &hex!("FF"), "TRUE");
    assert_eq!(kind("BOOL").decode(logix, &hex!("01")), Ok(Value::Bool(true)));
    both_ways(logix, "SINT[3]", &hex!("01 FF 80"), "[1, -1, -128]");
    let mut text = hex!("02 00 00 00 48 69").to_vec();
    text.resize(88, 0);
    both_ways(logix, "STRING", &text, "\"Hi\"");
    assert_eq!(kind("STRING").head(logix), Some(TagHead { code: 0xA0, handle: Some(0x0FCE) }));
    let mut bits = vec![0; 8];
    (bits[0], bits[4]) = (0b101, 1);
    let value = kind("BOOL[64]").decode(logix, &bits).unwrap();
    let Value::List(list) = &value else { panic!("{value}") };
    let set: Vec<_> = (0..64).filter(|index| list[*index] == Value::Bool(true)).collect();
    assert_eq!(set, [0, 2, 32]);
    assert_eq!(kind("BOOL[64]").encode(logix, &value).unwrap(), bits);
    assert_eq!((kind("BOOL[64]").head(logix).unwrap().code, kind("BOOL[64]").elements(logix)), (0xD3, 2));
    // Two BOOLs share a byte, the DINT lies at 4, and the BOOL behind it at 8.
    both_ways(
        logix,
        "STRUCT{run: BOOL; fault: BOOL; count: DINT; ready: BOOL}",
        &hex!("02 00 00 00 07 00 00 00 01 00 00 00"),
        "{run: FALSE, fault: TRUE, count: 7, ready: TRUE}",
    );
}

#[test]
fn a_layout_that_a_device_has_told_is_believed() {
    let place = |offset, bit| Some(Place { offset, bit });
    let member = |name: &str, text: &str, place| Member { name: name.into(), kind: kind(text), place };
    let structure = Structure {
        name: "UDT".into(),
        members: vec![member("b", "BOOL", place(9, Some(6))), member("n", "INT", place(2, None))],
        handle: Some(0x1234),
        size: Some(12),
    };
    let kind = Type::Structure(Arc::new(structure));
    let bytes = hex!("00 00 05 00 00 00 00 00 00 40 00 00");
    let value = kind.decode(Dialect::Logix, &bytes).unwrap();
    assert_eq!(value.to_string(), "{b: TRUE, n: 5}");
    assert_eq!(kind.encode(Dialect::Logix, &value).unwrap(), bytes);
    assert_eq!(kind.head(Dialect::Logix), Some(TagHead { code: 0xA0, handle: Some(0x1234) }));
    assert!(kind.decode(Dialect::Logix, &bytes[..8]).is_err(), "a layout that does not fit shows no values");
}

#[test]
fn micro800_texts_have_a_byte_of_length() {
    both_ways(Dialect::Micro800, "STRING", &hex!("02 48 69"), "\"Hi\"");
    assert_eq!(kind("STRING").head(Dialect::Micro800), Some(TagHead { code: 0xDA, handle: None }));
    both_ways(Dialect::Micro800, "BOOL", &hex!("01"), "TRUE");
}

#[test]
fn a_reply_says_its_own_type_where_it_can() {
    for (dialect, reply, elements, text) in [
        (Dialect::Omron, &hex!("C1 00 01 00")[..], 1, Some("BOOL")),
        (Dialect::Omron, &hex!("C3 00 01 00 02 00 03 00"), 1, Some("INT[3]")),
        (Dialect::Logix, &hex!("C4 00 01 00 00 00"), 1, Some("DINT")),
        (Dialect::Logix, &hex!("CA 00 01 00 00 00 02 00 00 00"), 2, Some("REAL[2]")),
        (Dialect::Omron, &hex!("D0 00 02 00 41 42"), 1, Some("STRING")),
        (Dialect::Omron, &hex!("C6 00 07 00"), 1, Some("USINT")),
        (Dialect::Logix, &hex!("A0 02 34 12 00 00"), 1, None),
        (Dialect::Logix, &hex!("07 00 00 00 00 00"), 1, None),
        (Dialect::Omron, &hex!("07 00 00 00 00 00"), 1, Some("ENUM")),
    ] {
        let data = TagData::decode(reply).unwrap();
        let found = Type::of_data(dialect, &data, elements).map(|kind| kind.to_string());
        assert_eq!(found.as_deref(), text, "{dialect:?} {reply:02x?}");
    }
}

#[test]
fn what_a_type_cannot_hold_is_refused_in_words() {
    for (text, value, words) in [
        ("SINT", "128", "128 is outside of SINT: -128 to 127"),
        ("USINT", "-1", "-1 is outside of USINT: 0 to 255"),
        ("UDINT", "0x1_0000_0000", "0x1_0000_0000 is outside of UDINT: 0 to 4294967295"),
        ("UINT_BCD", "10000", "10000 is outside of UINT_BCD: 0 to 9999"),
        ("INT", "1.5", "\"1.5\" is no INT: not a number; write 147, 0x93, 93h or 16#93"),
        ("INT", "3F", "\"3F\" is no INT: hexadecimal needs a mark: 0x93, 93h or 16#93"),
        ("REAL", "12,5", "\"12,5\" is no REAL: write a point, not a comma"),
        ("REAL", "1e39", "1e39 is outside of REAL: -3.4028235e38 to 3.4028235e38"),
        ("REAL", "0x10", "\"0x10\" is no REAL: write 12.5 or 1.25e1"),
        ("REAL", "NaN", "\"NaN\" is no REAL: write 12.5 or 1.25e1"),
        ("BOOL", "2", "\"2\" is no BOOL: write TRUE or FALSE"),
        ("INT[3]", "[1, 2]", "2 elements were given, the array has 3"),
        ("INT[3]", "1, 2, 3", "\"1, 2, 3\" is no list: write [1, 2, 3]"),
        ("STRUCT{a: INT; b: INT}", "{a: 1, c: 2}", "the member \"c\" is not in the structure"),
    ] {
        assert_eq!(kind(text).parse_value(value).unwrap_err().to_string(), words);
    }
    let missing = kind("STRUCT{a: INT; b: INT}").parse_value("{a: 1}").unwrap();
    let refused = kind("STRUCT{a: INT; b: INT}").encode(Dialect::Logix, &missing).unwrap_err();
    assert_eq!(refused, ValueError::Member("b".into(), "is missing: all are written together"));
    let long = Value::Text(vec![b'a'; 83]);
    let refused = kind("STRING").encode(Dialect::Logix, &long).unwrap_err();
    assert_eq!(refused.to_string(), "83 bytes of text: at most 82 fit");
    assert!(kind("STRING[300]").encode(Dialect::Micro800, &Value::Text(vec![b'a'; 256])).is_err());
}

#[test]
fn texts_keep_every_byte() {
    let value = Value::Text(b"a\"\\\x00\xFF\xC3\xA4".to_vec());
    assert_eq!(value.to_string(), r#""a\"\\\x00\xFFä""#);
    assert_eq!(kind("STRING").parse_value(&value.to_string()).unwrap(), value);
    assert_eq!(kind("STRING").parse_value("plain text").unwrap(), Value::Text(b"plain text".to_vec()));
    let list = kind("STRING[9][2]").parse_value(r#"["a, \"b", "]"]"#).unwrap();
    assert_eq!(list, Value::List(vec![Value::Text(b"a, \"b".to_vec()), Value::Text(b"]".to_vec())]));
}

#[test]
fn a_view_scales_both_ways_or_says_why_not() {
    let view = View { scale: Some(Scale { factor: 0.1, offset: 0.0 }), ..View::default() };
    let int = kind("INT");
    assert_eq!(view.text(Some(&int), &Value::Signed(123)), "12.3");
    assert_eq!(view.number(&Value::Signed(123)), Some(12.3));
    assert_eq!(view.parse(&int, "12.3"), Ok(Value::Signed(123)));
    assert_eq!(view.parse(&int, "-0.1"), Ok(Value::Signed(-1)));
    let between = view.parse(&int, "12.34").unwrap_err().to_string();
    assert_eq!(between, "12.34 cannot be held exactly: the nearest are 12.3 and 12.4");
    assert!(view.parse(&int, "4000").unwrap_err().to_string().contains("outside of INT"));
    let view = View { scale: Some(Scale { factor: 0.5, offset: -40.0 }), digits: Some(2), ..View::default() };
    assert_eq!(view.text(Some(&kind("UINT")), &Value::Unsigned(3)), "-38.50");
    assert_eq!(view.parse(&kind("UINT"), "-38.5"), Ok(Value::Unsigned(3)));
    assert_eq!(view.parse(&kind("REAL"), "-38.5"), Ok(Value::Real(3.0)));
}

#[test]
fn a_view_writes_bits_words_and_characters() {
    let show =
        |display, text: &str, value| View { display, ..View::default() }.text(Some(&kind(text)), &value);
    assert_eq!(show(Display::Auto, "WORD", Value::Unsigned(0xAB)), "0x00AB");
    assert_eq!(show(Display::Dec, "WORD", Value::Unsigned(0xAB)), "171");
    assert_eq!(show(Display::Hex, "INT", Value::Signed(-1)), "0xFFFF");
    assert_eq!(show(Display::Bin, "SINT", Value::Signed(5)), "0b0000_0101");
    assert_eq!(show(Display::Float, "DINT", Value::Signed(0x4248_0000)), "50");
    assert_eq!(show(Display::Ascii, "DINT", Value::Signed(0x4443_4241)), "\"ABCD\"");
    assert_eq!(show(Display::Hex, "REAL", Value::Real(50.0)), "0x42480000");
    let choices = [(0, "stopped".to_owned()), (1, "running".to_owned())].into();
    let view = View { choices, ..View::default() };
    assert_eq!(view.text(Some(&kind("INT")), &Value::Signed(1)), "running (1)");
    assert_eq!(view.text(Some(&kind("INT")), &Value::Signed(7)), "7");
    assert_eq!(view.parse(&kind("INT"), "Running"), Ok(Value::Signed(1)));
}

#[test]
fn a_part_is_found_in_the_whole() {
    let whole = kind("STRUCT{in: STRUCT{a: INT[1..3]}[2]; b: DINT}");
    let value = whole.parse_value("{in: [{a: [1, 2, 3]}, {a: [4, 5, 6]}], b: 9}").unwrap();
    let name: TagName = "st.in[1].a[3]".parse().unwrap();
    let steps = name.within(&"st".parse().unwrap()).unwrap();
    assert_eq!(value.step(&whole, steps), Some(&Value::Signed(6)));
    assert_eq!(whole.step(steps), Some(&Type::Elementary(Elementary::Int)));
    for missing in ["st.in[2].a[1]", "st.in[1].a[0]", "st.in[1].a[4]", "st.c", "st.in[0,0]", "st.b.c"] {
        let name: TagName = missing.parse().unwrap();
        let steps = name.within(&"st".parse().unwrap()).unwrap();
        assert_eq!((value.step(&whole, steps), whole.step(steps)), (None, None), "{missing}");
    }
    assert_eq!(Value::Signed(-1).bit(63), Some(true));
    assert_eq!(Dimensions::new(vec![Dimension { first: u32::MAX, length: 2 }]), None);
}

#[cfg(not(target_arch = "wasm32"))]
mod any {
    use super::*;
    use proptest::prelude::*;

    fn elementary() -> impl Strategy<Value = Elementary> {
        proptest::sample::select(Elementary::ALL)
    }

    fn any_kind() -> impl Strategy<Value = Type> {
        let leaf = prop_oneof![
            elementary().prop_map(Type::Elementary),
            (1_u16..40).prop_map(|capacity| Type::String(Some(capacity))),
        ];
        leaf.prop_recursive(3, 12, 4, |inner| {
            let array = (inner.clone(), prop::collection::vec((0_u32..3, 1_u32..5), 1..=3)).prop_map(
                |(kind, all)| {
                    let all = all.into_iter().map(|(first, length)| Dimension { first, length }).collect();
                    // An array of arrays is an array of more dimensions.
                    match kind {
                        Type::Array(..) => kind,
                        kind => Type::Array(Box::new(kind), Dimensions::new(all).unwrap()),
                    }
                },
            );
            let structure = prop::collection::vec(inner, 1..5).prop_map(|kinds| {
                let member = |(place, kind)| Member { name: format!("m{place}"), kind, place: None };
                let members = kinds.into_iter().enumerate().map(member).collect();
                Type::Structure(Arc::new(Structure { members, ..Structure::default() }))
            });
            prop_oneof![array, structure]
        })
    }

    /// A value of a type, made of any bytes.
    fn value_of(kind: &Type, dialect: Dialect, bytes: &mut impl Iterator<Item = u8>) -> Value {
        match kind {
            Type::Elementary(elementary) => {
                let size = elementary.size(dialect);
                let raw: Vec<u8> = bytes.take(size).collect();
                match kind.decode(dialect, &raw).unwrap() {
                    Value::Raw(_) => Value::Unsigned(7),
                    Value::Real(number) if number.is_nan() => Value::Real(1.0),
                    Value::Lreal(number) if number.is_nan() => Value::Lreal(1.0),
                    value => value,
                }
            }
            Type::String(capacity) => {
                let text = bytes.take(usize::from(capacity.unwrap())).map(|byte| byte | 1).collect();
                Value::Text(text)
            }
            Type::Array(element, dimensions) => {
                Value::List((0..dimensions.count()).map(|_| value_of(element, dialect, bytes)).collect())
            }
            Type::Structure(structure) => {
                let member = |member: &Member| (member.name.clone(), value_of(&member.kind, dialect, bytes));
                Value::Members(structure.members.iter().map(member).collect())
            }
        }
    }

    proptest! {
        #[test]
        fn values_come_back_from_their_bytes(kind in any_kind(), seed in prop::collection::vec(any::<u8>(), 1..64)) {
            for dialect in Dialect::ALL {
                let value = value_of(&kind, dialect, &mut seed.iter().copied().cycle());
                let bytes = kind.encode(dialect, &value).unwrap();
                prop_assert_eq!(kind.decode(dialect, &bytes).unwrap(), value.clone(), "{:?} {}", dialect, kind);
            }
        }

        #[test]
        fn values_come_back_from_their_text(kind in any_kind(), seed in prop::collection::vec(any::<u8>(), 1..64)) {
            let value = value_of(&kind, Dialect::Logix, &mut seed.iter().copied().cycle());
            if !value.to_string().contains("inf") {
                prop_assert_eq!(kind.parse_value(&value.to_string()).unwrap(), value.clone());
            }
            prop_assert_eq!(kind.to_string().parse::<Type>().unwrap(), kind);
        }

        #[test]
        fn any_bytes_are_a_value_or_an_error(kind in any_kind(), bytes in prop::collection::vec(any::<u8>(), 0..200)) {
            for dialect in Dialect::ALL {
                let _ = kind.decode(dialect, &bytes);
                if let Ok(data) = TagData::decode(&bytes) {
                    let _ = Type::of_data(dialect, &data, 1).map(|kind| kind.decode(dialect, data.data));
                }
            }
        }

        #[test]
        fn any_text_is_read_or_refused(text in "\\PC{0,40}") {
            let _ = text.parse::<Type>();
            if let Ok(name) = text.parse::<TagName>() {
                prop_assert_eq!(name.to_string().parse::<TagName>().unwrap(), name);
            }
            for kind in ["REAL", "INT", "STRING", "INT[2]", "STRUCT{a: INT}"] {
                let _ = super::kind(kind).parse_value(&text);
            }
        }
    }
}
