//! Communication buffers: who has one, who waits. 2080-RM001D p. 215.

use alloc::collections::VecDeque;

use crate::config::BlockId;

/// Buffers of the controller. 2080-RM001D p. 215: the Com queue of a channel holds 4 messages.
pub const CONTROLLER_BUFFERS: usize = 4;

/// Sessions of the controller. 2080-RM001D p. 182: at most 16 EtherNet/IP client connections.
pub const CONTROLLER_SESSIONS: usize = 16;

/// Class 3 connections of the controller. 2080-RM001D p. 182: at most 16 CIP class 3 client connections.
pub const CONTROLLER_CONNECTIONS: usize = 16;

/// A Com queue of fixed size and an unlimited Wait queue, first come first served.
#[derive(Debug)]
pub struct Buffers {
    limit: usize,
    /// How many are held.
    held: usize,
    waiting: VecDeque<BlockId>,
    /// Buffers are being granted right now: who has failed at once is followed by the next one there.
    pub(super) granting: bool,
}

impl Buffers {
    /// As the controller's.
    pub const fn controller() -> Self {
        Self::with_limit(CONTROLLER_BUFFERS)
    }

    /// Without a limit.
    pub const fn monitor() -> Self {
        Self::with_limit(usize::MAX)
    }

    const fn with_limit(limit: usize) -> Self {
        Self { limit, held: 0, waiting: VecDeque::new(), granting: false }
    }

    /// A message wants a buffer.
    pub fn enqueue(&mut self, block: BlockId) {
        self.waiting.push_back(block);
    }

    /// A message has ended, wherever it was.
    pub fn release(&mut self, block: BlockId) {
        match self.waiting.iter().position(|waiting| *waiting == block) {
            Some(place) => drop(self.waiting.remove(place)),
            None => self.held = self.held.saturating_sub(1),
        }
    }

    /// The next message that gets a buffer now.
    pub fn poll_grant(&mut self) -> Option<BlockId> {
        if self.held >= self.limit {
            return None;
        }
        let block = self.waiting.pop_front()?;
        self.held += 1;
        Some(block)
    }

    /// Place in the Wait queue: 1 is next; 0 is not waiting.
    pub fn position(&self, block: BlockId) -> usize {
        self.waiting.iter().position(|waiting| *waiting == block).map_or(0, |index| index + 1)
    }

    /// Who waits, in order.
    pub fn waiting(&self) -> impl Iterator<Item = BlockId> + '_ {
        self.waiting.iter().copied()
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use alloc::vec::Vec;

    fn grants(buffers: &mut Buffers) -> Vec<u32> {
        core::iter::from_fn(|| buffers.poll_grant()).map(|block| block.0).collect()
    }

    #[test]
    fn the_fifth_message_waits_for_the_first_to_end() {
        let mut buffers = Buffers::controller();
        (1..=6).for_each(|block| buffers.enqueue(BlockId(block)));
        assert_eq!(grants(&mut buffers), [1, 2, 3, 4]);
        assert_eq!((buffers.position(BlockId(5)), buffers.position(BlockId(6))), (1, 2));
        buffers.release(BlockId(3));
        assert_eq!(grants(&mut buffers), [5]);
        assert_eq!(buffers.position(BlockId(6)), 1);
    }

    #[test]
    fn a_waiting_message_that_is_cancelled_leaves_the_queue() {
        let mut buffers = Buffers::controller();
        (1..=6).for_each(|block| buffers.enqueue(BlockId(block)));
        grants(&mut buffers);
        buffers.release(BlockId(5));
        buffers.release(BlockId(1));
        assert_eq!(grants(&mut buffers), [6]);
    }

    #[test]
    fn the_monitor_never_waits() {
        let mut buffers = Buffers::monitor();
        (0..100).for_each(|block| buffers.enqueue(BlockId(block)));
        assert_eq!(grants(&mut buffers).len(), 100);
    }
}
