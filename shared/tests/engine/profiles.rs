//! Profiles: what kind of device changes, and how it is found out.

use cipdeck_shared::config::{BlockId, Profile};
use cipdeck_shared::wire::{Command, EncapsulationStatus, UnconnectedSend};

#[cfg(target_arch = "wasm32")]
use wasm_bindgen_test::wasm_bindgen_test as test;

use crate::owner::{Owner, encapsulation};
use crate::target::identity;

const A: BlockId = BlockId(1);
const B: BlockId = BlockId(2);
const OWN_SLOT: &str = "4,10.0.0.1,1,0";

fn running(path: &str, profile: Profile, connected: bool) -> (Owner, cipdeck_shared::engine::LinkId) {
    let mut owner = Owner::new();
    owner.put_connected(A, path, |config| {
        (config.profile, config.target_cfg.cip_conn_mode) = (profile, connected.into());
    });
    owner.run(A).unwrap();
    let link = owner.register();
    (owner, link)
}

#[test]
fn a_micro800_gets_no_route_to_its_own_slot() {
    let (owner, _) = running(OWN_SLOT, Profile::Micro800, false);
    assert_eq!(owner.trace(), ["register", "unconnected"]);
    let (owner, link) = running(OWN_SLOT, Profile::Micro800, true);
    assert_eq!(owner.last(link).open().path.bytes(), [0x20, 2, 0x24, 1]);
    let (owner, link) = running("4,10.0.0.1,2,192.168.1.20,1,0", Profile::Micro800, false);
    let request = owner.last(link).request.unwrap();
    assert_eq!(UnconnectedSend::decode(request.data()).unwrap().route.bytes(), b"\x12\x0C192.168.1.20");
}

#[test]
fn others_get_what_was_typed() {
    for profile in [Profile::Generic, Profile::Logix, Profile::Omron] {
        let (owner, _) = running(OWN_SLOT, profile, false);
        assert_eq!(owner.trace(), ["register", "routed"], "{profile:?}");
        let (owner, link) = running(OWN_SLOT, profile, true);
        assert_eq!(owner.last(link).open().path.bytes(), [1, 0, 0x20, 2, 0x24, 1], "{profile:?}");
    }
}

#[test]
fn a_device_is_asked_who_it_is_only_where_it_matters() {
    for (path, connected, asked) in [
        ("4,10.0.0.1", false, false),
        ("4,10.0.0.1,1,1", false, false),
        ("4,10.0.0.1", true, true),
        (OWN_SLOT, false, true),
        (OWN_SLOT, true, true),
    ] {
        let (owner, _) = running(path, Profile::Auto, connected);
        assert_eq!(owner.trace().contains(&"identity"), asked, "{path} {connected}");
        for profile in [Profile::Generic, Profile::Micro800, Profile::Logix, Profile::Omron] {
            let (owner, _) = running(path, profile, connected);
            assert!(!owner.trace().contains(&"identity"), "{path} {connected} {profile:?}");
        }
    }
}

#[test]
fn what_it_says_decides() {
    for (vendor, device_type, name, words, size) in [
        (1, 0x0E, &b"2080-LC50-24QWB"[..], "open", 504),
        (1, 0x0E, b"1756-L85E", "large open", 4_002),
        (47, 0x0E, b"NX102-9000", "large open", 1_994),
        (5, 0x02, b"drive", "open", 504),
    ] {
        let (mut owner, link) = running(OWN_SLOT, Profile::Auto, true);
        owner.answer_identity(link, &identity(vendor, device_type, name));
        assert_eq!(owner.trace(), ["register", "identity", words]);
        assert_eq!(owner.last(link).open().o_t.size, size);
        owner.accept_open(link);
        owner.succeed(link, &[1]);
        assert_eq!(owner.target().profile, Some(Profile::of_identity(vendor, device_type, name)));
        let frames = owner.written.len();
        owner.run(A).unwrap();
        assert_eq!(owner.trace_since(frames), ["connected"], "asked once per TCP connection");
    }
}

#[test]
fn a_micro800_that_was_asked_gets_the_message_without_route() {
    let (mut owner, link) = running(OWN_SLOT, Profile::Auto, false);
    owner.answer_identity(link, &identity(1, 0x0E, b"2080-LC30"));
    assert_eq!(owner.trace(), ["register", "identity", "unconnected"]);
    owner.reply(link, &[1]);
    assert!(owner.view(A).q);
}

#[test]
fn another_device_behind_the_same_address_is_asked_again() {
    let (mut owner, link) = running(OWN_SLOT, Profile::Auto, false);
    owner.answer_identity(link, &identity(1, 0x0E, b"2080-LC30"));
    owner.reply(link, &[1]);
    owner.closed(link);
    let frames = owner.written.len();
    owner.run(A).unwrap();
    let link = owner.register();
    owner.answer_identity(link, &identity(1, 0x0E, b"1756-L85E"));
    assert_eq!(owner.trace_since(frames), ["register", "identity", "routed"]);
}

#[test]
fn a_target_that_does_not_say_is_nothing_special_and_never_asked_again() {
    type Silence = fn(&mut Owner, cipdeck_shared::engine::LinkId);
    let ways: [(&str, Silence, bool); 4] = [
        ("no answer", |owner, _| owner.pass(500_000), false),
        ("a refusal", |owner, link| owner.answer_status(link, 1), false),
        (
            "an empty answer",
            |owner, link| {
                let header =
                    owner.last_header(link, Command::ListIdentity).reply(EncapsulationStatus::Success);
                owner.input(link, &encapsulation(header, &[0, 0]));
            },
            false,
        ),
        ("it hangs up", |owner, link| owner.closed(link), true),
    ];
    for (name, silence, gone) in ways {
        let (mut owner, mut link) = running(OWN_SLOT, Profile::Auto, false);
        silence(&mut owner, link);
        if gone {
            link = owner.register();
        }
        assert_eq!(owner.trace().last(), Some(&"routed"), "{name}");
        owner.refuse_as(link, cipdeck_shared::wire::ServiceCode::GetAttributeSingle, (5, &[]), &[]);
        owner.closed(link);
        let frames = owner.written.len();
        owner.put(B, OWN_SLOT, |_| {});
        owner.run(B).unwrap();
        owner.register();
        assert_eq!(owner.trace_since(frames), ["register", "routed"], "{name}");
    }
}

#[test]
fn a_target_that_closes_before_it_was_asked_is_asked_the_next_time() {
    let mut owner = Owner::new();
    owner.put(A, OWN_SLOT, |_| {});
    owner.run(A).unwrap();
    let link = owner.link();
    owner.connected(link);
    owner.writes = false;
    owner.answer_register(link);
    owner.writes = true;
    owner.closed(link);
    owner.register();
    assert_eq!(owner.trace(), ["register", "register", "identity"]);
}

#[test]
fn a_late_identity_changes_nothing_about_a_message_that_is_out() {
    let (mut owner, link) = running(OWN_SLOT, Profile::Auto, true);
    let header = owner.last_header(link, Command::ListIdentity);
    let mut data = Vec::new();
    identity(1, 0x0E, b"2080-LC30").encode_reply(&mut data);
    let late = encapsulation(header, &data);
    owner.pass(500_000);
    owner.input(link, &late);
    owner.accept_open(link);
    owner.input(link, &late);
    owner.succeed(link, &[1]);
    assert_eq!(owner.trace(), ["register", "identity", "open", "connected"]);
    assert!(owner.view(A).q);
}
