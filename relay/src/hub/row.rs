//! One block as viewers see it.

use std::collections::VecDeque;
use std::time::SystemTime;

use cipdeck_shared::api::{BlockStatus, ExchangeView, LastSuccess, MAX_EDGES, WordsStatus};
use cipdeck_shared::config::{Block, BlockConfig, BlockId, read_hex};
use cipdeck_shared::dissect::{self, Decoded};
use cipdeck_shared::engine::{BlockView, Exchange, Phase, StatusBits};
use cipdeck_shared::tag::DataFields;

use crate::capture::Carried;
use crate::runner::Trace;
use crate::wall_clock;

/// Exchanges that are kept of each block.
const MAX_EXCHANGES: usize = 16;

#[derive(Debug)]
pub(super) struct Row {
    pub(super) block: Block,
    /// When the row changed last.
    pub(super) version: u64,
    /// When the block itself changed last.
    pub(super) block_version: u64,
    /// The newest status, without edges.
    status: BlockStatus,
    edges: VecDeque<(u64, StatusBits)>,
    /// All edges there ever were, with the dropped ones.
    edge_count: u64,
    exchanges: VecDeque<Kept>,
    /// `ResLayout`, if there is one.
    layout: Option<DataFields>,
}

/// One message that has ended.
#[derive(Debug)]
struct Kept {
    at: String,
    ended: SystemTime,
    exchange: Exchange,
    /// Where it went, if it went anywhere.
    trace: Option<Trace>,
}

impl Row {
    pub(super) fn new(block: Block, version: u64) -> Self {
        let view = BlockView::default();
        let status =
            BlockStatus { words: words(&block, &view), ..BlockStatus::new(block.id, &view, None, None) };
        Self {
            layout: layout_of(&block),
            block,
            version,
            block_version: version,
            status,
            edges: VecDeque::new(),
            edge_count: 0,
            exchanges: VecDeque::new(),
        }
    }

    pub(super) fn replace(&mut self, block: Block, version: u64) {
        if asks(&self.block.config) != asks(&block.config) {
            // An answer to another question would be taken for an answer to this one.
            self.status.last = None;
        }
        self.block = block;
        self.layout = layout_of(&self.block);
        if self.status.phase == Phase::Idle || self.block.config.as_send_req().is_none() {
            // Nothing has been started with other words.
            self.status.words = words(&self.block, &BlockView::default());
        }
        let data = self.status.last.as_ref().and_then(|last| read_hex(&last.res_data).ok());
        let decoded = self.decode(&data.unwrap_or_default());
        if let Some(last) = &mut self.status.last {
            last.decoded = decoded;
        }
        (self.version, self.block_version) = (version, version);
    }

    /// What data means by the block's layout.
    fn decode(&self, data: &[u8]) -> Vec<Decoded> {
        self.layout.as_ref().map_or_else(Vec::new, |layout| dissect::fields(layout, data))
    }

    pub(super) fn changed(&mut self, view: &BlockView, version: u64, at: String) {
        self.edge_count += view.edges_dropped;
        for edge in &view.edges {
            self.edge_count += 1;
            if self.edges.len() == MAX_EDGES {
                self.edges.pop_front();
            }
            self.edges.push_back(*edge);
        }
        let last = self.status.last.take();
        self.status = BlockStatus {
            words: words(&self.block, view),
            ..BlockStatus::new(self.block.id, view, Some(at), last)
        };
        self.status.edges.clear();
        self.version = version;
    }

    pub(super) fn finished(
        &mut self,
        view: &BlockView,
        exchange: Exchange,
        trace: Option<Trace>,
        version: u64,
    ) {
        let at = self.status.at.clone().unwrap_or_else(wall_clock::now);
        if view.q {
            let status = BlockStatus::new(self.block.id, view, Some(at.clone()), None);
            let decoded = self.decode(&view.res_data);
            self.status.last = Some(LastSuccess { decoded, ..LastSuccess::of(&status, at.clone()) });
        }
        if self.exchanges.len() == MAX_EXCHANGES {
            self.exchanges.pop_front();
        }
        self.exchanges.push_back(Kept { at, ended: SystemTime::now(), exchange, trace });
        self.version = version;
    }

    /// The status with what the engine shows at this moment.
    pub(super) fn with(&self, id: BlockId, view: &BlockView) -> BlockStatus {
        let (at, last) = (self.status.at.clone(), self.status.last.clone());
        BlockStatus { words: words(&self.block, view), ..BlockStatus::new(id, view, at, last) }
    }

    /// The status with the edges since `seen`; everything of the last message for a viewer who has seen nothing.
    /// Returns how many edges the viewer has seen then.
    pub(super) fn status(&self, seen: Option<u64>) -> (BlockStatus, u64) {
        let new = match seen {
            Some(seen) => self.edge_count.saturating_sub(seen),
            None => self.edges_of_last_message(),
        };
        let kept = usize::try_from(new).unwrap_or(usize::MAX).min(self.edges.len());
        let edges = self.edges.iter().skip(self.edges.len() - kept).copied().collect();
        let status = BlockStatus { edges, edges_dropped: new - kept as u64, ..self.status.clone() };
        (status, self.edge_count)
    }

    pub(super) fn exchanges(&self) -> Vec<ExchangeView> {
        self.exchanges.iter().map(|kept| ExchangeView::new(kept.at.clone(), &kept.exchange)).collect()
    }

    pub(super) fn frames(&self) -> Vec<Carried> {
        let carried = |kept: &Kept| {
            Some(Carried {
                trace: kept.trace?,
                ended: kept.ended,
                request: kept.exchange.request_frame.clone(),
                response: kept.exchange.response_frame.clone(),
            })
        };
        self.exchanges.iter().filter_map(carried).collect()
    }

    /// A message begins with EN alone, at its trigger.
    fn edges_of_last_message(&self) -> u64 {
        let begin = self.edges.iter().rposition(|edge| *edge == (0, StatusBits(StatusBits::EN)));
        (self.edges.len() - begin.unwrap_or(0)) as u64
    }
}

/// What a SEND_REQ or DATA_EXCH shows beside the rest.
fn words(block: &Block, view: &BlockView) -> Option<WordsStatus> {
    block.config.as_send_req().map(|config| WordsStatus::new(config, view))
}

/// One that cannot be read has been refused when it was stored.
fn layout_of(block: &Block) -> Option<DataFields> {
    DataFields::read(block.config.res_layout()).ok()
}

/// What a block asks, and whom.
fn asks(config: &BlockConfig) -> impl PartialEq + '_ {
    let msg = config.as_msg().map(|config| (&config.app_cfg, &config.req_data, config.req_length));
    let words = config.as_send_req().map(|config| (&config.data_to_send, &config.management_param));
    (config.kind(), config.target_text(), msg, words)
}
