//! Time that is passed in.

use core::ops::Add;

use crate::plan::limits::FOR_EVER;

/// Microseconds since an epoch that the caller chooses. It never goes back.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, PartialOrd, Ord, Hash)]
pub struct Instant(pub u64);

impl Instant {
    /// The epoch.
    pub const ZERO: Self = Self(0);

    /// A time that does not come.
    pub const NEVER: Self = Self(u64::MAX);

    /// The end of a time limit in ms; [`FOR_EVER`] has none.
    #[must_use]
    pub fn deadline(self, ms: u32) -> Self {
        if ms == FOR_EVER { Self::NEVER } else { self + Millis::from(ms) }
    }

    /// Microseconds from `earlier` to here; 0 if it is later.
    pub const fn micros_since(self, earlier: Self) -> u64 {
        self.0.saturating_sub(earlier.0)
    }
}

impl Add<Millis> for Instant {
    type Output = Self;

    fn add(self, span: Millis) -> Self {
        Self(self.0.saturating_add(span.0.saturating_mul(1_000)))
    }
}

/// A span of milliseconds.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, PartialOrd, Ord, Hash)]
pub struct Millis(pub u64);

impl From<u32> for Millis {
    fn from(millis: u32) -> Self {
        Self(millis.into())
    }
}
