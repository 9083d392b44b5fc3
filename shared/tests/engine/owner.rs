//! The engine with everything that its owner does: events are carried out at once, time is virtual.

use std::collections::BTreeMap;

use cipdeck_shared::config::{BlockId, MsgCipGeneric, Target};
use cipdeck_shared::engine::{
    BlockView, CauseKind, CommandError, ConnectError, Engine, Event, Exchange, Instant, LinkId, TargetView,
    Wants,
};
use cipdeck_shared::plan::MessagePlan;
use cipdeck_shared::wire::{
    Command, Encapsulation, Header, MessageRouterReply, MessageRouterRequest, RegisterSession, SendRrData,
    SessionHandle, UnconnectedMessage,
};

/// The engine with everything that its owner does, and a record of what happened.
pub(crate) struct Owner {
    pub(crate) engine: Engine,
    pub(crate) now: Instant,
    pub(crate) allowed: bool,
    /// Whether `Wants` is answered at once; one for a connection always is.
    pub(crate) answers: bool,
    /// Whether bytes are written at once.
    pub(crate) writes: bool,
    /// Of the next configuration that is put.
    pub(crate) revision: u64,
    pub(crate) open: Vec<(LinkId, Target)>,
    pub(crate) dropped: Vec<LinkId>,
    pub(crate) written: Vec<(LinkId, Vec<u8>)>,
    pub(crate) wants: Vec<Wants>,
    pub(crate) wants_to_open: Vec<Wants>,
    pub(crate) finished: Vec<(BlockId, BlockView, Exchange)>,
    pub(crate) bits: BTreeMap<BlockId, Vec<u16>>,
    /// How each block looked when it was told last.
    pub(crate) told: BTreeMap<BlockId, BlockView>,
    /// How each target looked when it was told last.
    pub(crate) targets: BTreeMap<Target, Option<TargetView>>,
}

impl Owner {
    pub(crate) fn new() -> Self {
        Self {
            engine: Engine::new(),
            now: Instant(0),
            allowed: true,
            answers: true,
            writes: true,
            revision: 1,
            open: Vec::new(),
            dropped: Vec::new(),
            written: Vec::new(),
            wants: Vec::new(),
            wants_to_open: Vec::new(),
            finished: Vec::new(),
            bits: BTreeMap::new(),
            told: BTreeMap::new(),
            targets: BTreeMap::new(),
        }
    }

    pub(crate) fn with_blocks(blocks: &[(BlockId, &str)]) -> Self {
        let mut owner = Self::new();
        for (block, path) in blocks {
            owner.put(*block, path, |_| {});
        }
        owner
    }

    pub(crate) fn put(&mut self, block: BlockId, path: &str, change: impl FnOnce(&mut MsgCipGeneric)) {
        let mut config = MsgCipGeneric::product_name(path);
        change(&mut config);
        let (plan, findings) = MessagePlan::parse(&config);
        self.engine.put(block, self.revision, plan.ok_or(findings), self.now);
        self.pump();
    }

    pub(crate) fn pump(&mut self) {
        while let Some(event) = self.engine.poll_event() {
            match event {
                Event::Connect { link, target } => self.open.push((link, target)),
                Event::Disconnect { link } => {
                    self.open.retain(|(open, _)| *open != link);
                    self.dropped.push(link);
                }
                Event::Transmit { link } if self.writes => self.take(link),
                Event::Transmit { .. } => {}
                Event::Wants(wants) => {
                    let asked = if wants.opens { &mut self.wants_to_open } else { &mut self.wants };
                    asked.push(wants);
                    if self.answers || wants.opens {
                        self.engine.permit(&wants, if self.allowed { Ok(()) } else { Err("no") }, self.now);
                    }
                }
                Event::Changed { block, edge } => {
                    self.bits.entry(block).or_default().extend(edge.map(|(_, bits)| bits.0));
                    self.told.extend(self.engine.glance(block).map(|view| (block, view)));
                }
                Event::Target { target, view } => {
                    self.targets.insert(target, view.map(|view| *view));
                }
                Event::Finished { block, view, exchange, .. } => {
                    self.finished.push((block, *view, *exchange));
                }
            }
        }
    }

    fn take(&mut self, link: LinkId) {
        let mut bytes = Vec::new();
        while self.engine.poll_transmit(link, &mut bytes, self.now) {}
        if !bytes.is_empty() {
            self.written.push((link, bytes));
        }
    }

    /// Writes now what was held back.
    pub(crate) fn write(&mut self, link: LinkId) {
        self.take(link);
        self.pump();
    }

    pub(crate) fn permit(&mut self, wants: &Wants) {
        self.engine.permit(wants, Ok(()), self.now);
        self.pump();
    }

    pub(crate) fn run(&mut self, block: BlockId) -> Result<u64, CommandError> {
        let shot = self.engine.run(block, self.now);
        self.pump();
        shot
    }

    pub(crate) fn set_in(&mut self, block: BlockId, input: bool) {
        self.engine.set_in(block, input, self.now).unwrap();
        self.pump();
    }

    pub(crate) fn cancel(&mut self, block: BlockId) {
        self.engine.cancel(block, self.now).unwrap();
        self.pump();
    }

    /// Lets time pass, stopping wherever the engine wants to be called.
    pub(crate) fn pass(&mut self, micros: u64) {
        let end = Instant(self.now.0 + micros);
        while let Some(at) = self.engine.poll_timeout().filter(|at| *at <= end) {
            self.now = at.max(self.now);
            self.engine.handle_timeout(self.now);
            self.pump();
        }
        self.now = end;
    }

    pub(crate) fn link(&self) -> LinkId {
        self.open.last().expect("a link is open").0
    }

    pub(crate) fn connected(&mut self, link: LinkId) {
        self.engine.connected(link, self.now);
        self.pump();
    }

    pub(crate) fn connect_failed(&mut self, link: LinkId) {
        self.open.retain(|(open, _)| *open != link);
        self.engine.connect_failed(link, ConnectError::Refused, "connection refused", self.now);
        self.pump();
    }

    pub(crate) fn closed(&mut self, link: LinkId) {
        self.open.retain(|(open, _)| *open != link);
        self.engine.closed(link, self.now);
        self.pump();
    }

    pub(crate) fn input(&mut self, link: LinkId, bytes: &[u8]) {
        self.engine.handle_input(link, bytes, self.now);
        self.pump();
    }

    /// TCP and RegisterSession; returns the link.
    pub(crate) fn register(&mut self) -> LinkId {
        let link = self.link();
        self.connected(link);
        self.answer_register(link);
        link
    }

    pub(crate) fn answer_register(&mut self, link: LinkId) {
        let header = self.last_header(link, Command::RegisterSession);
        let reply = Header { session: SessionHandle(7), ..header };
        let frame = encapsulation(reply, &RegisterSession::CURRENT.bytes());
        self.input(link, &frame);
    }

    pub(crate) fn last_header(&self, link: LinkId, command: Command) -> Header {
        let (_, frame) =
            self.written.iter().rev().find(|(to, _)| *to == link).expect("something was written");
        let header = Encapsulation::decode(frame).unwrap().header;
        assert_eq!(header.command, command);
        header
    }

    /// Answers the last request on this link with success and this data.
    pub(crate) fn reply(&mut self, link: LinkId, data: &[u8]) {
        let frame = self.reply_frame(link, data);
        self.input(link, &frame);
    }

    pub(crate) fn reply_frame(&self, link: LinkId, data: &[u8]) -> Vec<u8> {
        let header = self.last_header(link, Command::SendRRData);
        let mut message = Vec::new();
        MessageRouterReply::success(self.last_request(link).service(), data).encode(&mut message);
        let mut frame = Vec::new();
        UnconnectedMessage::new(&message).unwrap().encode(&header, 0, &mut frame);
        frame
    }

    pub(crate) fn last_request(&self, link: LinkId) -> MessageRouterRequest {
        let (_, frame) =
            self.written.iter().rev().find(|(to, _)| *to == link).expect("something was written");
        let data = SendRrData::decode(Encapsulation::decode(frame).unwrap().data()).unwrap();
        MessageRouterRequest::decode(data.unconnected().unwrap().data).unwrap()
    }

    pub(crate) fn requests_written(&self) -> usize {
        let is_request =
            |frame: &[u8]| Encapsulation::decode(frame).unwrap().header.command == Command::SendRRData;
        self.written.iter().filter(|(_, frame)| is_request(frame)).count()
    }

    pub(crate) fn view(&self, block: BlockId) -> BlockView {
        self.engine.view(block).unwrap()
    }

    pub(crate) fn ids(&self, block: BlockId) -> (u16, u16, u16) {
        let status = self.view(block).status;
        (status.error_id, status.sub_error_id, status.status_bits.0)
    }

    pub(crate) fn cause(&self, block: BlockId) -> CauseKind {
        self.view(block).cause.expect("a cause").what
    }
}

pub(crate) fn encapsulation(header: Header, data: &[u8]) -> Vec<u8> {
    let mut frame = Vec::new();
    Encapsulation::new(header, data).unwrap().encode(&mut frame);
    frame
}
