//! Who sends, and how.

use clap::ValueEnum;

/// Who sends.
#[derive(Clone, Copy, Debug, PartialEq, Eq, ValueEnum)]
pub(crate) enum Sender {
    /// `cipdeck_relay::client`.
    Ours,
    /// The crate `ciplink`: blocking, a thread per session.
    Ciplink,
    /// The crate `rseip`: tokio.
    Rseip,
}

impl Sender {
    /// All, in the order of the table.
    pub(crate) const ALL: [Self; 3] = [Self::Ours, Self::Ciplink, Self::Rseip];

    /// The name in the table.
    pub(crate) const fn name(self) -> &'static str {
        match self {
            Self::Ours => "cipdeck",
            Self::Ciplink => "ciplink",
            Self::Rseip => "rseip",
        }
    }
}

/// How Get_Attribute_Single 1/1/1 travels.
#[derive(Clone, Copy, Debug, PartialEq, Eq, ValueEnum)]
pub(crate) enum Way {
    /// SendRRData, no route.
    Unconnected,
    /// Unconnected_Send to port 1, slot 0.
    Routed,
    /// SendUnitData over a class 3 connection.
    Connected,
}

impl Way {
    /// All, in the order of the table.
    pub(crate) const ALL: [Self; 3] = [Self::Unconnected, Self::Routed, Self::Connected];

    /// The name in the table.
    pub(crate) const fn name(self) -> &'static str {
        match self {
            Self::Unconnected => "unconnected",
            Self::Routed => "routed",
            Self::Connected => "class 3",
        }
    }
}

/// Counts and durations here are far below 2^53.
#[expect(clippy::cast_precision_loss, reason = "far below 2^53")]
pub(crate) fn number(value: impl TryInto<u64>) -> f64 {
    value.try_into().unwrap_or(u64::MAX) as f64
}
