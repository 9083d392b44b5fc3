//! What history costs: the same runs through a relay that keeps them and one that does not, in turns.

use std::fmt::Write as _;
use std::time::{Duration, Instant};

use crate::load::median;
use crate::processor;
use crate::relay::{RelayProcess, runs};
use crate::target::{Kind, Targets};
use crate::way::number;

/// One of the two relays.
struct Side {
    name: &'static str,
    relay: RelayProcess,
    /// Runs per second, a round each.
    rates: Vec<f64>,
    /// Processor time of the relay, µs per run, a round each.
    used: Vec<f64>,
}

/// Measures both in turns and prints them. The threads that write are on the same processor as everything else.
pub(crate) fn table(quick: bool) -> String {
    // Several writes of the history fall into each round.
    let (rounds, measure) = if quick { (3, Duration::from_secs(1)) } else { (9, Duration::from_secs(2)) };
    let targets = Targets::start(Kind::Ciplink, 1, 0);
    let target = *targets.addresses.first().expect("one target");
    let side = |name, more: &[&str]| {
        let relay = RelayProcess::start_with(0, more);
        Side { name, relay, rates: Vec::new(), used: Vec::new() }
    };
    let mut sides = [side("off", &["--no-history"]), side("on", &[])];
    let runtime = tokio::runtime::Builder::new_current_thread().enable_all().build().expect("a runtime");
    let mut sockets = sides.each_ref().map(|side| {
        let id = runtime.block_on(side.relay.block(target));
        (side.relay.web_socket(), id)
    });
    let anywhere = processor::pin(0);
    for _ in 0..rounds {
        for (side, (socket, id)) in sides.iter_mut().zip(&mut sockets) {
            let (since, before) = (Instant::now(), side.relay.time());
            let count = number(runs(socket, id, measure).len());
            side.rates.push(count / since.elapsed().as_secs_f64());
            let used = side.relay.time().saturating_sub(before);
            side.used.push(used.as_secs_f64() * 1e6 / count);
        }
    }
    processor::unpin(&anywhere);
    let [off, on] = sides.each_ref().map(|side| median(side.rates.iter().copied()));
    let mut text = format!(
        "### What history costs\n\nWebSocket `run` to its answer, one at a time, everything on one processor; two relays in turns, \
         median of {rounds} rounds of {} ms.\n\n\
         | history | runs/s | relay CPU µs | ratio |\n| --- | ---: | ---: | ---: |\n",
        measure.as_millis()
    );
    for (side, rate) in sides.iter().zip([off, on]) {
        let ratio = if side.name == "on" { format!("**{:.2}**", on / off) } else { String::new() };
        let used = median(side.used.iter().copied());
        let _ = writeln!(text, "| {} | {rate:.0} | {used:.1} | {ratio} |", side.name);
    }
    text
}
