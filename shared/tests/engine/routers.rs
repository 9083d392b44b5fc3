//! Routed messages: what routers on the way refuse, and what the device itself refuses.

use cipdeck_shared::config::BlockId;
use cipdeck_shared::engine::{CauseKind, LinkId, RefusedBy};
use cipdeck_shared::wire::{ServiceCode, UnconnectedSend};

#[cfg(target_arch = "wasm32")]
use wasm_bindgen_test::wasm_bindgen_test as test;

use crate::owner::Owner;

const A: BlockId = BlockId(1);

fn sent(path: &str) -> (Owner, LinkId) {
    let mut owner = Owner::new();
    owner.put(A, path, |config| config.profile = cipdeck_shared::config::Profile::Generic);
    owner.run(A).unwrap();
    let link = owner.register();
    (owner, link)
}

#[test]
fn a_route_makes_an_unconnected_send_and_no_route_makes_none() {
    let (owner, link) = sent("4,10.0.0.1");
    assert_eq!(owner.trace(), ["register", "unconnected"]);
    assert_eq!(owner.last(link).request.unwrap().bytes(), [0x0E, 3, 0x20, 1, 0x24, 1, 0x30, 7]);
    for (path, route) in [
        ("4,10.0.0.1,1,0", &[1, 0][..]),
        ("4,10.0.0.1,2,192.168.1.20", b"\x12\x0C192.168.1.20"),
        ("4,10.0.0.1,2,192.168.1.5", b"\x12\x0B192.168.1.5\0"),
        ("4,10.0.0.1,1,3,2,192.168.1.20", b"\x01\x03\x12\x0C192.168.1.20"),
    ] {
        let (owner, link) = sent(path);
        assert_eq!(owner.trace(), ["register", "routed"], "{path}");
        let request = owner.last(link).request.unwrap();
        let send = UnconnectedSend::decode(request.data()).unwrap();
        assert_eq!(send.route.bytes(), route, "{path}");
        assert_eq!(send.message, [0x0E, 3, 0x20, 1, 0x24, 1, 0x30, 7]);
        assert!(send.timeout.millis() >= 3_000, "the route has the time of the message");
    }
}

#[test]
fn the_reply_is_that_of_the_inner_service() {
    let (mut owner, link) = sent("4,10.0.0.1,1,0");
    let reply =
        cipdeck_shared::wire::MessageRouterReply::success(ServiceCode::GetAttributeSingle, b"\x04CHP1");
    let frame = owner.answer_frame(link, &reply);
    owner.input(link, &frame);
    assert_eq!(owner.view(A).res_data, b"\x04CHP1");
}

#[test]
fn a_routers_refusal_is_told_apart_with_the_path_that_was_left() {
    for (word, data, remaining, may_have_acted) in [
        (0x0311, &[1, 0][..], Some(1), false),
        (0x0312, &[1][..], Some(1), false),
        (0x0315, &[][..], None, false),
        (0x0204, &[0, 0][..], Some(0), true),
    ] {
        let (mut owner, link) = sent("4,10.0.0.1,1,9");
        owner.refuse(link, 1, &[word], data);
        assert_eq!((owner.ids(A), owner.view(A).status.ext_error_id), ((224, 1, 12), word));
        let cause = owner.view(A).cause.unwrap();
        assert_eq!(
            (cause.what, cause.by),
            (CauseKind::RefusedByDevice, Some(RefusedBy::Router)),
            "{word:#x}"
        );
        assert_eq!((cause.remaining_path, cause.may_have_acted), (remaining, may_have_acted), "{word:#x}");
        assert_eq!(owner.dropped, [], "an answer is an answer");
    }
}

#[test]
fn the_inner_services_own_refusal_is_the_devices() {
    let (mut owner, link) = sent("4,10.0.0.1,1,0");
    owner.refuse_as(link, ServiceCode::GetAttributeSingle, (5, &[0x0312]), &[]);
    assert_eq!(owner.ids(A), (224, 5, 12));
    let cause = owner.view(A).cause.unwrap();
    assert_eq!((cause.by, cause.remaining_path, cause.may_have_acted), (None, None, false));
}

#[test]
fn a_reply_of_unconnected_send_to_what_was_not_routed_is_nonsense() {
    let (mut owner, link) = sent("4,10.0.0.1");
    owner.refuse_as(link, ServiceCode::UnconnectedSend, (1, &[0x0312]), &[1, 0]);
    assert_eq!((owner.ids(A), owner.cause(A)), ((69, 65, 12), CauseKind::Malformed));
    assert_eq!(owner.dropped, [link]);
}

#[test]
fn success_of_unconnected_send_itself_is_nonsense() {
    let (mut owner, link) = sent("4,10.0.0.1,1,0");
    owner.succeed(link, b"what?");
    assert_eq!((owner.ids(A), owner.cause(A)), ((69, 65, 12), CauseKind::Malformed));
}

#[test]
fn over_a_connection_a_routers_reply_is_nonsense_too() {
    let mut owner = Owner::new();
    owner.put_connected(A, "4,10.0.0.1,1,0", |_| {});
    owner.run(A).unwrap();
    let link = owner.register_and_open();
    assert_eq!(owner.last(link).request.unwrap().service(), ServiceCode::GetAttributeSingle);
    owner.refuse_as(link, ServiceCode::UnconnectedSend, (1, &[0x0312]), &[1, 0]);
    assert_eq!((owner.ids(A), owner.cause(A)), ((69, 65, 12), CauseKind::Malformed));
}
