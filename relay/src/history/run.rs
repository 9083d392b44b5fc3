//! One run as it is handed over and kept.

use std::sync::Arc;

use cipdeck_shared::config::BlockId;
use cipdeck_shared::engine::{BlockView, CauseKind, Exchange};

/// A message that has ended with DN or ER.
#[derive(Clone, Debug, PartialEq, Eq)]
pub(crate) struct Run {
    pub(crate) block: BlockId,
    /// When it ended: µs since 1970.
    pub(crate) at_us: u64,
    pub(crate) q: bool,
    pub(crate) error_id: u16,
    pub(crate) sub_error_id: u16,
    pub(crate) ext_error_id: u16,
    pub(crate) cause: Option<What>,
    pub(crate) reply_us: Option<u64>,
    pub(crate) elapsed_us: Option<u64>,
    /// Message router request.
    pub(crate) request: Arc<[u8]>,
    /// Message router reply, if one came.
    pub(crate) response: Option<Arc<[u8]>>,
}

/// What happened, on an error.
#[derive(Clone, Debug, PartialEq, Eq)]
pub(crate) struct What {
    pub(crate) kind: CauseKind,
    pub(crate) may_have_acted: bool,
    pub(crate) has_acted: bool,
}

impl Run {
    /// What the engine says at the end of a message.
    pub(super) fn new(block: BlockId, at_us: u64, view: &BlockView, exchange: &Exchange) -> Self {
        let cause = view.cause.as_ref().map(|cause| What {
            kind: cause.what.clone(),
            may_have_acted: cause.may_have_acted,
            has_acted: cause.has_acted,
        });
        Self {
            block,
            at_us,
            q: view.q,
            error_id: view.status.error_id,
            sub_error_id: view.status.sub_error_id,
            ext_error_id: view.status.ext_error_id,
            cause,
            reply_us: view.reply_us,
            elapsed_us: view.elapsed_us,
            request: Arc::clone(&exchange.request),
            response: exchange.response().map(Arc::from),
        }
    }

    /// Bytes that it takes in memory, roughly.
    pub(super) fn weight(&self) -> usize {
        size_of::<Self>() + self.response.as_ref().map_or(0, |response| response.len())
    }
}

/// A run as tests need it.
#[cfg(test)]
pub(super) fn a_run(block: u32, at_us: u64) -> Run {
    Run {
        block: BlockId(block),
        at_us,
        q: true,
        error_id: 0,
        sub_error_id: 0,
        ext_error_id: 0,
        cause: None,
        reply_us: Some(300),
        elapsed_us: Some(400),
        // Get_Attribute_Single of Identity 1/1/1, and its answer: vendor 1.
        request: Arc::from([0x0E, 3, 0x20, 1, 0x24, 1, 0x30, 1]),
        response: Some(Arc::from([0x8E, 0, 0, 0, 1, 0])),
    }
}

/// A run that the device refused.
#[cfg(test)]
pub(super) fn a_refused_run(block: u32, at_us: u64) -> Run {
    Run {
        q: false,
        error_id: 224,
        sub_error_id: 5,
        cause: Some(What { kind: CauseKind::RefusedByDevice, may_have_acted: false, has_acted: false }),
        response: Some(Arc::from([0x8E, 0, 5, 0])),
        ..a_run(block, at_us)
    }
}
