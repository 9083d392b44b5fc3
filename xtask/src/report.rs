//! What `xtask` says while it works: each step with its time, and one closing line.

use std::time::{Duration, Instant};

use anyhow::{Error, Result};

/// The steps of one call, with their times.
#[derive(Debug)]
pub(crate) struct Report {
    started: Instant,
    steps: Vec<(String, Duration)>,
}

impl Report {
    pub(crate) fn new() -> Self {
        Self { started: Instant::now(), steps: Vec::new() }
    }

    /// Does one step, and says what it does and how long it took.
    pub(crate) fn step<T>(&mut self, name: &str, work: impl FnOnce() -> Result<T>) -> Result<T> {
        println!("[{}] {name}", seconds(self.started.elapsed()));
        let begun = Instant::now();
        let result = work();
        let took = begun.elapsed();
        if result.is_ok() {
            println!("[{}] {name}: done in {}", seconds(self.started.elapsed()), seconds(took));
            self.steps.push((name.to_owned(), took));
        }
        result.map_err(|error| error.context(format!("step \"{name}\"")))
    }

    /// Says something that belongs to no step.
    #[expect(clippy::unused_self, reason = "all output goes through the report")]
    pub(crate) fn say(&self, text: &str) {
        println!("    {text}");
    }

    /// The closing lines after success: the steps that took noticeable time, and the total.
    pub(crate) fn succeeded(&self) {
        for (name, took) in self.steps.iter().filter(|(_, took)| took.as_secs() >= 1) {
            println!("{:>9}  {name}", seconds(*took));
        }
        println!("xtask: ok, {} steps in {}", self.steps.len(), seconds(self.started.elapsed()));
    }

    /// The closing lines after a failure.
    pub(crate) fn failed(&self, error: &Error) {
        eprintln!("xtask: FAILED after {}: {error:#}", seconds(self.started.elapsed()));
    }
}

/// `12.3 s`, or `3 min 05 s`.
pub(crate) fn seconds(time: Duration) -> String {
    match time.as_secs() {
        0..60 => format!("{:.1} s", time.as_secs_f64()),
        whole => format!("{} min {:02} s", whole / 60, whole % 60),
    }
}
