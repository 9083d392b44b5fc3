use super::*;
use alloc::string::ToString;
use alloc::vec;

fn endpoint(ip: [u8; 4]) -> Endpoint {
    Endpoint { host: Host::Ip(ip), port: 44818 }
}

#[test]
fn each_form_is_read_and_written_as_the_manuals_have_it() {
    let etc100: PlcAddress = "ADDR('{1.2}0.2.0.192.168.1.102')".parse().unwrap();
    assert_eq!(
        etc100,
        PlcAddress {
            function: Some(AddressFunction::Addr),
            xway: Some(Xway { network: 1, station: 2 }),
            rack: 0,
            module: 2,
            channel: 0,
            device: Some(AddressDevice::Dotted(endpoint([192, 168, 1, 102]))),
        }
    );
    let etc101: PlcAddress = "ADDR('{1.2}0.4.0')".parse().unwrap();
    assert_eq!((etc101.module, etc101.device.clone(), etc101.target()), (4, None, None));
    let exchange: PlcAddress = "ADDMX('0.0.3{192.168.1.102}CON.CIP')".parse().unwrap();
    assert_eq!(
        exchange.device,
        Some(AddressDevice::Braced(endpoint([192, 168, 1, 102]), AddressMode::Connected))
    );
    for text in [
        "ADDR('{1.2}0.2.0.192.168.1.102')",
        "ADDR('0.2.0.192.168.1.102:44820')",
        "ADDR('0.4.0')",
        "ADDM('0.0.3{192.168.1.102}UNC.CIP')",
        "ADDMX('0.0.3{192.168.1.102:44820}CON.CIP')",
    ] {
        assert_eq!(text.parse::<PlcAddress>().map(|address| address.to_string()).as_deref(), Ok(text));
    }
}

#[test]
fn what_people_paste_is_read() {
    for text in [
        "0.2.0.192.168.1.102",
        " '0.2.0.192.168.1.102' ",
        "addr ( \u{2018}0.2.0.192.168.1.102\u{2019} )",
        "ADDR(\"0 . 2 . 0 . 192.168.1.102\")",
        "ADDR(\u{201E}0.2.0.192.168.1.102\u{201C})",
        "ADDR(0.2.0.192.168.1.102)",
    ] {
        let address: PlcAddress = text.parse().unwrap_or_else(|error| panic!("{text}: {error}"));
        assert_eq!(address.to_string(), "ADDR('0.2.0.192.168.1.102')", "{text}");
    }
    let bare: PlcAddress = "0.1.0{10.0.0.1}unc.cip".parse().unwrap();
    assert_eq!(bare.to_string(), "ADDMX('0.1.0{10.0.0.1}UNC.CIP')");
}

#[test]
fn the_address_of_nobody_is_the_built_in_device() {
    for text in ["ADDR('0.2.0.0.0.0.0')", "ADDMX('0.2.0{0.0.0.0}UNC.CIP')"] {
        assert_eq!(text.parse::<PlcAddress>().unwrap().target(), Some(Target::BuiltIn));
    }
    let network: PlcAddress = "0.2.0.10.0.0.1".parse().unwrap();
    assert_eq!(network.target(), Some(Target::Network(endpoint([10, 0, 0, 1]))));
}

#[test]
fn each_part_is_explained_where_it_is() {
    let text = "ADDMX(\u{2019}{3.4}0.2.1{10.0.0.1:44820}UNC.CIP\u{2019})";
    let (_, parts) = PlcAddress::read(text).unwrap();
    let shown: Vec<_> = parts.iter().map(|part| (part.name, &text[part.range.clone()])).collect();
    assert_eq!(
        shown,
        vec![
            ("function", "ADDMX"),
            ("network", "3"),
            ("station", "4"),
            ("rack", "0"),
            ("module", "2"),
            ("channel", "1"),
            ("ip", "10.0.0.1"),
            ("port", "44820"),
            ("mode", "UNC.CIP"),
        ]
    );
    assert!(parts.iter().all(|part| !part.text.is_empty()));
}

#[test]
fn what_is_no_address_says_where_and_what_to_write() {
    use AddressErrorKind as Kind;
    let long = "0.2.0.".repeat(20);
    for (text, position, kind) in [
        ("", 0, Kind::Empty),
        ("  ", 0, Kind::Empty),
        (long.as_str(), 0, Kind::TooLong),
        ("ADDX('0.2.0')", 0, Kind::UnknownFunction),
        ("ADDR '0.2.0'", 5, Kind::Expected(Needed::Open)),
        ("ADDR('0.2.0'", 12, Kind::Expected(Needed::Close)),
        ("ADDR('0.2.0)", 11, Kind::Expected(Needed::Quote)),
        ("0.2", 3, Kind::Expected(Needed::Dot("the channel"))),
        ("0..0", 2, Kind::Expected(Needed::Number("the module"))),
        ("é0.2.0", 0, Kind::UnknownFunction),
        ("0.2.300", 4, Kind::TooBig),
        ("0.2.0.192.168.1", 15, Kind::Expected(Needed::Dot("the IP address's next number"))),
        ("0.2.0.192.168.1.256", 16, Kind::TooBig),
        ("0.2.0.192.168.1.2:0", 18, Kind::BadPort),
        ("0.2.0.192.168.1.2:65536", 18, Kind::BadPort),
        ("0.2.0{192.168.1.2}", 18, Kind::MissingMode),
        ("0.2.0{192.168.1.2}TCP.MBS", 18, Kind::UnknownMode),
        ("0.2.0{192.168.1.2", 17, Kind::Expected(Needed::Brace)),
        ("0.2.0 UNC.CIP", 6, Kind::ModeWithoutDevice),
        ("0.2.0.192.168.1.2 UNC.CIP", 18, Kind::ModeWithoutDevice),
        ("0.2.SYS", 4, Kind::Expected(Needed::Number("the channel"))),
        ("0.2.0)", 5, Kind::Surplus),
        ("{1.2}", 5, Kind::Expected(Needed::Number("the rack"))),
        ("{1.2 0.2.0", 5, Kind::Expected(Needed::Brace)),
    ] {
        let error = text.parse::<PlcAddress>().unwrap_err();
        assert_eq!((error.position, error.kind), (position, kind), "{text}");
        assert!(!error.to_string().is_empty());
    }
}
