//! Engine and simulated device, wired to each other without a socket. Time is passed in.

use cipdeck_shared::{
    config::{BlockId, Target},
    engine::{BlockView, CommandError, ConnectError, Engine, Event, Exchange, Instant, LinkId, Millis},
    plan::MessagePlan,
    sim::{Device, Registers, SimConfig, SimConnection},
};

use crate::store::Shelf;

/// What happened to a block.
#[derive(Debug)]
pub enum News {
    /// It looks different.
    Changed(BlockId, Box<BlockView>),
    /// A message has ended.
    Finished(BlockId, Box<Exchange>),
}

/// The browser's own engine, and the demo device behind `0,0`.
#[derive(Debug)]
pub struct Bench {
    engine: Engine,
    device: Device,
    connections: Shelf<LinkId, SimConnection>,
    /// Blocks whose message may be sent: it reads, or a person has confirmed it.
    permitted: Shelf<BlockId, ()>,
    clock: fn() -> Instant,
}

impl Bench {
    /// A device that has just been switched on. It takes a moment to answer, as a device does.
    pub fn new(clock: fn() -> Instant) -> Self {
        let config =
            SimConfig { delay: Millis(3), registers: Some(Registers::default()), ..SimConfig::default() };
        Self {
            engine: Engine::new(),
            device: Device::new(config),
            connections: Shelf::default(),
            permitted: Shelf::default(),
            clock,
        }
    }

    /// Gives a block its message. One that may write is sent only if a person has confirmed it.
    pub fn put(&mut self, block: BlockId, plan: MessagePlan, confirmed: bool) {
        if confirmed || !plan.access().may_write() {
            self.permitted.insert(block, ());
        } else {
            self.permitted.remove(&block);
        }
        self.engine.put(block, 0, Ok(plan), (self.clock)());
    }

    /// Runs a block once.
    pub fn run(&mut self, block: BlockId) -> Result<(), CommandError> {
        self.engine.run(block, (self.clock)()).map(|_| ())
    }

    /// Sets IN.
    pub fn set_in(&mut self, block: BlockId, input: bool) -> Result<(), CommandError> {
        self.engine.set_in(block, input, (self.clock)())
    }

    /// Cancels what is running.
    pub fn cancel(&mut self, block: BlockId) -> Result<(), CommandError> {
        self.engine.cancel(block, (self.clock)())
    }

    /// Cancels a block and forgets it.
    pub fn remove(&mut self, block: BlockId) {
        self.engine.remove(block, (self.clock)());
        self.permitted.remove(&block);
    }

    /// Moves bytes between engine and device until nothing moves.
    pub fn settle(&mut self) -> Vec<News> {
        self.engine.handle_timeout((self.clock)());
        let mut news = Vec::new();
        loop {
            while let Some(event) = self.engine.poll_event() {
                news.extend(self.handle(event));
            }
            if !self.deliver() {
                return news;
            }
        }
    }

    /// When [`Self::settle`] has something to do next.
    pub fn poll_timeout(&self) -> Option<Instant> {
        let replies = self.connections.values().filter_map(SimConnection::poll_timeout);
        replies.chain(self.engine.poll_timeout()).min()
    }

    fn handle(&mut self, event: Event) -> Option<News> {
        let now = (self.clock)();
        match event {
            Event::Connect { link, target: Target::BuiltIn } => {
                self.connections.insert(link, SimConnection::new());
                self.engine.connected(link, now);
            }
            Event::Connect { link, target: Target::Network(_) } => {
                self.engine.connect_failed(link, ConnectError::Unreachable, NO_NETWORK, now);
            }
            Event::Disconnect { link } => {
                self.connections.remove(&link);
            }
            Event::Transmit { link } => {
                let mut bytes = Vec::new();
                if self.engine.poll_transmit(link, &mut bytes, now)
                    && let Some(connection) = self.connections.get_mut(&link)
                {
                    connection.handle_input(&mut self.device, &bytes, now);
                }
            }
            Event::Wants(wants) => {
                let is_permitted = self.permitted.get(&wants.block).is_some();
                self.engine.permit(&wants, if is_permitted { Ok(()) } else { Err("") }, now);
            }
            // The built-in device is always there.
            Event::Target { .. } => {}
            Event::Changed { block, edge } => {
                let view = self.engine.glance(block)?;
                let edges = edge.into_iter().collect();
                return Some(News::Changed(block, Box::new(BlockView { edges, ..view })));
            }
            Event::Finished { block, exchange, .. } => return Some(News::Finished(block, exchange)),
        }
        None
    }

    /// Brings due replies to the engine; says whether there were any.
    fn deliver(&mut self) -> bool {
        let now = (self.clock)();
        let mut moved = false;
        let links: Vec<_> = self.connections.keys().copied().collect();
        for link in links {
            let Some(connection) = self.connections.get_mut(&link) else { continue };
            let mut bytes = Vec::new();
            if connection.poll_transmit(&mut bytes, now) {
                self.engine.handle_input(link, &bytes, now);
                moved = true;
            } else if connection.is_closed() {
                self.connections.remove(&link);
                self.engine.closed(link, now);
                moved = true;
            }
        }
        moved
    }
}

/// What the operating system would say.
const NO_NETWORK: &str = "a browser cannot open EtherNet/IP connections; this needs the relay";

#[cfg(test)]
mod tests {
    use super::*;
    use cipdeck_shared::config::MsgCipGeneric;
    use std::cell::Cell;

    thread_local! { static NOW: Cell<u64> = const { Cell::new(0) }; }

    const BLOCK: BlockId = BlockId(1);

    /// Runs a block to its end and gives its last view and its exchange.
    fn run(config: &MsgCipGeneric, confirmed: bool) -> (BlockView, Exchange) {
        NOW.set(0);
        let mut bench = Bench::new(|| Instant(NOW.get()));
        let (plan, findings) = MessagePlan::parse(config);
        bench.put(BLOCK, plan.unwrap_or_else(|| panic!("{findings:?}")), confirmed);
        bench.run(BLOCK).unwrap();
        let (mut view, mut exchange) = (BlockView::default(), None);
        while exchange.is_none() {
            for news in bench.settle() {
                match news {
                    News::Changed(_, changed) => view = *changed,
                    News::Finished(_, finished) => exchange = Some(*finished),
                }
            }
            NOW.set(bench.poll_timeout().map_or(NOW.get(), |next| next.0));
        }
        (view, exchange.unwrap())
    }

    #[test]
    fn the_demo_device_tells_its_name_without_a_relay() {
        let (view, exchange) = run(&MsgCipGeneric::product_name("0,0"), false);
        assert!(view.q, "{view:?}");
        assert_eq!(usize::from(view.res_data[0]), view.res_data.len() - 1, "a SHORT_STRING");
        assert_eq!(exchange.request[..], [0x0E, 3, 0x20, 1, 0x24, 1, 0x30, 7]);
        assert_eq!(exchange.response().unwrap()[..4], [0x8E, 0, 0, 0]);
    }

    #[test]
    fn a_write_needs_a_confirmation_here_too() {
        let mut config = MsgCipGeneric::product_name("0,0");
        config.app_cfg.service = 16;
        (config.app_cfg.class, config.app_cfg.instance, config.app_cfg.attribute) = (4, 150, 3);
        config.req_data = "01".repeat(32);
        let (refused, _) = run(&config, false);
        assert!(refused.status.error && !refused.q, "{refused:?}");
        let (written, _) = run(&config, true);
        assert!(written.q, "{written:?}");
    }

    #[test]
    fn the_demo_device_has_holding_registers() {
        let mut config = MsgCipGeneric::product_name("0,0");
        config.app_cfg.service = 0x4E;
        (config.app_cfg.class, config.app_cfg.instance, config.app_cfg.attribute) = (0x44, 1, 0);
        config.req_data = "05000200".to_owned();
        let (view, exchange) = run(&config, false);
        assert!(view.q, "{view:?}");
        assert_eq!(exchange.request[..], [0x4E, 2, 0x20, 0x44, 0x24, 1, 5, 0, 2, 0]);
        assert_eq!(view.res_data[..], [5, 0, 6, 0], "registers 5 and 6 hold their own numbers");
    }

    #[test]
    fn a_device_on_the_network_is_out_of_reach() {
        let (view, _) = run(&MsgCipGeneric::product_name("4,192.168.1.100"), false);
        assert_eq!(view.status.error_id, 210);
    }
}
