//! Simulated controllers: what they list can be read as it is listed.

use cipdeck_shared::engine::browse::{Access, Browse, BrowseWhat, Symbol};
use cipdeck_shared::engine::poll::{DeviceLimits, Failure, Group, Item, Poller, Quality};
use cipdeck_shared::engine::time::{Instant, Millis};
use cipdeck_shared::plan::effects;
use cipdeck_shared::sim::{Device, SimConnection, SimProfile};
use cipdeck_shared::table;
use cipdeck_shared::tag::{Dialect, TagName, Type, request};
use cipdeck_shared::wire::{
    ClassCode, Command, ConnectedMessage, ConnectionId, ConnectionParameters, ConnectionTriad, Encapsulation,
    Epath, ForwardOpen, ForwardOpenReply, Header, MessageRouterReply, RegisterSession, RequestTimeout,
    SendRrData, SenderContext, SessionHandle, TimeoutMultiplier, UnconnectedMessage,
};
#[cfg(target_arch = "wasm32")]
use wasm_bindgen_test::wasm_bindgen_test as test;

/// Who may only look asks this.
fn assert_reads(request: &[u8]) {
    for effect in effects(request) {
        assert_eq!(effect.access, table::Access::Read, "{request:02x?} {effect:?}");
    }
}

fn run(browse: &mut Browse, device: &mut Device) {
    for _ in 0..10_000 {
        let Some(request) = browse.next_request() else { break };
        assert_eq!(browse.next_request(), None, "one at a time");
        assert_reads(&request);
        let reply = device.answer(&request, Instant::ZERO);
        browse.handle_reply(Ok(&reply));
    }
    assert!(browse.is_done());
}

fn list(profile: SimProfile, what: BrowseWhat) -> Vec<Symbol> {
    let mut device = Device::new(profile.config());
    let mut browse = Browse::new(profile.dialect().unwrap(), what);
    run(&mut browse, &mut device);
    assert_eq!(browse.error(), None);
    browse.found().to_vec()
}

fn structure(profile: SimProfile, symbol: &Symbol) -> Type {
    let mut device = Device::new(profile.config());
    let mut browse = Browse::template(profile.dialect().unwrap(), symbol.template.unwrap());
    run(&mut browse, &mut device);
    browse.kind().unwrap_or_else(|| panic!("{:?}", browse.error())).clone()
}

fn find<'a>(list: &'a [Symbol], name: &str) -> &'a Symbol {
    list.iter().find(|symbol| symbol.name == name).unwrap_or_else(|| panic!("{name} is listed"))
}

#[test]
fn a_logix_tells_its_tags_those_of_its_programs_and_its_structures() {
    let all = list(SimProfile::Logix, BrowseWhat::Tags);
    for (name, text) in [
        ("Scalar", "DINT"),
        ("Flags", "BOOL[64]"),
        ("Matrix", "DINT[3,4]"),
        ("Recipe", "STRING"),
        ("Names", "ARRAY[4] OF STRING"),
        ("Program:Main.x", "DINT"),
        ("Program:Cleaning.Step", "DINT"),
        ("D0999", "DINT"),
    ] {
        assert_eq!(find(&all, name).type_text, text, "{name}");
    }
    assert_eq!(find(&all, "Limit").access, Some(Access::Read));
    assert!(all.iter().all(|symbol| symbol.name != "Hidden" && symbol.name != "Program:Main"));
    let motors = find(&all, "Motors");
    let Type::Structure(motor) = structure(SimProfile::Logix, motors) else { panic!("a structure") };
    assert_eq!(motor.name, "Motor");
    assert_eq!(
        motor.to_string(),
        "STRUCT{Speed: REAL; Run: BOOL; Fault: BOOL; Count: DINT; Mode: SINT; Ready: BOOL; Hist: INT[4]; Name: STRING}"
    );
    let Type::Structure(line) = structure(SimProfile::Logix, find(&all, "Line1")) else {
        panic!("a structure")
    };
    assert_eq!(line.to_string(), "STRUCT{Level: LREAL; Main: Motor; Flags: BOOL[32]; Steps: DINT[3]}");
}

#[test]
fn an_omron_tells_its_variables_and_its_structures() {
    let all = list(SimProfile::Omron, BrowseWhat::Tags);
    for (name, text) in [
        ("TAG1", "BOOL"),
        ("grHWCs_PV", "REAL"),
        ("gsState", "STRING[32]"),
        ("arFrom1", "UINT[1..5]"),
        ("arNames", "STRING[16][4]"),
        ("arTable", "DINT[3,4]"),
        ("Füllstand", "REAL"),
        ("elMode", "ENUM"),
    ] {
        assert_eq!(find(&all, name).type_text, text, "{name}");
    }
    assert!(all.iter().all(|symbol| !symbol.name.starts_with('_') && symbol.name != "gnHidden"));
    let Type::Structure(line) = structure(SimProfile::Omron, find(&all, "stLine")) else {
        panic!("a structure")
    };
    assert_eq!(line.to_string(), "STRUCT{motor: Motor; level: LREAL; temps: INT[4]; name: STRING[16]}");
    let with_system = list(SimProfile::Omron, BrowseWhat::WithSystem);
    assert_eq!(with_system.len(), all.len() + 1);
    find(&with_system, "_CurrentTime");
}

#[test]
fn everything_that_is_listed_is_read_as_what_it_is_listed_as() {
    // a round is one message for each question on a Micro800
    for (profile, connected, most) in [
        (SimProfile::Logix, false, 130),
        (SimProfile::Logix, true, 20),
        (SimProfile::Omron, false, 12),
        (SimProfile::Omron, true, 5),
        (SimProfile::Micro800, true, 60),
    ] {
        let dialect = profile.dialect().unwrap();
        let mut line = Line::new(profile, connected);
        let symbols = line.list(dialect);
        assert!(symbols.len() > 15, "{profile}: {}", symbols.len());
        let items: Vec<Item> = symbols
            .iter()
            .zip(1..)
            .map(|(symbol, id)| {
                let structure = || structure(profile, symbol);
                let kind = symbol.kind.clone().or_else(|| symbol.with_structure(&structure()));
                Item { id, name: symbol.name.parse().unwrap(), kind: Some(kind.unwrap()) }
            })
            .collect();
        let mut poller = Poller::new(DeviceLimits::of(dialect, connected));
        poller.put_group(Group { id: 1, period: Millis(1_000), on: true, items: items.clone() }, Instant(0));
        for now in (1..3_000).map(|ms| Instant(1_000 * ms)) {
            if let Some(request) = poller.poll_request(now) {
                assert_reads(&request.bytes);
                let reply = line.ask(&request.bytes, now);
                poller.handle_reply(now, Ok(&reply));
            }
        }
        for item in &items {
            let reading = poller.reading(item.id).unwrap();
            assert_eq!(reading.quality, Quality::Good, "{profile} {} {:?}", item.name, reading.reason);
            assert_eq!(reading.kind, item.kind, "{}", item.name);
        }
        let load = poller.load();
        assert!(load.requests_per_cycle <= most, "{profile} {connected}: {load:?}");
    }
}

/// A device, with a connection to it or without.
struct Line {
    device: Device,
    connection: Option<(SimConnection, Header, ConnectionId)>,
    sequence: u16,
}

impl Line {
    fn new(profile: SimProfile, connected: bool) -> Self {
        let mut line = Self { device: Device::new(profile.config()), connection: None, sequence: 0 };
        if connected {
            line.connect(if profile == SimProfile::Omron { 1_994 } else { 4_002 });
        }
        line
    }

    fn connect(&mut self, size: u16) {
        let mut connection = SimConnection::new();
        let header = |command, session| Header::request(command, session, SenderContext::from(1));
        let mut frame = Vec::new();
        let register = RegisterSession::CURRENT.bytes();
        Encapsulation::new(header(Command::RegisterSession, SessionHandle(0)), &register)
            .unwrap()
            .encode(&mut frame);
        let reply = exchange(&mut connection, &mut self.device, &frame, Instant::ZERO);
        let session = Encapsulation::decode(&reply).unwrap().header.session;
        let open = ForwardOpen {
            timeout: RequestTimeout::at_least(1_000),
            o_t_id: ConnectionId(0),
            t_o_id: ConnectionId(7),
            triad: ConnectionTriad { serial: 1, vendor: 2, originator: 3 },
            multiplier: TimeoutMultiplier(3),
            o_t_rpi_us: 2_000_000,
            o_t: ConnectionParameters::explicit(size),
            t_o_rpi_us: 2_000_000,
            t_o: ConnectionParameters::explicit(size),
            transport: ForwardOpen::CLASS_3,
            path: Epath::object(ClassCode::MessageRouter.0, 1),
        };
        let (mut frame, request) = (Vec::new(), open.request(true).unwrap().bytes());
        let unconnected = header(Command::SendRRData, session);
        UnconnectedMessage::new(&request).unwrap().encode(&unconnected, 3, &mut frame);
        let reply = exchange(&mut connection, &mut self.device, &frame, Instant::ZERO);
        let frame = Encapsulation::decode(&reply).unwrap();
        let message = SendRrData::decode(frame.data()).unwrap().unconnected().unwrap().data.to_vec();
        let reply = MessageRouterReply::decode(&message).unwrap();
        let id = ForwardOpenReply::decode(reply.data).unwrap().o_t_id;
        self.connection = Some((connection, header(Command::SendUnitData, session), id));
    }

    fn ask(&mut self, request: &[u8], now: Instant) -> Vec<u8> {
        let Some((connection, header, id)) = &mut self.connection else {
            return self.device.answer(request, now);
        };
        self.sequence = self.sequence.wrapping_add(1);
        let mut frame = Vec::new();
        ConnectedMessage::new(request).unwrap().encode(header, *id, self.sequence, &mut frame);
        let reply = exchange(connection, &mut self.device, &frame, now);
        let frame = Encapsulation::decode(&reply).unwrap();
        SendRrData::decode(frame.data()).unwrap().connected().unwrap().message.to_vec()
    }

    fn list(&mut self, dialect: Dialect) -> Vec<Symbol> {
        let mut browse = Browse::new(dialect, BrowseWhat::WithSystem);
        while let Some(request) = browse.next_request() {
            let reply = self.ask(&request, Instant::ZERO);
            browse.handle_reply(Ok(&reply));
        }
        assert_eq!(browse.error(), None);
        browse.found().to_vec()
    }
}

fn exchange(connection: &mut SimConnection, device: &mut Device, frame: &[u8], now: Instant) -> Vec<u8> {
    connection.handle_input(device, frame, now);
    let mut out = Vec::new();
    connection.poll_transmit(&mut out, now);
    out
}

#[test]
fn a_structure_that_somebody_has_described_is_read_with_the_handle_that_writing_needs() {
    let logix = "STRUCT{Speed: REAL; Run: BOOL; Fault: BOOL; Count: DINT; Mode: SINT; Ready: BOOL; Hist: INT[4]; Name: STRING}";
    for (profile, name, kind) in [
        (SimProfile::Omron, "stSet", "STRUCT{speed: REAL; run: BOOL; count: DINT}"),
        (SimProfile::Logix, "Motor1", logix),
    ] {
        let (dialect, mut device) = (profile.dialect().unwrap(), Device::new(profile.config()));
        let mut poller = Poller::new(DeviceLimits::of(dialect, false));
        let item = Item { id: 1, name: name.parse().unwrap(), kind: Some(kind.parse().unwrap()) };
        poller.put_group(Group { id: 1, period: Millis(100), on: true, items: vec![item] }, Instant::ZERO);
        let request = poller.poll_request(Instant::ZERO).unwrap();
        poller.handle_reply(Instant::ZERO, Ok(&device.answer(&request.bytes, Instant::ZERO)));
        let reading = poller.reading(1).unwrap();
        assert_eq!(reading.quality, Quality::Good, "{:?}", reading.reason);
        let (kind, value) = (reading.kind.clone().unwrap(), reading.value.clone().unwrap());
        let data = kind.encode(dialect, &value).unwrap();
        let head = kind.head(dialect).expect("the handle was told");
        let write = request::write(name.parse::<TagName>().unwrap().path(), head, 1, &data).unwrap();
        assert_eq!(device.answer(&write.bytes(), Instant::ZERO)[2], 0, "{name} is written");
    }
}

#[test]
fn a_list_that_cannot_be_had_says_why() {
    for dialect in Dialect::ALL {
        let mut device = Device::new(SimProfile::Generic.config());
        let mut browse = Browse::new(dialect, BrowseWhat::Tags);
        run(&mut browse, &mut device);
        assert!(browse.error().unwrap().starts_with("the device does not list its"), "{:?}", browse.error());
    }
    let mut browse = Browse::new(Dialect::Logix, BrowseWhat::Tags);
    browse.next_request().unwrap();
    browse.handle_reply(Err(Failure::Lost { reason: "no answer".into() }));
    assert_eq!((browse.is_done(), browse.error()), (true, Some("no answer")));
    let micro = Browse::template(Dialect::Micro800, 1);
    assert!(micro.is_done() && micro.error().is_some());
}

#[test]
fn a_list_that_does_not_go_on_ends() {
    let mut browse = Browse::new(Dialect::Logix, BrowseWhat::Tags);
    // status 06 with one entry, again and again
    let entry = hex_literal::hex!("05 00 00 00 01 00 41 C4 00 00000000 00000000 00000000 00");
    let reply = [&hex_literal::hex!("D5 00 06 00")[..], &entry].concat();
    for _ in 0..3 {
        if browse.next_request().is_some() {
            browse.handle_reply(Ok(&reply));
        }
    }
    assert!(browse.error().unwrap().contains("does not go on"), "{:?}", browse.error());
}

#[cfg(not(target_arch = "wasm32"))]
proptest::proptest! {
    #[test]
    fn whatever_is_answered_a_list_ends_or_goes_on(
        replies in proptest::collection::vec(proptest::collection::vec(proptest::prelude::any::<u8>(), 0..80), 1..30),
        which in 0..5_usize,
    ) {
        let mut browse = match which {
            0 => Browse::new(Dialect::Logix, BrowseWhat::WithSystem),
            1 => Browse::new(Dialect::Micro800, BrowseWhat::Tags),
            2 => Browse::new(Dialect::Omron, BrowseWhat::WithSystem),
            3 => Browse::template(Dialect::Logix, 300),
            _ => Browse::template(Dialect::Omron, 3),
        };
        for reply in replies {
            let Some(request) = browse.next_request() else { break };
            let head = [request[0] | 0x80, 0, if reply.first().is_some_and(|byte| byte & 1 != 0) { 6 } else { 0 }, 0];
            browse.handle_reply(Ok(&[&head[..], &reply].concat()));
        }
    }
}
