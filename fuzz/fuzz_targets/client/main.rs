//! The whole engine as a client, with everything that people, time, the network and targets can do to it, in any
//! order. Nothing may panic, and the rules of the wire hold: see [`wire::Wire`].
#![no_main]

mod input;
mod wire;

use std::collections::{BTreeMap, VecDeque};

use cipdeck_shared::config::{BlockId, Channel, MsgCipGeneric};
use cipdeck_shared::engine::{ConnectError, Engine, Event, Instant, LinkId, Wants};
use cipdeck_shared::plan::MessagePlan;
use libfuzzer_sys::fuzz_target;

use self::input::Input;
use self::wire::Wire;

const PATHS: [&str; 4] = ["4,10.0.0.1", "4,10.0.0.2", "4,10.0.0.1,1,0", "4,10.0.0.2,1,3,4,10.0.0.9"];

/// Blocks there may be.
const BLOCKS: u8 = 6;

#[derive(Debug, Default)]
struct World {
    engine: Engine,
    now: Instant,
    wire: Wire,
    /// Sockets that the engine has asked for, and whether they are connected.
    links: BTreeMap<LinkId, bool>,
    wants: VecDeque<Wants>,
}

fuzz_target!(|bytes: &[u8]| {
    let (mut world, mut input) = (World::default(), Input(bytes));
    while let Some(step) = input.byte() {
        world.step(step, &mut input);
    }
    world.engine.stop(world.now);
    world.drain();
    world.pass(60_000_000);
    for link in world.links.clone().into_keys() {
        world.engine.closed(link, world.now);
        world.drain();
    }
    world.pass(60_000_000);
    assert!(world.engine.is_quiet(), "nothing is left after a stop");
});

impl World {
    fn step(&mut self, step: u8, input: &mut Input<'_>) {
        let block = BlockId(u32::from(input.number() % BLOCKS));
        let link = self.links.iter().nth(usize::from(input.number()) % self.links.len().max(1));
        let link = link.map(|(link, connected)| (*link, *connected));
        match (step % 16, link) {
            (0, _) => self.put(block, input),
            (1, _) => {
                let _ = self.engine.run(block, self.now);
            }
            (2, _) => {
                let _ = self.engine.set_in(block, input.number() % 2 == 0, self.now);
            }
            (3, _) => {
                let _ = self.engine.cancel(block, self.now);
            }
            (4, _) => self.engine.remove(block, self.now),
            (5, _) => self.pass(u64::from(input.number()) * 20_000),
            (6, _) => self.pass(u64::from(input.number())),
            (7 | 8, Some((link, false))) => {
                self.links.insert(link, true);
                self.engine.connected(link, self.now);
            }
            (9, Some((link, false))) => {
                self.links.remove(&link);
                self.engine.connect_failed(link, ConnectError::Refused, "", self.now);
            }
            (10, Some((link, true))) if input.number() % 4 == 0 => {
                self.links.remove(&link);
                self.engine.closed(link, self.now);
            }
            (11, Some((link, true))) => {
                let length = input.number();
                let bytes = input.take(length).to_vec();
                self.read(link, &bytes);
            }
            (12..=15, Some((link, true))) => {
                let bytes = self.wire.answer(link, input);
                self.read(link, &bytes);
            }
            _ => {}
        }
        self.drain();
        self.permit(input);
        self.write();
    }

    fn put(&mut self, block: BlockId, input: &mut Input<'_>) {
        let choice = input.number();
        let mut config = MsgCipGeneric::product_name(PATHS[usize::from(choice) % PATHS.len()]);
        config.channel = if choice & 0x10 == 0 { Channel::Controller } else { Channel::Monitor };
        config.ctrl_cfg.trigger_type = [0, 0, 1, 50][usize::from(choice >> 2) % 4];
        config.target_cfg.cip_conn_mode = i64::from(choice >> 5 & 1);
        config.target_cfg.conn_close = choice & 0x40 != 0;
        let (plan, findings) = MessagePlan::parse(&config);
        self.engine.put(block, u64::from(choice), plan.ok_or(findings), self.now);
    }

    fn pass(&mut self, micros: u64) {
        let end = Instant(self.now.0 + micros);
        // As a timer does: at each time that the engine names, but not for ever.
        for _ in 0..200 {
            match self.engine.poll_timeout().filter(|at| *at <= end) {
                Some(at) => self.now = self.now.max(at),
                None => break,
            }
            self.engine.handle_timeout(self.now);
            self.drain();
            self.write();
        }
        self.now = end;
        self.engine.handle_timeout(end);
        self.drain();
    }

    fn read(&mut self, link: LinkId, bytes: &[u8]) {
        self.wire.read(link, bytes);
        self.engine.handle_input(link, bytes, self.now);
    }

    fn permit(&mut self, input: &mut Input<'_>) {
        while let Some(wants) = self.wants.pop_front() {
            let allowed = input.number() % 8 != 7;
            if allowed {
                self.wire.permitted(&wants);
            }
            self.engine.permit(&wants, if allowed { Ok(()) } else { Err("no") }, self.now);
            self.drain();
        }
    }

    fn write(&mut self) {
        for (link, _) in self.links.clone().into_iter().filter(|(_, connected)| *connected) {
            let mut out = Vec::new();
            if self.engine.poll_transmit(link, &mut out, self.now) {
                self.wire.wrote(link, &out);
                self.drain();
            }
        }
    }

    fn drain(&mut self) {
        while let Some(event) = self.engine.poll_event() {
            match event {
                Event::Connect { link, .. } => {
                    assert_eq!(self.links.insert(link, false), None, "{link:?} is new")
                }
                Event::Disconnect { link } => {
                    self.links.remove(&link);
                    self.wire.gone(link);
                }
                Event::Wants(wants) => self.wants.push_back(wants),
                Event::Finished { block, shot, view, .. } => self.wire.finished(block, shot, view.q),
                _ => {}
            }
        }
    }
}
