//! Who holds which buffer and who waits: from what the blocks say of themselves.

use std::rc::Rc;

use cipdeck_shared::{
    config::Channel,
    engine::{CONTROLLER_BUFFERS, Phase},
};

use crate::store::{DeckId, Row, RowStore, Shelf, target_of};

/// All messages under way, by channel.
#[derive(Debug, Default)]
pub(super) struct Queue {
    pub(super) channels: Shelf<Channel, Line>,
}

/// The messages of one channel.
#[derive(Debug, Default)]
pub(super) struct Line {
    /// Buffers and who holds them; as many as there are, more on the monitor.
    pub(super) buffers: Vec<Option<Busy>>,
    /// Who waits for a buffer, the next one first.
    pub(super) waiting: Vec<Busy>,
}

/// A message under way.
#[derive(Clone, Debug)]
pub(super) struct Busy {
    pub(super) row: Rc<Row>,
    pub(super) target: String,
}

/// Where each block sat last: it stays there as long as it holds a buffer.
pub(super) type Seats = Shelf<Channel, Vec<Option<DeckId>>>;

impl Queue {
    /// The controller's channel is always there, others if a block names them.
    pub(super) fn of(rows: &RowStore, seats: &mut Seats) -> Self {
        let rows: Vec<_> = rows.ids().iter().filter_map(|id| rows.row(*id)).collect();
        Self::of_rows(&rows, seats)
    }

    fn of_rows(rows: &[Rc<Row>], seats: &mut Seats) -> Self {
        let mut channels = Shelf::default();
        let mut holders: Shelf<Channel, Vec<Busy>> = Shelf::default();
        channels.insert(Channel::Controller, Line::default());
        for row in rows {
            let line = channels.or_default(row.config.channel());
            if !row.status.phase.is_busy() {
                continue;
            }
            let target = target_of(row.config.target_text()).unwrap_or_default();
            let busy = Busy { row: row.clone(), target };
            if row.status.phase == Phase::Waiting {
                let after = |other: &Busy| other.row.status.position <= row.status.position;
                line.waiting.insert(line.waiting.partition_point(after), busy);
            } else {
                holders.or_default(row.config.channel()).push(busy);
            }
        }
        let mut queue = Self::default();
        for (channel, mut line) in channels {
            let holders = holders.remove(&channel).unwrap_or_default();
            let ids: Vec<_> = holders.iter().map(|busy| busy.row.id).collect();
            let limit = channel.of_controller().map_or(0, |_| CONTROLLER_BUFFERS);
            let seated = seat(seats.or_default(channel), &ids, limit);
            let at = |id: &DeckId| holders.iter().find(|busy| busy.row.id == *id).cloned();
            line.buffers = seated.iter().map(|id| at(id.as_ref()?)).collect();
            seats.insert(channel, seated);
            queue.channels.insert(channel, line);
        }
        queue
    }

    /// The message that keeps a target busy for another one.
    pub(super) fn busy_with(&self, waiting: &Busy) -> Option<&Busy> {
        let all = self.channels.values().flat_map(|line| line.buffers.iter().flatten());
        let mut others = all.filter(|other| {
            let at_target = matches!(other.row.status.phase, Phase::Connecting | Phase::Sent);
            at_target && other.target == waiting.target && other.row.id != waiting.row.id
        });
        others.next()
    }
}

/// Gives everybody who still holds a buffer the same seat, and the others free ones.
fn seat(last: &[Option<DeckId>], holders: &[DeckId], limit: usize) -> Vec<Option<DeckId>> {
    let stays = |id: &Option<DeckId>| id.filter(|id| holders.contains(id));
    let mut seats: Vec<_> = last.iter().map(stays).collect();
    seats.resize(seats.len().max(limit), None);
    for id in holders {
        if seats.contains(&Some(*id)) {
            continue;
        }
        match seats.iter_mut().find(|seat| seat.is_none()) {
            Some(free) => *free = Some(*id),
            None => seats.push(Some(*id)),
        }
    }
    while seats.len() > limit && seats.last() == Some(&None) {
        seats.pop();
    }
    seats
}

#[cfg(test)]
mod tests {
    use super::*;
    use cipdeck_shared::{
        api::BlockStatus,
        config::{BlockId, MsgCipGeneric},
        engine::BlockView,
    };

    fn row(id: u32, path: &str, phase: Phase, position: usize) -> Rc<Row> {
        let view = BlockView { phase, position, ..BlockView::default() };
        let status = Rc::new(BlockStatus::new(BlockId(id), &view, None, None));
        let config = Rc::new(MsgCipGeneric::product_name(path).into());
        let id = DeckId::Stored(BlockId(id));
        Rc::new(Row { id, revision: 1, config, status, trace: Rc::default(), exchange: None, written: None })
    }

    fn ids(line: &[Busy]) -> Vec<String> {
        line.iter().map(|busy| busy.row.id.to_string()).collect()
    }

    #[test]
    fn four_hold_a_buffer_and_the_others_wait_in_order() {
        let rows = [
            row(1, "4,10.0.0.1", Phase::Sent, 0),
            row(2, "4,10.0.0.2", Phase::Connecting, 0),
            row(3, "4,10.0.0.3", Phase::Sent, 0),
            row(4, "4,10.0.0.1", Phase::Buffered, 0),
            row(5, "4,10.0.0.5", Phase::Waiting, 2),
            row(6, "4,10.0.0.6", Phase::Waiting, 1),
            row(7, "4,10.0.0.7", Phase::Done, 0),
        ];
        let queue = Queue::of_rows(&rows, &mut Seats::default());
        let line = queue.channels.get(&Channel::Controller).unwrap();
        let held: Vec<_> = line.buffers.iter().flatten().cloned().collect();
        assert_eq!(
            (line.buffers.len(), ids(&held)),
            (4, vec!["b1".into(), "b2".into(), "b3".into(), "b4".into()])
        );
        assert_eq!(ids(&line.waiting), ["b6", "b5"]);
        assert_eq!(queue.busy_with(&held[3]).unwrap().row.id.to_string(), "b1");
        assert!(queue.busy_with(&held[1]).is_none());
    }

    #[test]
    fn a_message_keeps_its_buffer_while_others_come_and_go() {
        let id = |number| DeckId::Stored(BlockId(number));
        let first = seat(&[], &[id(1), id(2), id(3)], 4);
        assert_eq!(first, [Some(id(1)), Some(id(2)), Some(id(3)), None]);
        let then = seat(&first, &[id(2), id(3), id(9)], 4);
        assert_eq!(then, [Some(id(9)), Some(id(2)), Some(id(3)), None]);
        assert_eq!(seat(&first, &[id(1)], 0), [Some(id(1))], "the monitor has as many as it needs");
    }
}
