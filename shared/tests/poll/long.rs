//! Values that are longer than a reply.

use cipdeck_shared::engine::poll::{Quality, Reason};
use cipdeck_shared::tag::Dialect;

use crate::device::Device;
use crate::owner::Owner;
#[cfg(target_arch = "wasm32")]
use wasm_bindgen_test::wasm_bindgen_test as test;

fn list(count: usize) -> String {
    format!("[{}]", (0..count).map(|number| number.to_string()).collect::<Vec<_>>().join(", "))
}

#[test]
fn a_long_array_is_put_together_in_the_familys_own_way() {
    for (dialect, requests) in [(Dialect::Logix, 9), (Dialect::Omron, 9), (Dialect::Micro800, 9)] {
        let mut owner = Owner::new(Device::new(dialect).with("Arr", "DINT[1000]", &list(1_000)));
        owner.group(1, 1_000, &["Arr : DINT[1000]", "Arr[999]"]);
        owner.run(500);
        owner.all_good(&[(10, &list(1_000)), (11, "999")]);
        assert_eq!(owner.requests().len(), requests, "{dialect:?}");
        owner.run(1_000);
        assert_eq!(owner.requests().len(), requests, "{dialect:?}");
    }
}

#[test]
fn two_dimensions_are_read_row_by_row_where_ranges_are_the_only_way() {
    let row = list(100);
    let kind = "DINT[3,100]";
    let rows = format!("[{}]", [row.trim_matches(['[', ']']); 3].join(", "));
    let mut owner = Owner::new(Device::new(Dialect::Micro800).with("Arr", kind, &rows));
    owner.group(1, 1_000, &[&format!("Arr : {kind}"), "Arr[2,99]"]);
    owner.run(500);
    owner.all_good(&[(10, &rows), (11, "99")]);
}

#[test]
fn an_omron_array_of_unknown_length_is_read_to_its_end() {
    let mut owner = Owner::new(Device::new(Dialect::Omron).with("Arr", "INT[700]", &list(700)));
    owner.group(1, 1_000, &["Arr"]);
    owner.run(500);
    owner.all_good(&[(10, &list(700))]);
    let requests = owner.requests().len();
    assert!(requests < 20, "{requests}");
}

#[test]
fn a_long_text_of_an_omron_comes_in_parts_with_their_own_counts() {
    let text = format!("\"{}\"", "0123456789".repeat(150));
    let mut owner = Owner::new(Device::new(Dialect::Omron).with("text", "STRING[1900]", &text));
    owner.group(1, 1_000, &["text", "text : STRING[1900]"]);
    owner.run(500);
    owner.all_good(&[(10, &text), (11, &text)]);
}

#[test]
fn a_long_structure_comes_whole() {
    let kind = "STRUCT{a: DINT[300]; b: INT}";
    let value = format!("{{a: {}, b: 7}}", list(300));
    for dialect in [Dialect::Logix, Dialect::Omron] {
        let mut owner = Owner::new(Device::new(dialect).with("st", kind, &value));
        owner.group(1, 1_000, &[&format!("st : {kind}"), "st.b", "st.a[299]"]);
        owner.run(500);
        owner.all_good(&[(11, "7"), (12, "299")]);
        owner.run(1_000);
        owner.all_good(&[(10, &value)]);
    }
    let mut owner = Owner::new(Device::new(Dialect::Micro800).with("st", kind, &value));
    owner.group(1, 1_000, &[&format!("st : {kind}"), "st.b"]);
    owner.run(500);
    assert_eq!(
        (owner.reading(10).quality, &owner.reading(10).reason),
        (Quality::Bad, &Some(Reason::ValueTooLong))
    );
    owner.all_good(&[(11, "7")]);
}

#[test]
fn a_logix_without_fragments_is_read_in_ranges() {
    let device = Device::new(Dialect::Logix).with("Arr", "DINT[300]", &list(300));
    let mut owner = Owner::new(Device { fragments: false, ..device });
    owner.group(1, 1_000, &["Arr : DINT[300]"]);
    owner.run(500);
    owner.all_good(&[(10, &list(300))]);
}
