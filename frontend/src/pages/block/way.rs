//! The way of a message in words: through which hops, and at which of them it was stuck.

use cipdeck_shared::{
    config::{Endpoint, Target, TargetPath},
    engine::{Cause, RefusedBy},
    wire::{Epath, Segment},
};
use yew::AttrValue;

use super::subject::Subject;
use crate::i18n::tr;

/// `→ TCP 44818 at 192.168.1.100, then backplane slot 0, by Unconnected_Send`
pub(super) fn way(subject: &Subject) -> Option<AttrValue> {
    let path: TargetPath = subject.draft.config.target_cfg.path.parse().ok()?;
    let plan = subject.plan.as_ref();
    let route = plan.map_or(&path.route, |plan| plan.routed(subject.profile).route());
    let connected = plan.is_some_and(|plan| plan.connection().is_some());
    let first = match &path.target {
        Target::BuiltIn => tr!("target.built_in"),
        Target::Network(Endpoint { host, port }) => tr!("target.tcp", host = host, port = port),
    };
    let by = match (connected, route.is_empty()) {
        (true, _) => tr!("target.connected"),
        (false, true) => tr!("target.direct"),
        (false, false) => tr!("target.routed"),
    };
    let mut words = first.to_string();
    for hop in route.segments() {
        words = tr!("target.then", way = words, hop = hop_words(hop)).to_string();
    }
    Some(format!("{words}, {by}").into())
}

/// `backplane slot 0`, `port 2 to 192.168.1.20`
fn hop_words(hop: &Segment) -> AttrValue {
    let Segment::Port(port) = hop else { return AttrValue::default() };
    match (port.port(), port.slot(), port.address()) {
        (1, Some(slot), _) => tr!("target.slot", slot = slot),
        (number, Some(link), _) => tr!("target.port", port = number, to = link),
        (number, None, address) => tr!("target.port", port = number, to = address.unwrap_or("?")),
    }
}

/// Which hop a router could not take, as far as it has said so.
pub(super) fn stuck_at(path: &str, cause: &Cause) -> Option<AttrValue> {
    let left = usize::from(cause.remaining_path?);
    // The path of a Forward_Open goes on to the Message Router: class 2, instance 1.
    let behind = if cause.by == Some(RefusedBy::ForwardOpen) { 2 } else { 0 };
    let path: TargetPath = path.parse().ok()?;
    let (number, hop) = hop_with_left(&path.route, left.checked_sub(behind)?)?;
    // The TCP endpoint is the first hop.
    Some(tr!("error.stuck", number = number + 2, hop = hop_words(hop)))
}

/// The hop from which so many words of the route are left.
fn hop_with_left(route: &Epath, left: usize) -> Option<(usize, &Segment)> {
    let words = |hop: &Segment| match hop {
        Segment::Port(port) => Epath::default().hop(port.clone()).bytes().len() / 2,
        Segment::Logical(_) | Segment::Symbol(_) | Segment::SimpleData(_) => 0,
    };
    let hops = route.segments();
    let from = |index: usize| hops.iter().skip(index).map(words).sum::<usize>();
    hops.iter().enumerate().find(|(index, _)| from(*index) == left)
}

#[cfg(test)]
mod tests {
    use super::*;
    use cipdeck_shared::engine::CauseKind;

    fn stuck(path: &str, left: u8, by: RefusedBy) -> Option<AttrValue> {
        let cause =
            Cause { remaining_path: Some(left), by: Some(by), ..Cause::new(CauseKind::RefusedByDevice) };
        stuck_at(path, &cause)
    }

    #[test]
    fn the_words_that_are_left_name_the_hop() {
        let path = "4,10.0.0.1,1,3,2,192.168.1.20";
        let says = |left, by| stuck(path, left, by).unwrap_or_default().to_string();
        // `01 03`, then `12 0C` and twelve characters
        assert!(
            says(8, RefusedBy::Router).contains("hop 2") && says(8, RefusedBy::Router).contains("slot 3")
        );
        assert!(says(7, RefusedBy::Router).contains("hop 3"), "{}", says(7, RefusedBy::Router));
        assert!(says(7, RefusedBy::Router).contains("192.168.1.20"));
        assert!(says(10, RefusedBy::ForwardOpen).contains("slot 3"), "the Message Router is behind it");
        assert_eq!(stuck(path, 5, RefusedBy::Router), None, "in the middle of an address");
        assert_eq!(stuck(path, 0, RefusedBy::ForwardOpen), None);
    }
}
