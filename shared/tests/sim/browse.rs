//! What controllers tell of their tags.

use cipdeck_shared::sim::{Device, SimConfig, SimProfile, TagMemory};
use cipdeck_shared::tag::Dialect;
use hex_literal::hex;

use super::frames::{ask, at};

#[cfg(target_arch = "wasm32")]
use wasm_bindgen_test::wasm_bindgen_test as test;

fn controller(profile: SimProfile, tags: &str) -> Device {
    let memory = TagMemory::from_json(profile.dialect().unwrap(), tags).unwrap();
    Device::new(SimConfig { tags: Some(memory.into()), ..profile.config() })
}

const LOGIX: &str = r#"{"types":[{"name":"Motor","type":"STRUCT{Speed: REAL; Run: BOOL; Hist: INT[4]}"}],
    "tags":[{"name":"A","type":"DINT"},{"name":"M","type":"Motor[2]","access":"read"},{"name":"B","type":"BOOL[64]"},
    {"name":"Hidden","type":"DINT","access":"none"},{"name":"Program:Main.x","type":"INT[2,3]"}]}"#;

#[test]
fn a_logix_lists_its_symbols_and_those_of_its_programs() {
    let mut device = controller(SimProfile::Logix, LOGIX);
    // pycomm3: 0x55 from an instance on; attributes 1 name, 2 type, 8 dimensions, 10 access.
    let request = hex!("55 02 20 6B 24 00 04 00 01 00 02 00 08 00 0A 00");
    let (status, data) = ask(&mut device, &request, at(0));
    let expected = [
        &hex!("01 00 00 00 01 00 41 C4 00 00000000 00000000 00000000 00")[..],
        &hex!("02 00 00 00 01 00 4D 01 A1 02000000 00000000 00000000 02"),
        &hex!("03 00 00 00 01 00 42 D3 20 02000000 00000000 00000000 00"),
        &hex!("06 00 00 00 0C 00 50726F6772616D3A4D61696E 68 10 00000000 00000000 00000000 00"),
    ];
    assert_eq!((status, data), (0, expected.concat()));
    let program = hex!("55 09 91 0C 50726F6772616D3A4D61696E 20 6B 24 00 03 00 01 00 02 00 08 00");
    let (status, data) = ask(&mut device, &program, at(0));
    assert_eq!((status, data), (0, hex!("05 00 00 00 01 00 78 C3 40 02000000 03000000 00000000").to_vec()));
    let nobody = hex!("55 08 91 09 50726F6772616D3A58 00 20 6B 24 00 01 00 01 00");
    assert_eq!(ask(&mut device, &nobody, at(0)).0, 0x04);
    assert_eq!(ask(&mut device, &hex!("55 02 20 6B 24 00 01 00 63 00"), at(0)).0, 0x14);
}

#[test]
fn a_long_list_comes_in_parts() {
    let mut device = controller(SimProfile::Logix, r#"[{"name":"D###","type":"DINT","times":120}]"#);
    let (mut from, mut names, mut statuses) = (0_u16, Vec::new(), Vec::new());
    loop {
        let [low, high] = from.to_le_bytes();
        let request = [&hex!("55 03 20 6B 25 00")[..], &[low, high], &hex!("01 00 01 00")].concat();
        let (status, data) = ask(&mut device, &request, at(0));
        statuses.push(status);
        for entry in data.chunks(10) {
            names.push(String::from_utf8_lossy(&entry[6..]).into_owned());
            from = u16::from_le_bytes([entry[0], entry[1]]) + 1;
        }
        if status != 6 {
            break;
        }
    }
    assert_eq!((names.len(), names[119].as_str()), (120, "D119"));
    assert_eq!(statuses, [6, 6, 0]);
}

#[test]
fn a_logix_describes_its_structures() {
    let mut device = controller(SimProfile::Logix, LOGIX);
    // pycomm3: attributes 4 size of the definition, 5 size of the structure, 2 members, 1 handle.
    let (status, data) =
        ask(&mut device, &hex!("03 03 20 6C 25 00 01 01 04 00 04 00 05 00 02 00 01 00"), at(0));
    assert_eq!(status, 0);
    assert_eq!(data[..2], hex!("04 00"));
    assert_eq!(data[10..18], hex!("05 00 00 00 10 00 00 00"), "16 bytes");
    assert_eq!(data[18..24], hex!("02 00 00 00 04 00"), "4 members, one of them hidden");
    let words = u32::from_le_bytes([data[6], data[7], data[8], data[9]]);
    // pycomm3 takes off 21 bytes, pylogix rounds what is left of 23 up.
    for size in [words * 4 - 21, words * 4 - 20] {
        let size = u16::try_from(size).unwrap().to_le_bytes();
        let request = [&hex!("4C 03 20 6C 25 00 01 01 00 00 00 00")[..], &size].concat();
        let (status, data) = ask(&mut device, &request, at(0));
        assert_eq!((status, data.len()), (0, usize::from(u16::from_le_bytes(size))));
        let members = [
            &hex!("00 00 CA 00 00 00 00 00")[..],
            &hex!("00 00 C2 00 04 00 00 00"),
            &hex!("00 00 C1 00 04 00 00 00"),
            &hex!("04 00 C3 20 08 00 00 00"),
        ];
        assert_eq!(data[..32], members.concat());
        let names = String::from_utf8_lossy(&data[32..]).into_owned();
        let names: Vec<&str> = names.trim_end_matches('\0').split('\0').collect();
        assert_eq!(names, ["Motor;nEBE@EBEB", "Speed", "ZZZZZZZZZZMotor1", "Run", "Hist"]);
    }
    assert_eq!(ask(&mut device, &hex!("03 03 20 6C 25 00 02 01 01 00 01 00"), at(0)).0, 0x05);
    // The structure of STRING: 88 bytes, handle 0FCE.
    let (status, data) = ask(&mut device, &hex!("03 03 20 6C 25 00 CE 0F 02 00 05 00 01 00"), at(0));
    assert_eq!((status, data), (0, hex!("02 00 05 00 00 00 58 00 00 00 01 00 00 00 CE 0F").to_vec()));
}

const OMRON: &str = r#"{"types":[{"name":"Motor","type":"STRUCT{speed: REAL; run: BOOL}"}],
    "tags":[{"name":"A","type":"DINT"},{"name":"M","type":"Motor[1..2]"},{"name":"_S","type":"BOOL"},
    {"name":"Hidden","type":"DINT","access":"none"},{"name":"T","type":"STRING[8]"}]}"#;

#[test]
fn an_omron_lists_its_variables() {
    let mut device = controller(SimProfile::Omron, OMRON);
    // aphyt: from 1, 100 of them, kind 2 = user.
    let user = ask(&mut device, &hex!("5F 03 20 6A 25 00 00 00 01000000 64000000 0200"), at(0));
    let names = hex!(
        "0300 00 00  01000000 0800 6B00 01000000 01 41  02000000 0800 6B00 02000000 01 4D  03000000 0800 6B00 05000000 01 54"
    );
    assert_eq!(user, (0, names.to_vec()));
    let system = ask(&mut device, &hex!("5F 03 20 6A 25 00 00 00 01000000 64000000 0100"), at(0));
    assert_eq!(system, (0, hex!("0100 00 00  01000000 0900 6B00 03000000 02 5F53").to_vec()));
    let one = ask(&mut device, &hex!("5F 03 20 6A 25 00 00 00 01000000 01000000 0200"), at(0));
    assert_eq!(one, (0, hex!("0100 01 00  01000000 0800 6B00 01000000 01 41").to_vec()), "there are more");
}

#[test]
fn an_omron_describes_its_variables_and_types() {
    let mut device = controller(SimProfile::Omron, OMRON);
    let by_name = ask(&mut device, &hex!("01 02 91 01 41 00"), at(0));
    let golden = hex!("04000000 C4 C4 00 00  00000000 0000000000000000 00000000");
    assert_eq!(by_name, (0, golden.to_vec()));
    assert_eq!(ask(&mut device, &hex!("01 02 20 6B 24 01"), at(0)), by_name, "by its instance");
    let array = ask(&mut device, &hex!("01 02 91 01 4D 00"), at(0));
    let golden = hex!("08000000 A3 A2 01 00  02000000  01000000 0000000000000000 01000000  01000000");
    assert_eq!(array, (0, golden.to_vec()));
    let kind = ask(&mut device, &hex!("01 02 20 6C 24 01"), at(0));
    let crc = &kind.1[14..16];
    let golden =
        [&hex!("08000000 00 A2 A2 00  0200 00000000")[..], crc, &hex!("05 4D6F746F72  00000000 02000000")];
    assert_eq!((kind.0, kind.1.clone()), (0, golden.concat()));
    let member = ask(&mut device, &hex!("01 02 20 6C 24 02"), at(0));
    let golden = hex!("04000000 00 CA CA 00  0000 00000000 0000  05 7370656564  03000000 00000000");
    assert_eq!(member, (0, golden.to_vec()));
    for missing in [&hex!("01 02 20 6C 24 09")[..], &hex!("01 02 20 6B 24 04")] {
        assert_eq!(ask(&mut device, missing, at(0)).0, 0x05);
    }
    assert_eq!(ask(&mut device, &hex!("01 04 91 06 48696464656E"), at(0)).0, 0x04);
}

#[test]
fn a_micro800_tells_nothing_without_a_connection() {
    assert!(TagMemory::usual(Dialect::Micro800).len() > 10);
    let mut device = Device::new(SimProfile::Micro800.config());
    assert_eq!(ask(&mut device, &hex!("55 02 20 6B 24 00 01 00 01 00"), at(0)).0, 0x08);
}
