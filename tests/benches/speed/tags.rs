//! 1,000 DINTs of one device, read as often as it answers: our poller beside `rseip` and pycomm3.

use std::fmt::Write as _;
use std::net::SocketAddr;
use std::process::{Command, Stdio};
use std::time::{Duration, Instant};

use cipdeck_relay::client::Client;
use cipdeck_shared::config::{Profile, TargetPath};
use cipdeck_shared::engine::poll::{DeviceLimits, Group, Item, Poller, Quality};
use cipdeck_shared::engine::time::{Instant as PollInstant, Millis};
use cipdeck_shared::plan::{MessagePlan, TagWay};
use cipdeck_shared::tag::Dialect;
use cipdeck_shared::wire::MessageRouterRequest;
use cipdeck_tests::tools;
use clap::ValueEnum;
use rseip::cip::{MessageReply, MessageRequest, epath};
use rseip::client::EipConnection;
use rseip::client::OpenOptions;
use rseip::client::ab_eip::{PathParser as _, SERVICE_READ_TAG, TagValue};
use rseip::precludes::{CommonServices as _, MessageService as _};
use serde::{Deserialize, Serialize};

use crate::load::median;
use crate::processor;
use crate::target::{Kind, Targets};
use crate::way::number;

/// Who reads, and how.
#[derive(Clone, Copy, Debug, PartialEq, Eq, ValueEnum)]
pub(crate) enum Reader {
    /// Our poller over a connection of 4,002 bytes.
    Connected,
    /// Our poller without a connection: 504 bytes.
    Unconnected,
    /// `rseip` over its connection of 504 bytes, 35 questions in a message.
    Rseip,
    /// pycomm3 over its connection of 4,000 bytes; it knows the tags by their numbers.
    Pycomm3,
}

impl Reader {
    const ALL: [Self; 4] = [Self::Connected, Self::Unconnected, Self::Rseip, Self::Pycomm3];

    const fn name(self) -> &'static str {
        match self {
            Self::Connected => "cipdeck, class 3, 4,002 bytes",
            Self::Unconnected => "cipdeck, unconnected, 504 bytes",
            Self::Rseip => "rseip, class 3, 504 bytes",
            Self::Pycomm3 => "pycomm3, class 3, 4,000 bytes",
        }
    }
}

/// What came of it.
#[derive(Clone, Copy, Debug, Serialize, Deserialize)]
pub(crate) struct Reads {
    requests_per_cycle: f64,
    values_per_second: f64,
    /// Of the client, µs per value.
    cpu: f64,
}

/// How many tags there are. The simulated Logix has them.
const TAGS: u32 = 1_000;

/// What `rseip` packs: 14 bytes of a question in what 504 bytes leave.
const RSEIP_PACKET: usize = 35;

/// How long, ms.
#[derive(Clone, Copy, Debug)]
struct Effort {
    rounds: usize,
    warm_up: u64,
    measure: u64,
}

/// Measures all, in turns, on the same target.
pub(crate) fn table(quick: bool) -> String {
    let effort = if quick {
        Effort { rounds: 3, warm_up: 200, measure: 500 }
    } else {
        Effort { rounds: 9, warm_up: 300, measure: 1_000 }
    };
    let targets = Targets::start(Kind::Logix, 1, 0);
    let target = *targets.addresses.first().expect("one target");
    let there = std::thread::available_parallelism().map_or(1, usize::from);
    let mut text = format!(
        "### {TAGS} DINTs of one simulated Logix\n\nMedian of {} rounds of {} ms each, taken in turns. Ratio: to the \
         better of the others.\n\n\
         | client | processors | requests per cycle | values/s | client CPU µs per value | ratio |\n\
         | --- | ---: | ---: | ---: | ---: | ---: |\n",
        effort.rounds, effort.measure
    );
    for processor in 0..=usize::from(there > 1) {
        rows(&mut text, target, processor, effort);
    }
    text
}

fn rows(text: &mut String, target: SocketAddr, processor: usize, effort: Effort) {
    let mut samples: [Vec<Reads>; 4] = Default::default();
    for _ in 0..effort.rounds {
        for (reader, samples) in Reader::ALL.into_iter().zip(&mut samples) {
            samples.extend(measure(reader, target, processor, effort));
        }
    }
    let middle = |samples: &[Reads], value: fn(&Reads) -> f64| median(samples.iter().map(value));
    let rates = samples.each_ref().map(|samples| middle(samples, |it| it.values_per_second));
    let [.., rseip, pycomm3] = rates;
    let best = rseip.max(pycomm3);
    for ((reader, samples), rate) in Reader::ALL.into_iter().zip(&samples).zip(rates) {
        let ratio = match reader {
            _ if samples.is_empty() => "failed".to_owned(),
            Reader::Connected | Reader::Unconnected if best > 0.0 => format!("**{:.2}**", rate / best),
            _ => String::new(),
        };
        let _ = writeln!(
            text,
            "| {} | {} | {:.1} | {rate:.0} | {:.2} | {ratio} |",
            reader.name(),
            processor + 1,
            middle(samples, |it| it.requests_per_cycle),
            middle(samples, |it| it.cpu),
        );
    }
}

/// In a process of its own; nothing when that fails, having said why.
fn measure(reader: Reader, target: SocketAddr, on: usize, effort: Effort) -> Option<Reads> {
    let times = [effort.warm_up.to_string(), effort.measure.to_string()];
    let mut command = if reader == Reader::Pycomm3 {
        let script = concat!(env!("CARGO_MANIFEST_DIR"), "/python/pycomm3_speed.py");
        let mut command = Command::new(tools::tags_python());
        command.arg(script).arg(target.to_string()).arg(TAGS.to_string());
        command
    } else {
        let word = reader.to_possible_value().map_or_else(String::new, |value| value.get_name().to_owned());
        let mut command = Command::new(std::env::current_exe().expect("this program"));
        command.args(["read", &word, &target.to_string()]);
        command
    };
    command.args(times).stderr(Stdio::inherit());
    // The child inherits the processor.
    let anywhere = processor::pin(on);
    let output = command.output().expect("it starts");
    processor::unpin(&anywhere);
    serde_json::from_slice(&output.stdout).ok().filter(|_| output.status.success())
}

/// This process: one measurement.
pub(crate) fn read(reader: Reader, target: SocketAddr, warm_up: u64, measure: u64) -> Reads {
    let (warm_up, measure) = (Duration::from_millis(warm_up), Duration::from_millis(measure));
    let runtime = tokio::runtime::Builder::new_multi_thread().enable_all().build().expect("a runtime");
    // A task, as the relay has one for each device: what it waits for is woken beside it.
    let reading = runtime.spawn(async move {
        match reader {
            Reader::Connected | Reader::Unconnected => {
                ours(target, reader == Reader::Connected, warm_up, measure).await
            }
            Reader::Rseip => rseip(target, warm_up, measure).await,
            Reader::Pycomm3 => panic!("pycomm3 is a program of its own"),
        }
    });
    runtime.block_on(reading).expect("it ends well")
}

/// Counts from the end of the warm-up on.
struct Count {
    begun: Instant,
    cpu: Duration,
    cycles: u64,
    requests: u64,
}

impl Count {
    fn begin() -> Self {
        Self { begun: Instant::now(), cpu: processor::time(), cycles: 0, requests: 0 }
    }

    fn end(&self) -> Reads {
        let values = number(self.cycles * u64::from(TAGS));
        Reads {
            requests_per_cycle: number(self.requests) / number(self.cycles),
            values_per_second: values / self.begun.elapsed().as_secs_f64(),
            cpu: processor::time().saturating_sub(self.cpu).as_secs_f64() * 1e6 / values,
        }
    }
}

async fn ours(target: SocketAddr, connected: bool, warm_up: Duration, measure: Duration) -> Reads {
    let path: TargetPath = format!("4,{target}").parse().expect("a path");
    let way = TagWay { path, profile: Profile::Logix, connected, timeout_ms: 3_000 };
    let client = Client::start();
    let mut poller = Poller::new(DeviceLimits::of(Dialect::Logix, connected));
    let items =
        (0..TAGS).map(|id| Item { id, name: name(id).parse().expect("a name"), kind: None }).collect();
    // The poller's time is not the clock's: the next period begins when the last cycle is done.
    let mut now = PollInstant(0);
    poller.put_group(Group { id: 1, period: Millis(1), on: true, items }, now);
    let (start, mut count) = (Instant::now(), None);
    // A session ends with the last message that uses it: the one before stays until the next is there.
    let mut before = None;
    loop {
        while let Some(request) = poller.poll_request(now) {
            let request = MessageRouterRequest::decode(&request.bytes).expect("a request");
            let plan = MessagePlan::tag(&way, request).expect("a message");
            let mut message = client.planned(plan);
            let answer = message.run().await.expect("it is started");
            drop(before.replace(message));
            let reply = answer.exchange.response().expect("a reply");
            poller.handle_reply(now, Ok(reply));
            if let Some(Count { requests, .. }) = &mut count {
                *requests += 1;
            }
        }
        let mut good = 0;
        while let Some((_, item)) = poller.poll_change() {
            good += u32::from(poller.reading(item).is_some_and(|it| it.quality == Quality::Good));
        }
        assert_eq!(good, TAGS, "all are good");
        now = poller.poll_timeout().expect("a next period");
        match &mut count {
            None if start.elapsed() >= warm_up => count = Some(Count::begin()),
            None => {}
            Some(count) => {
                count.cycles += 1;
                if count.begun.elapsed() >= measure {
                    let reads = count.end();
                    client.stop().await;
                    return reads;
                }
            }
        }
    }
}

async fn rseip(target: SocketAddr, warm_up: Duration, measure: Duration) -> Reads {
    let SocketAddr::V4(address) = target else { panic!("rseip has IPv4 only") };
    let router = epath::EPath::from(vec![epath::Segment::Class(2), epath::Segment::Instance(1)]);
    // Its own interval is 17 ms: a pause of the machine would end the connection.
    let options = OpenOptions::default().connection_path(router).o_t_rpi(2_000_000).t_o_rpi(2_000_000);
    let mut connection = EipConnection::new(address, options);
    let names: Vec<_> = (0..TAGS).map(|id| epath::EPath::parse_tag(name(id)).expect("a path")).collect();
    let (start, mut count) = (Instant::now(), None);
    loop {
        let mut good = 0;
        for packet in names.chunks(RSEIP_PACKET) {
            let parts = packet.iter().map(|path| MessageRequest::new(SERVICE_READ_TAG, path.clone(), 1_u16));
            let mut replies = connection.multiple_service().push_all(parts).call().await.expect("a reply");
            while let Some(reply) = replies.next() {
                let reply: MessageReply<TagValue<i32>> = reply.expect("a part of a reply");
                assert!(!reply.status.is_err(), "{}", reply.status);
                std::hint::black_box(reply.data.value);
                good += 1;
            }
            if let Some(Count { requests, .. }) = &mut count {
                *requests += 1;
            }
        }
        assert_eq!(good, TAGS, "all are good");
        match &mut count {
            None if start.elapsed() >= warm_up => count = Some(Count::begin()),
            None => {}
            Some(count) => {
                count.cycles += 1;
                if count.begun.elapsed() >= measure {
                    let reads = count.end();
                    connection.close().await.expect("rseip closes");
                    return reads;
                }
            }
        }
    }
}

fn name(id: u32) -> String {
    format!("D{id:04}")
}
