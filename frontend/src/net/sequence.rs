//! Counts the relay's messages: after a gap nothing is believed until the next snapshot.

/// The last `seq`, or nothing while a snapshot is awaited.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Sequence(Option<u64>);

impl Sequence {
    /// A snapshot is always right.
    pub fn snapshot(&mut self, seq: u64) {
        self.0 = Some(seq);
    }

    /// Whether these changes follow what is known.
    pub fn changes(&mut self, seq: u64) -> bool {
        self.0 = self.0.filter(|last| last.checked_add(1) == Some(seq)).map(|_| seq);
        self.0.is_some()
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn after_a_gap_changes_are_ignored_until_a_snapshot() {
        let mut sequence = Sequence::default();
        assert!(!sequence.changes(1), "nothing is known before the first snapshot");
        sequence.snapshot(7);
        assert!(sequence.changes(8));
        assert!(!sequence.changes(10));
        assert!(!sequence.changes(11));
        sequence.snapshot(12);
        assert!(sequence.changes(13));
    }
}
