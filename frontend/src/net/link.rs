//! What the page knows of its connection, and of writing.

use cipdeck_shared::api::WriteState;

use crate::browser;

/// What the page says about the connection.
#[derive(Clone, Debug, PartialEq)]
pub enum Link {
    /// The first try.
    Connecting,
    /// Connected; the time of a small request and its answer, once it is known.
    Online {
        /// Milliseconds.
        latency_ms: Option<f64>,
    },
    /// Lost. Both times are of [`browser::now_ms`].
    Lost {
        /// When the next try is due, in milliseconds.
        next_ms: f64,
        /// When it was lost, in milliseconds.
        since_ms: f64,
    },
    /// There has never been a relay behind this page.
    None {
        /// As in `Lost`.
        next_ms: f64,
    },
    /// The relay speaks another protocol than this page.
    Foreign {
        /// The relay's.
        protocol: u32,
    },
    /// There is no administrator yet.
    SetUp,
    /// Nobody is signed in, or not any more.
    SignedOut,
    /// Who is signed in may not watch.
    Denied,
}

impl Link {
    /// Whether there is no relay now, and another try is due.
    pub const fn waits(&self) -> bool {
        matches!(self, Self::Lost { .. } | Self::None { .. })
    }
}

/// What the relay says about writing.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Writing {
    /// As it was heard.
    pub state: WriteState,
    /// When the window closes, in ms of [`browser::now_ms`].
    pub ends_ms: f64,
}

impl Writing {
    /// What was heard just now.
    pub fn heard(state: WriteState) -> Self {
        #[expect(clippy::cast_precision_loss, reason = "an hour at most")]
        let left_ms = state.window.as_ref().map_or(0, |window| window.left_ms) as f64;
        Self { state, ends_ms: browser::now_ms() + left_ms }
    }
}
