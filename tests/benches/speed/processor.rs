//! Processors: which one a process runs on, and how long it has.

use std::time::Duration;

use rustix::thread::{CpuSet, sched_getaffinity, sched_setaffinity};
use rustix::time::{ClockId, clock_gettime};

/// Where a process may run.
#[derive(Debug)]
pub(crate) struct Processors(CpuSet);

/// Keeps this process, and what it starts from now on, on one processor; where it could run before.
pub(crate) fn pin(processor: usize) -> Processors {
    let before = sched_getaffinity(None).expect("the system says where this process runs");
    let mut set = CpuSet::new();
    set.set(processor);
    sched_setaffinity(None, &set).expect("the processor is there");
    Processors(before)
}

/// Undoes [`pin`].
pub(crate) fn unpin(before: &Processors) {
    sched_setaffinity(None, &before.0).expect("it ran there before");
}

/// The processor time that this process has used.
pub(crate) fn time() -> Duration {
    clock_gettime(ClockId::ProcessCPUTime).try_into().expect("a time after the start")
}
