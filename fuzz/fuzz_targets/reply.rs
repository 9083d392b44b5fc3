//! Whatever a target answers is a value or an error, and can be shown.
#![no_main]

use cipdeck_shared::dissect::{self, Node};
use cipdeck_shared::wire::{Encapsulation, MessageRouterReply, SendRrData};
use libfuzzer_sys::fuzz_target;

fuzz_target!(|bytes: &[u8]| {
    inside(&dissect::frame(bytes), 0, bytes.len());
    if let Ok(frame) = Encapsulation::decode(bytes)
        && let Ok(data) = SendRrData::decode(frame.data())
        && let Ok(item) = data.unconnected()
    {
        message(item.data);
    }
    message(bytes);
    if let Some((length, rest)) = bytes.split_first() {
        let (request, reply) = rest.split_at(usize::from(*length).min(rest.len()));
        inside(&dissect::reply(reply, Some(request)), 0, reply.len());
        dissect::decode(request, reply);
    }
});

fn message(bytes: &[u8]) {
    inside(&dissect::request(bytes), 0, bytes.len());
    inside(&dissect::reply(bytes, None), 0, bytes.len());
    match MessageRouterReply::decode(bytes) {
        Ok(reply) => {
            let mut again = Vec::new();
            reply.encode(&mut again);
            assert_eq!(MessageRouterReply::decode(&again).as_ref(), Ok(&reply), "it reads what it writes");
        }
        Err(error) => assert!(error.at <= bytes.len(), "{error} lies in the bytes"),
    }
}

/// Parts lie inside of what they are parts of, in order.
fn inside(node: &Node, from: usize, to: usize) {
    assert!(from <= node.from && node.from <= node.to && node.to <= to, "{node:?} in {from}..{to}");
    let mut at = node.from;
    for child in &node.children {
        inside(child, at, node.to);
        at = child.to;
    }
}
