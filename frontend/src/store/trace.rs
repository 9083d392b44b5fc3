//! The edges of one run, collected from the pieces that arrive.

use cipdeck_shared::engine::StatusBits;

/// Edges of the newest run: µs since its trigger, and the bits from then on.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub struct Trace {
    edges: Vec<(u64, StatusBits)>,
}

impl Trace {
    /// Takes in newer edges. A new run starts where the clock starts again.
    pub fn extend(&mut self, newer: &[(u64, StatusBits)]) {
        for edge in newer {
            let triggered = *edge == (0, StatusBits(StatusBits::EN));
            if triggered || self.edges.last().is_some_and(|last| edge.0 < last.0) {
                self.edges.clear();
            }
            self.edges.push(*edge);
        }
        let excess = self.edges.len().saturating_sub(MOST);
        self.edges.drain(..excess);
    }

    /// Oldest first.
    pub fn edges(&self) -> &[(u64, StatusBits)] {
        &self.edges
    }
}

/// A run has five or six edges; more are kept only for a run that was retriggered unseen.
const MOST: usize = 16;

#[cfg(test)]
mod tests {
    use super::*;

    fn edges(times: &[u64]) -> Vec<(u64, StatusBits)> {
        times.iter().map(|time| (*time, StatusBits(if *time == 0 { 1 } else { 5 }))).collect()
    }

    #[test]
    fn a_run_that_arrives_in_pieces_is_one_trace() {
        let mut trace = Trace::default();
        trace.extend(&edges(&[0, 4]));
        trace.extend(&edges(&[9, 412]));
        assert_eq!(trace.edges(), edges(&[0, 4, 9, 412]));
    }

    #[test]
    fn a_new_trigger_starts_a_new_trace() {
        let mut trace = Trace::default();
        trace.extend(&edges(&[0, 4, 412, 0, 5]));
        assert_eq!(trace.edges(), edges(&[0, 5]));
        trace.extend(&edges(&[3]));
        assert_eq!(trace.edges(), edges(&[3]), "the start of this run was dropped on the way");
    }
}
