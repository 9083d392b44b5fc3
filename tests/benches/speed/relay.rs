//! The way through the relay: WebSocket `run` to its answer, beside the bare client.

use std::io::{BufRead as _, BufReader, Write as _};
use std::net::{SocketAddr, TcpStream};
use std::process::{Child, Command, Stdio};
use std::time::{Duration, Instant};

use cipdeck_tests::block;
use cipdeck_tests::relay::Relay;
use cipdeck_tests::rest::Rest;
use tokio_tungstenite::tungstenite::{Message, WebSocket, client};

use crate::compare::send;
use crate::load::{Load, median, percentile};
use crate::processor;
use crate::target::{Kind, Targets};
use crate::way::{Sender, Way};

/// This process: a relay on one processor, until nobody holds its input open any more.
pub(crate) fn serve(on: usize, history: bool) {
    processor::pin(on);
    let runtime = tokio::runtime::Builder::new_multi_thread().enable_all().build().expect("a runtime");
    let folder = tempfile::TempDir::new().expect("a temporary folder");
    let relay = runtime.block_on(Relay::start_with(folder, |mut settings| {
        settings.history.enabled = history;
        // As fast as it can.
        settings.limits.messages_per_second = 0;
        settings
    }));
    println!("{}", relay.address);
    std::io::stdout().flush().expect("somebody reads");
    let _ = std::io::stdin().read_line(&mut String::new());
    runtime.block_on(relay.stop());
}

/// A relay in a process of its own; it ends when it is dropped.
#[derive(Debug)]
pub(crate) struct RelayProcess {
    child: Child,
    /// Where it listens.
    pub(crate) address: SocketAddr,
}

impl RelayProcess {
    /// Starts it on a processor.
    pub(crate) fn start(on: usize) -> Self {
        Self::start_with(on, &[])
    }

    /// Starts it with more arguments.
    pub(crate) fn start_with(on: usize, more: &[&str]) -> Self {
        let program = std::env::current_exe().expect("this program");
        let mut child = Command::new(program)
            .args(["relay", &on.to_string()])
            .args(more)
            .stdin(Stdio::piped())
            .stdout(Stdio::piped())
            .spawn()
            .expect("this program starts again");
        let mut line = String::new();
        BufReader::new(child.stdout.take().expect("its output")).read_line(&mut line).expect("a line");
        Self { child, address: line.trim().parse().expect("an address") }
    }

    /// A block for the smallest message to a target.
    pub(crate) async fn block(&self, target: SocketAddr) -> String {
        Rest::new(self.address).create(&block::get(&format!("4,{target}"), 1, 1, 1)).await
    }

    /// A WebSocket that waits for nothing but its answers.
    pub(crate) fn web_socket(&self) -> WebSocket<TcpStream> {
        let stream = TcpStream::connect(self.address).expect("the relay listens");
        stream.set_nodelay(true).expect("an open socket");
        let address = format!("ws://{}/api/v1/ws", self.address);
        client(address, stream).expect("the relay takes a WebSocket").0
    }

    /// The processor time that it has used, in steps of 10 ms.
    pub(crate) fn time(&self) -> Duration {
        let stat = std::fs::read_to_string(format!("/proc/{}/stat", self.child.id())).unwrap_or_default();
        // After the name, which may contain anything: state is the first, utime and stime the 12th and 13th.
        let numbers = stat.rsplit(')').next().unwrap_or_default().split_whitespace().skip(11).take(2);
        let ticks: u64 = numbers.filter_map(|word| word.parse::<u64>().ok()).sum();
        Duration::from_millis(ticks * 10)
    }

    /// Bytes of memory that it holds.
    pub(crate) fn memory(&self) -> u64 {
        let status = std::fs::read_to_string(format!("/proc/{}/status", self.child.id())).unwrap_or_default();
        let line = status.lines().find_map(|line| line.strip_prefix("VmRSS:")).unwrap_or_default();
        let kilobytes: u64 = line.trim().trim_end_matches("kB").trim().parse().unwrap_or_default();
        kilobytes * 1_024
    }
}

impl Drop for RelayProcess {
    fn drop(&mut self) {
        drop(self.child.stdin.take());
        let _ = self.child.wait();
    }
}

/// Measures both in turns and prints them.
pub(crate) fn table(quick: bool) -> String {
    let (rounds, measure) = if quick { (3, 250) } else { (9, 700) };
    let targets = Targets::start(Kind::Ciplink, 1, 0);
    let target = *targets.addresses.first().expect("one target");
    let relay = RelayProcess::start(0);
    let runtime = tokio::runtime::Builder::new_current_thread().enable_all().build().expect("a runtime");
    let id = runtime.block_on(relay.block(target));
    let mut socket = relay.web_socket();
    let load = Load { way: Way::Unconnected, targets: vec![target], warm_up: 100, measure };
    let (mut bare, mut through) = (Vec::new(), Vec::new());
    let anywhere = processor::pin(0);
    for _ in 0..rounds {
        bare.extend(send(Sender::Ours, 0, &load).map(|sample| sample.p50));
        let durations = runs(&mut socket, &id, Duration::from_millis(measure));
        through.push(percentile(&durations, 50) / 1_000.0);
    }
    processor::unpin(&anywhere);
    let (bare, through) = (median(bare), median(through));
    format!(
        "### Through the relay\n\nWebSocket `run` to its answer and the bare client's message, unconnected, one at a \
         time, one processor; median of {rounds} rounds.\n\n\
         | | p50 µs | ratio |\n| --- | ---: | ---: |\n\
         | bare client | {bare:.1} | |\n| WebSocket `run` | {through:.1} | {:.2} |\n",
        through / bare
    )
}

/// How long each run took, ns, sorted. A blocking client that reads no JSON: what it costs itself should not count.
pub(crate) fn runs(socket: &mut WebSocket<TcpStream>, id: &str, measure: Duration) -> Vec<u64> {
    let end = Instant::now() + measure;
    let mut durations = Vec::new();
    while Instant::now() < end {
        let run = format!(r#"{{"type":"run","id":"{}","block":"{id}"}}"#, durations.len());
        let since = Instant::now();
        socket.send(Message::text(run)).expect("the relay reads");
        let answer = loop {
            match socket.read().expect("the relay answers") {
                Message::Text(text) if text.contains(r#""type":"answer""#) => break text,
                // News of the block, as every viewer gets them.
                _ => {}
            }
        };
        durations.push(u64::try_from(since.elapsed().as_nanos()).unwrap_or(u64::MAX));
        assert!(answer.contains(r#""Q":true"#), "{answer}");
    }
    durations.sort_unstable();
    durations
}
