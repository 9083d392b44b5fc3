//! Everything together: the engine, its owner, the network, the devices, and the people who press buttons.

use std::collections::BTreeMap;

use cipdeck_shared::config::{BlockId, Host, Target};
use cipdeck_shared::engine::{BlockView, ConnectError, Engine, Event, Instant, LinkId, Millis};
use cipdeck_shared::sim::{Device, SimConfig};
use cipdeck_shared::wire::{Command, Encapsulation, SendRrData, ServiceCode, UnconnectedSend};

use crate::network::{Cable, Cut, Fate, is_whole, split, spoil};
use crate::shots::BlockSpec;

/// How long bytes are on their way.
const LATENCY: Millis = Millis(1);

/// What somebody does.
#[derive(Clone, Copy, Debug)]
pub(crate) enum Press {
    Run(usize),
    Cancel(usize),
    In(usize, bool),
}

#[derive(Debug)]
enum Action {
    Connected(LinkId),
    NotConnected(LinkId),
    ToDevice(LinkId, Vec<u8>),
    ToEngine(LinkId, Vec<u8>),
    /// Bytes that have arrived already.
    AgainToEngine(LinkId, Vec<u8>),
    /// The device hears that the other side has closed.
    DeviceHangsUp(LinkId),
    EngineHearsEnd(LinkId),
    Press(Press),
}

/// A message that has ended.
#[derive(Debug)]
pub(crate) struct Finished {
    pub(crate) block: usize,
    /// The number of a one-shot message.
    pub(crate) number: u32,
    pub(crate) at: Instant,
    pub(crate) view: BlockView,
}

#[derive(Debug, Default)]
pub(crate) struct World {
    pub(crate) engine: Engine,
    pub(crate) now: Instant,
    pub(crate) devices: Vec<Device>,
    pub(crate) specs: Vec<BlockSpec>,
    /// What happens to the frames of the devices, in turn; afterwards all is well.
    pub(crate) fates: Vec<Fate>,
    /// Devices whose frames cannot be told apart by anybody: nothing is sent twice for them.
    pub(crate) indistinct: Vec<usize>,
    /// What happens to the first TCP connection.
    pub(crate) cut: Option<Cut>,
    /// How often a device has got each one-shot request.
    pub(crate) executed: BTreeMap<Vec<u8>, usize>,
    pub(crate) finished: Vec<Finished>,
    numbers: BTreeMap<BlockId, u32>,
    /// The newest number.
    number: u32,
    cables: BTreeMap<LinkId, Cable>,
    actions: BTreeMap<(Instant, u64), Action>,
    next_action: u64,
    history: BTreeMap<usize, Vec<Vec<u8>>>,
    /// Bytes of the first TCP connection.
    pub(crate) first_sent: (usize, usize),
}

impl World {
    pub(crate) fn new(devices: Vec<SimConfig>, specs: Vec<BlockSpec>) -> Self {
        let devices = devices.into_iter().map(Device::new).collect();
        Self { devices, specs, ..Self::default() }
    }

    /// Somebody presses something later.
    pub(crate) fn press_at(&mut self, millis: u64, press: Press) {
        self.act(Instant(millis * 1_000), Action::Press(press));
    }

    /// A one-shot message that ends within the time of its timeouts.
    pub(crate) fn run(&mut self, block: usize) -> &Finished {
        let before = self.finished.len();
        self.press(Press::Run(block));
        while self.finished.len() == before {
            assert!(self.step(Instant(u64::MAX)), "the message of block {block} ends");
        }
        &self.finished[before]
    }

    /// Lets time pass.
    pub(crate) fn pass(&mut self, millis: u64) {
        let end = self.now + Millis(millis);
        while self.step(end) {}
        self.now = end;
    }

    fn act(&mut self, at: Instant, action: Action) {
        self.next_action += 1;
        self.actions.insert((at, self.next_action), action);
    }

    /// Carries out what comes next, if it comes before the end.
    fn step(&mut self, end: Instant) -> bool {
        let ends = self.cables.values().filter_map(|cable| cable.end.as_ref()?.poll_timeout());
        let devices = self.devices.iter().filter_map(Device::poll_timeout);
        let action = self.actions.keys().next().map(|(at, _)| *at);
        let next = ends.chain(devices).chain(action).chain(self.engine.poll_timeout()).min();
        let Some(next) = next.filter(|next| *next <= end) else { return false };
        self.now = self.now.max(next);
        while let Some(entry) = self.actions.first_entry().filter(|entry| entry.key().0 <= self.now) {
            let action = entry.remove();
            self.carry_out(action);
            self.pump();
        }
        for device in &mut self.devices {
            device.handle_timeout(self.now);
        }
        for link in self.cables.keys().copied().collect::<Vec<_>>() {
            self.flush(link);
        }
        self.engine.handle_timeout(self.now);
        self.pump();
        true
    }

    fn carry_out(&mut self, action: Action) {
        match action {
            Action::Press(press) => self.press(press),
            Action::Connected(link) => self.engine.connected(link, self.now),
            Action::NotConnected(link) => {
                self.engine.connect_failed(link, ConnectError::Refused, "", self.now);
            }
            Action::ToEngine(link, bytes) => self.engine.handle_input(link, &bytes, self.now),
            Action::AgainToEngine(link, bytes) => {
                // Between two halves of a frame it would be a change of that frame.
                if self.cables.get(&link).is_some_and(|cable| !cable.halved) {
                    self.engine.handle_input(link, &bytes, self.now);
                }
            }
            Action::EngineHearsEnd(link) => self.engine.closed(link, self.now),
            Action::DeviceHangsUp(link) => {
                self.cables.remove(&link);
            }
            Action::ToDevice(link, bytes) => {
                let Some(cable) = self.cables.get_mut(&link) else { return };
                let Some(end) = &mut cable.end else { return };
                end.handle_input(&mut self.devices[cable.device], &bytes, self.now);
                cable.arrived.push(&bytes);
                while let Ok(Some(frame)) = cable.arrived.next_frame() {
                    if let Some(message) = one_shot(&frame) {
                        *self.executed.entry(message).or_default() += 1;
                    }
                }
                self.flush(link);
            }
        }
    }

    fn press(&mut self, press: Press) {
        let id = |block: usize| BlockId(u32::try_from(block).unwrap() + 1);
        let known = |world: &Self, block: usize| world.engine.view(id(block)).is_some();
        match press {
            Press::Run(block) | Press::In(block, true) => {
                if self.engine.is_busy(id(block)) {
                    return;
                }
                self.number += 1;
                self.numbers.insert(id(block), self.number);
                let plan = self.specs[block].plan(self.number);
                self.engine.put(id(block), self.number.into(), Ok(plan), self.now);
                if let Press::Run(_) = press {
                    let _ = self.engine.run(id(block), self.now);
                } else {
                    self.engine.set_in(id(block), true, self.now).unwrap();
                }
            }
            Press::Cancel(block) if known(self, block) => self.engine.cancel(id(block), self.now).unwrap(),
            Press::In(block, false) if known(self, block) => {
                self.engine.set_in(id(block), false, self.now).unwrap();
            }
            Press::Cancel(_) | Press::In(..) => {}
        }
        self.pump();
    }

    /// All TCP connections break at once.
    pub(crate) fn hang_up(&mut self) {
        for link in std::mem::take(&mut self.cables).into_keys() {
            self.act(self.now, Action::EngineHearsEnd(link));
        }
    }

    /// Ends everything, and waits until every watchdog has run.
    pub(crate) fn stop(&mut self) {
        self.actions.retain(|_, action| !matches!(action, Action::Press(_)));
        self.engine.stop(self.now);
        self.pump();
        self.pass(60_000);
    }

    fn pump(&mut self) {
        while let Some(event) = self.engine.poll_event() {
            match event {
                Event::Connect { link, target } => self.connect(link, &target),
                Event::Disconnect { link } => {
                    // What is on its way still arrives.
                    let at = self.cables.get(&link).map_or(self.now, |cable| cable.to_device.max(self.now));
                    self.act(at + LATENCY, Action::DeviceHangsUp(link));
                }
                Event::Transmit { link } => self.transmit(link),
                Event::Wants(wants) => self.engine.permit(&wants, Ok(()), self.now),
                Event::Changed { .. } | Event::Target { .. } => {}
                Event::Finished { block, view, .. } => {
                    let number = self.numbers[&block];
                    let block = usize::try_from(block.0).unwrap() - 1;
                    self.finished.push(Finished { block, number, at: self.now, view: *view });
                }
            }
        }
    }

    fn connect(&mut self, link: LinkId, target: &Target) {
        let Target::Network(endpoint) = target else { panic!("{target:?}") };
        let Host::Ip([.., last]) = endpoint.host else { panic!("{target:?}") };
        let device = usize::from(last) - 1;
        let there = device < self.devices.len();
        if there {
            self.cables.insert(link, Cable::new(device));
        }
        let action = if there { Action::Connected(link) } else { Action::NotConnected(link) };
        self.act(self.now + LATENCY, action);
    }

    fn transmit(&mut self, link: LinkId) {
        let mut bytes = Vec::new();
        while self.engine.poll_transmit(link, &mut bytes, self.now) {}
        let Some(cable) = self.cables.get_mut(&link) else { return };
        let at = cable.to_device.max(self.now + LATENCY);
        cable.to_device = at;
        let room = match self.cut.filter(|_| link == LinkId(1)) {
            Some(Cut::ToDevice(after)) => after.saturating_sub(cable.sent_to_device),
            _ => usize::MAX,
        };
        cable.sent_to_device += bytes.len();
        if link == LinkId(1) {
            self.first_sent.0 = cable.sent_to_device;
        }
        let whole = bytes.len() <= room;
        bytes.truncate(room);
        self.act(at, Action::ToDevice(link, bytes));
        if !whole {
            self.act(at, Action::DeviceHangsUp(link));
            self.act(at + LATENCY, Action::EngineHearsEnd(link));
        }
    }

    /// Sends what the device has to say now.
    fn flush(&mut self, link: LinkId) {
        let Some(cable) = self.cables.get_mut(&link) else { return };
        let Some(end) = &mut cable.end else { return };
        let mut bytes = Vec::new();
        end.poll_transmit(&mut bytes, self.now);
        let closed = end.is_closed();
        if closed {
            cable.end = None;
        }
        let device = cable.device;
        for frame in split(&bytes) {
            self.deliver(link, device, frame);
        }
        if closed {
            let at = self.cables.get(&link).map_or(self.now, |cable| cable.to_engine.max(self.now));
            self.act(at + LATENCY, Action::EngineHearsEnd(link));
        }
    }

    fn deliver(&mut self, link: LinkId, device: usize, mut frame: Vec<u8>) {
        let fate = if self.fates.is_empty() { Fate::Pass(0, usize::MAX) } else { self.fates.remove(0) };
        if !is_whole(&frame) {
            self.cables.entry(link).and_modify(|cable| cable.halved = true);
            return self.send(link, &frame, 0);
        }
        let history = self.history.entry(device).or_default();
        let older = history.clone();
        history.push(frame.clone());
        if history.len() > 32 {
            history.remove(0);
        }
        let indistinct = self.indistinct.contains(&device);
        match fate {
            Fate::Pass(delay, piece) => {
                for piece in frame.chunks(piece.max(1)) {
                    self.send(link, piece, delay);
                }
            }
            Fate::Lose => {}
            Fate::Twice(delay) if !indistinct => {
                self.send(link, &frame, 0);
                // Later frames are not held up by it.
                let at = self.now + Millis(delay) + LATENCY;
                self.act(at, Action::AgainToEngine(link, frame));
            }
            Fate::Replay(which) if !indistinct && !older.is_empty() => {
                self.send(link, &older[which % older.len()], 0);
                self.send(link, &frame, 0);
            }
            Fate::Spoil(at, with) => {
                spoil(&mut frame, at, with);
                self.send(link, &frame, 0);
            }
            Fate::Cut(after) => {
                frame.truncate(after);
                self.send(link, &frame, 0);
                self.cables.remove(&link);
                self.act(self.now + LATENCY + LATENCY, Action::EngineHearsEnd(link));
            }
            Fate::Twice(_) | Fate::Replay(_) => self.send(link, &frame, 0),
        }
    }

    fn send(&mut self, link: LinkId, bytes: &[u8], delay: u64) {
        let Some(cable) = self.cables.get_mut(&link) else { return };
        let at = cable.to_engine.max(self.now + Millis(delay) + LATENCY);
        cable.to_engine = at;
        let room = match self.cut.filter(|_| link == LinkId(1)) {
            Some(Cut::ToEngine(after)) => after.saturating_sub(cable.sent_to_engine),
            _ => usize::MAX,
        };
        cable.sent_to_engine += bytes.len();
        if link == LinkId(1) {
            self.first_sent.1 = cable.sent_to_engine;
        }
        self.act(at, Action::ToEngine(link, bytes.iter().copied().take(room).collect()));
        if bytes.len() > room {
            self.cables.remove(&link);
            self.act(at + LATENCY, Action::EngineHearsEnd(link));
        }
    }
}

/// The bytes of a one-shot request in a frame: one that reads a list of attributes.
fn one_shot(frame: &Encapsulation<'_>) -> Option<Vec<u8>> {
    let data = SendRrData::decode(frame.data()).ok()?;
    let mut message = match frame.header.command {
        Command::SendRRData => data.unconnected().ok()?.data.to_vec(),
        Command::SendUnitData => data.connected().ok()?.message.to_vec(),
        _ => return None,
    };
    if message.first() == Some(&ServiceCode::UnconnectedSend.0) {
        message = UnconnectedSend::decode(message.get(6..)?).ok()?.message.to_vec();
    }
    (message.first() == Some(&ServiceCode::GetAttributeList.0)).then_some(message)
}
