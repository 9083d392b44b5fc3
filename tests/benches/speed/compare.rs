//! Our client beside the others, all on the same targets, in turns.

use std::fmt::Write as _;
use std::process::{Command, Stdio};

use crate::load::{Load, Sample, median};
use crate::target::{Kind, Targets};
use crate::way::{Sender, Way};

/// One line of the table, before it is measured.
#[derive(Clone, Copy, Debug)]
struct Row {
    way: Way,
    sessions: usize,
    /// The client's; the targets are on processor 0.
    processor: usize,
}

/// How long and how often.
#[derive(Clone, Copy, Debug)]
struct Effort {
    rounds: usize,
    warm_up: u64,
    measure: u64,
}

impl Effort {
    const fn new(quick: bool) -> Self {
        if quick {
            Self { rounds: 3, warm_up: 50, measure: 250 }
        } else {
            Self { rounds: 9, warm_up: 100, measure: 700 }
        }
    }
}

const fn title(kind: Kind) -> &'static str {
    match kind {
        Kind::Ciplink => "ciplink's adapter",
        Kind::Simulated | Kind::Logix => "cipdeck's simulated device",
    }
}

const SESSIONS: [usize; 2] = [1, 64];

/// Measures all rows against one kind of target.
pub(crate) fn table(kind: Kind, quick: bool) -> String {
    let effort = Effort::new(quick);
    let count = SESSIONS.into_iter().max().unwrap_or(1);
    let targets = Targets::start(kind, count, 0);
    let mut text = format!(
        "### Target: {}\n\nMedian of {} rounds of {} ms each, taken in turns; µs.\n\n\
         | message | sessions | processors | client | requests/s | p50 | p99 | client CPU | ratio |\n\
         | --- | ---: | ---: | --- | ---: | ---: | ---: | ---: | ---: |\n",
        title(kind),
        effort.rounds,
        effort.measure
    );
    for processor in processors() {
        for sessions in SESSIONS {
            for way in Way::ALL {
                row(&mut text, Row { way, sessions, processor }, effort, &targets);
            }
        }
    }
    text
}

/// One processor for both sides; then one each, where there are two.
fn processors() -> std::ops::RangeInclusive<usize> {
    let there = std::thread::available_parallelism().map_or(1, usize::from);
    0..=usize::from(there > 1)
}

fn row(text: &mut String, row: Row, effort: Effort, targets: &Targets) {
    let mut samples: [Vec<Sample>; 3] = Default::default();
    for round in 0..effort.rounds {
        for (sender, samples) in Sender::ALL.into_iter().zip(&mut samples) {
            // What failed once is not tried again.
            if samples.len() == round {
                samples.extend(measure(sender, row, effort, targets));
            }
        }
    }
    let rates = samples.each_ref().map(|samples| median(samples.iter().map(|sample| sample.per_second)));
    let best_peer = rates.iter().skip(1).copied().fold(0.0, f64::max);
    for ((sender, samples), rate) in Sender::ALL.into_iter().zip(&samples).zip(rates) {
        let middle = |value: fn(&Sample) -> f64| median(samples.iter().map(value));
        let ratio = match sender {
            _ if samples.is_empty() => "failed".to_owned(),
            Sender::Ours if best_peer > 0.0 => format!("**{:.2}**", rate / best_peer),
            _ => String::new(),
        };
        let _ = writeln!(
            text,
            "| {} | {} | {} | {} | {rate:.0} | {:.1} | {:.1} | {:.1} | {ratio} |",
            row.way.name(),
            row.sessions,
            row.processor + 1,
            sender.name(),
            middle(|sample| sample.p50),
            middle(|sample| sample.p99),
            middle(|sample| sample.cpu),
        );
    }
}

/// In a process of its own; nothing when that fails, having said why.
fn measure(sender: Sender, row: Row, effort: Effort, targets: &Targets) -> Option<Sample> {
    let load = Load {
        way: row.way,
        targets: targets.addresses.iter().copied().take(row.sessions).collect(),
        warm_up: effort.warm_up,
        measure: effort.measure,
    };
    send(sender, row.processor, &load)
}

/// One measurement, in a process of its own; nothing when that fails, having said why.
pub(crate) fn send(sender: Sender, processor: usize, load: &Load) -> Option<Sample> {
    use clap::ValueEnum as _;
    let word = |value: Option<clap::builder::PossibleValue>| {
        value.map_or_else(String::new, |value| value.get_name().to_owned())
    };
    let program = std::env::current_exe().expect("this program");
    let mut command = Command::new(program);
    command.env("RUST_BACKTRACE", "0");
    command.args(["send", &word(sender.to_possible_value()), &processor.to_string()]);
    command.args(["--way", &word(load.way.to_possible_value())]);
    command.args(["--warm-up", &load.warm_up.to_string(), "--measure", &load.measure.to_string()]);
    for target in &load.targets {
        command.args(["--target", &target.to_string()]);
    }
    let output = command.stderr(Stdio::inherit()).output().expect("this program starts again");
    serde_json::from_slice(&output.stdout).ok().filter(|_| output.status.success())
}
