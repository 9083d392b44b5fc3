//! The engine under anything: commands, bytes and failures in any order never panic, never write a request
//! twice, never give a wrong value, and never leave a block or a buffer behind.

use cipdeck_shared::config::{BlockId, Channel};
use cipdeck_shared::engine::LinkId;
use cipdeck_shared::wire::{
    Command, Encapsulation, Header, MessageRouterReply, ServiceCode, SessionHandle, UnconnectedMessage,
};
use proptest::prelude::*;

use crate::owner::{Owner, encapsulation};

const BLOCKS: u32 = 6;

#[derive(Clone, Debug)]
enum Step {
    Run(u32),
    SetIn(u32, bool),
    Cancel(u32),
    Remove(u32),
    Put(u32, u32, i64),
    Pass(u64),
    Allow(bool),
    Link(usize, OnLink),
}

#[derive(Clone, Debug)]
enum OnLink {
    Connected,
    ConnectFailed,
    Closed,
    Answer,
    AnswerOld(usize),
    Spoiled(usize, u8),
    Bytes(Vec<u8>),
}

fn step() -> impl Strategy<Value = Step> {
    let block = || 1..=BLOCKS;
    prop_oneof![
        3 => block().prop_map(Step::Run),
        2 => (block(), any::<bool>()).prop_map(|(b, on)| Step::SetIn(b, on)),
        1 => block().prop_map(Step::Cancel),
        1 => block().prop_map(Step::Remove),
        2 => (block(), 0..3_u32, 0..200_i64).prop_map(|(b, target, trigger)| Step::Put(b, target, trigger)),
        3 => (0..4_000_000_u64).prop_map(Step::Pass),
        1 => any::<bool>().prop_map(Step::Allow),
        14 => (0..8_usize, on_link()).prop_map(|(n, step)| Step::Link(n, step)),
    ]
}

fn on_link() -> impl Strategy<Value = OnLink> {
    prop_oneof![
        3 => Just(OnLink::Connected),
        1 => Just(OnLink::ConnectFailed),
        1 => Just(OnLink::Closed),
        8 => Just(OnLink::Answer),
        2 => any::<usize>().prop_map(OnLink::AnswerOld),
        1 => (0..40_usize, any::<u8>()).prop_map(|(at, with)| OnLink::Spoiled(at, with)),
        1 => prop::collection::vec(any::<u8>(), 0..60).prop_map(OnLink::Bytes),
    ]
}

fn carry_out(owner: &mut Owner, step: Step) {
    match step {
        Step::Run(block) => drop(owner.run(BlockId(block))),
        Step::SetIn(block, on) => drop(owner.engine.set_in(BlockId(block), on, owner.now)),
        Step::Cancel(block) => drop(owner.engine.cancel(BlockId(block), owner.now)),
        Step::Remove(block) => owner.engine.remove(BlockId(block), owner.now),
        Step::Put(block, target, trigger) => {
            let channel = if block % 3 == 0 { Channel::Monitor } else { Channel::Controller };
            owner.put(BlockId(block), &format!("4,10.0.0.{target}"), |config| {
                (config.ctrl_cfg.trigger_type, config.channel) = (trigger, channel);
            });
        }
        Step::Pass(micros) => owner.pass(micros),
        Step::Allow(allowed) => owner.allowed = allowed,
        Step::Link(n, step) => {
            let open = owner.open.get(n % owner.open.len().max(1)).map(|(link, _)| *link);
            if let Some(link) = open {
                happen(owner, link, step);
            }
        }
    }
    owner.pump();
}

fn happen(owner: &mut Owner, link: LinkId, step: OnLink) {
    let written = owner.written.len();
    match step {
        OnLink::Connected => owner.connected(link),
        OnLink::ConnectFailed => owner.connect_failed(link),
        OnLink::Closed => owner.closed(link),
        OnLink::Answer => answer(owner, link, written),
        OnLink::AnswerOld(old) => answer(owner, link, old % (written + 1)),
        OnLink::Spoiled(at, with) => {
            let frame = answer_to(owner, link, written).unwrap_or_default();
            // The envelope only: a changed value in a right envelope would be a right answer.
            let spoiled: Vec<u8> =
                frame.iter().enumerate().map(|(i, byte)| if i == at { byte ^ with } else { *byte }).collect();
            owner.input(link, &spoiled);
        }
        OnLink::Bytes(bytes) => owner.input(link, &bytes),
    }
}

/// Answers the last of the first `until` written frames that went to this link. The answer to a request is its
/// own sender context, so that every value tells whose it is.
fn answer(owner: &mut Owner, link: LinkId, until: usize) {
    if let Some(frame) = answer_to(owner, link, until) {
        owner.input(link, &frame);
    }
}

fn answer_to(owner: &Owner, link: LinkId, until: usize) -> Option<Vec<u8>> {
    let (_, frame) = owner.written.iter().take(until).rfind(|(to, _)| *to == link)?;
    let header = Encapsulation::decode(frame).unwrap().header;
    let mut out = Vec::new();
    match header.command {
        Command::RegisterSession => {
            let header = Header { session: SessionHandle(7), ..header };
            return Some(encapsulation(header, &[1, 0, 0, 0]));
        }
        Command::SendRRData => {
            let mut message = Vec::new();
            MessageRouterReply::success(ServiceCode::GetAttributeSingle, &header.context.0)
                .encode(&mut message);
            UnconnectedMessage::new(&message).unwrap().encode(&header, 0, &mut out);
        }
        _ => return None,
    }
    Some(out)
}

proptest! {
    #![proptest_config(ProptestConfig { cases: 512, ..ProptestConfig::default() })]

    #[test]
    fn anything_in_any_order(steps in prop::collection::vec(step(), 0..120)) {
        let mut owner = Owner::new();
        for block in 1..=BLOCKS {
            owner.put(BlockId(block), &format!("4,10.0.0.{}", block % 3), |_| {});
        }
        for step in steps {
            carry_out(&mut owner, step);
        }

        prop_assert!(owner.requests_written() <= owner.wants.len(), "every write was asked for");

        for (_, view, exchange) in owner.finished.iter().filter(|(_, view, _)| view.q) {
            let frame = exchange.request_frame.as_deref().expect("a success was written");
            let context = Encapsulation::decode(frame).unwrap().header.context;
            prop_assert_eq!(&view.res_data[..], &context.0[..], "the value is the answer to this very request");
        }

        owner.allowed = true;
        owner.engine.stop(owner.now);
        owner.pump();
        owner.pass(20_000_000);
        for block in (1..=BLOCKS).map(BlockId) {
            prop_assert!(!owner.engine.is_busy(block), "{block} ended");
        }
        owner.put(BlockId(1), "4,10.0.0.99", |_| {});
        owner.run(BlockId(1)).expect("a stopped engine can run again");
        let link = owner.register();
        owner.reply(link, &[1]);
        prop_assert!(owner.view(BlockId(1)).q, "buffers and sessions are free again");
    }
}
