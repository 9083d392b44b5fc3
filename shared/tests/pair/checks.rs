//! What always holds, whatever happens on the way.

use cipdeck_shared::config::BlockId;

use crate::shots::{number_of, time_of};
use crate::world::World;

impl World {
    /// Every message has ended in time; every value is the answer to its own request; nothing was carried out twice.
    pub(crate) fn check(&self) {
        for finished in &self.finished {
            let spec = &self.specs[finished.block];
            let elapsed = finished.view.elapsed_us.expect("it has ended");
            assert!(elapsed <= spec.longest(), "{elapsed} µs: {finished:?}");
            let ended = finished.view.status.status_bits.0 & 0b1_1000;
            assert!(ended == 0b1_0000 || ended == 0b1000, "either DN or ER: {finished:?}");
            if finished.view.q && spec.period > 0 {
                let read = time_of(&finished.view.res_data);
                let triggered = finished.at.0 - elapsed;
                assert!(
                    triggered / 1_000 * 1_000 <= read && read <= finished.at.0,
                    "not an old value: {finished:?}"
                );
            } else if finished.view.q {
                assert_eq!(
                    number_of(&finished.view.res_data),
                    finished.number,
                    "its own value: {finished:?}"
                );
            }
        }
        for (request, times) in &self.executed {
            assert_eq!(*times, 1, "carried out once: {request:x?}");
        }
    }

    /// After a stop: nobody is busy, nothing is open, and no device holds a connection.
    pub(crate) fn check_stopped(&self) {
        self.check();
        assert!(self.engine.is_quiet(), "everything is closed");
        for block in (1..=self.specs.len()).map(|block| BlockId(u32::try_from(block).unwrap())) {
            assert!(!self.engine.is_busy(block), "{block} has ended");
        }
        for device in &self.devices {
            let counters = device.counters();
            let ended = counters.closed + counters.timed_out + counters.unregistered;
            assert_eq!(counters.opened, ended, "{counters}");
            assert_eq!(counters.repeated, 0, "a sequence count is used once: {counters}");
        }
    }
}
