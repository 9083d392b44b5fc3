//! The edges of a block's runs, collected from the pieces that arrive.

use cipdeck_shared::engine::StatusBits;

/// µs since the trigger, and the bits from then on.
pub type Edge = (u64, StatusBits);

/// Edges of the newest run, and of the newest that has ended.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub struct Trace {
    newest: Vec<Edge>,
    ended: Vec<Edge>,
}

impl Trace {
    /// Takes in newer edges. A new run starts where the clock starts again.
    pub fn extend(&mut self, newer: &[Edge]) {
        for edge in newer {
            let triggered = *edge == (0, StatusBits(StatusBits::EN));
            if triggered || self.newest.last().is_some_and(|last| edge.0 < last.0) {
                let before = std::mem::take(&mut self.newest);
                if has_ended(&before) {
                    self.ended = before;
                }
            }
            self.newest.push(*edge);
        }
        let excess = self.newest.len().saturating_sub(MOST);
        self.newest.drain(..excess);
    }

    /// The newest run, oldest edge first.
    pub fn newest(&self) -> &[Edge] {
        &self.newest
    }

    /// The newest run that has ended; without one, the newest. For a block that runs again and again: half a run,
    /// seen for a moment, tells nobody anything.
    pub fn steady(&self) -> &[Edge] {
        if has_ended(&self.newest) || self.ended.is_empty() { &self.newest } else { &self.ended }
    }
}

fn has_ended(edges: &[Edge]) -> bool {
    edges.iter().any(|(_, bits)| bits.has(StatusBits::DN) || bits.has(StatusBits::ER))
}

/// A run has five or six edges; more are kept only for a run that was retriggered unseen.
const MOST: usize = 16;

#[cfg(test)]
mod tests {
    use super::*;

    const TRIGGER: Edge = (0, StatusBits(StatusBits::EN));
    const BUFFER: Edge = (4, StatusBits(StatusBits::EN | StatusBits::EW));
    const DONE: Edge = (412, StatusBits(StatusBits::EN | StatusBits::DN));

    #[test]
    fn a_run_that_arrives_in_pieces_is_one_trace() {
        let mut trace = Trace::default();
        trace.extend(&[TRIGGER, BUFFER]);
        trace.extend(&[DONE]);
        assert_eq!(trace.newest(), [TRIGGER, BUFFER, DONE]);
    }

    #[test]
    fn a_new_trigger_starts_a_new_trace() {
        let mut trace = Trace::default();
        trace.extend(&[TRIGGER, BUFFER, DONE, TRIGGER, BUFFER]);
        assert_eq!(trace.newest(), [TRIGGER, BUFFER]);
        trace.extend(&[(3, StatusBits(3))]);
        assert_eq!(trace.newest(), [(3, StatusBits(3))], "the start of this run was dropped on the way");
    }

    #[test]
    fn edges_at_the_same_moment_belong_to_one_run() {
        let mut trace = Trace::default();
        trace.extend(&[TRIGGER, (0, StatusBits(3)), (0, StatusBits(5)), (0, StatusBits(17))]);
        assert_eq!(trace.newest().len(), 4);
    }

    #[test]
    fn a_cyclic_block_shows_its_last_whole_run() {
        let mut trace = Trace::default();
        trace.extend(&[TRIGGER]);
        assert_eq!(trace.steady(), [TRIGGER]);
        trace.extend(&[DONE, TRIGGER, BUFFER]);
        assert_eq!(trace.steady(), [TRIGGER, DONE]);
    }
}
