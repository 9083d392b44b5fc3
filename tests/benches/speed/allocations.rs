//! How many allocations a message costs, and how many bytes: ours beside the others, one session, steady state.
//!
//! A program of its own, because counting makes allocations slower.

#[expect(dead_code, reason = "nothing here needs the time, or goes elsewhere")]
mod processor;
mod sessions;
mod target;
mod way;

use std::alloc::System;
use std::fmt::Write as _;
use std::net::SocketAddr;

use clap::{Parser, Subcommand};
use stats_alloc::{INSTRUMENTED_SYSTEM, Region, Stats, StatsAlloc};

use self::sessions::{Ciplink, Session, ours, rseip};
use self::target::{Kind, Targets};
use self::way::{Sender, Way, number};

#[global_allocator]
static COUNTED: &StatsAlloc<System> = &INSTRUMENTED_SYSTEM;

#[derive(Debug, Parser)]
struct Cli {
    /// What `cargo bench` adds.
    #[arg(long, hide = true, global = true)]
    bench: bool,
    /// Where the table is written.
    #[arg(long)]
    out: Option<std::path::PathBuf>,
    #[command(subcommand)]
    command: Option<Command>,
}

#[derive(Debug, Subcommand)]
enum Command {
    /// Targets on one processor until the input ends.
    Target { kind: Kind, count: usize, processor: usize },
}

/// Before anything counts.
const WARM_UP: u32 = 1_000;

/// Messages that count.
const MESSAGES: u32 = 10_000;

fn main() {
    let cli = Cli::parse();
    if let Some(Command::Target { kind, count, processor }) = cli.command {
        return target::serve(kind, count, processor);
    }
    let targets = Targets::start(Kind::Ciplink, 1, 0);
    let target = *targets.addresses.first().expect("one target");
    let mut text = format!(
        "### Allocations per message\n\nOne session, mean of {MESSAGES} messages after {WARM_UP}; a reallocation \
         counts as one.\n\n| message | client | allocations | bytes |\n| --- | --- | ---: | ---: |\n"
    );
    for way in Way::ALL {
        for sender in Sender::ALL {
            let stats = count(sender, way, target);
            let each = |value: usize| number(value) / f64::from(MESSAGES);
            let _ = writeln!(
                text,
                "| {} | {} | {:.1} | {:.0} |",
                way.name(),
                sender.name(),
                each(stats.allocations + stats.reallocations),
                each(stats.bytes_allocated),
            );
        }
    }
    println!("{text}");
    if let Some(folder) = cli.out {
        std::fs::create_dir_all(&folder).expect("a folder");
        std::fs::write(folder.join("allocations.md"), text).expect("a file");
    }
}

fn count(sender: Sender, way: Way, target: SocketAddr) -> Stats {
    let targets = vec![target];
    let runtime = tokio::runtime::Builder::new_current_thread().enable_all().build().expect("a runtime");
    match sender {
        Sender::Ours => runtime.block_on(async { repeat(ours(way, targets).await).await }),
        Sender::Rseip => runtime.block_on(async { repeat(rseip(way, targets).await).await }),
        Sender::Ciplink => {
            let session = Ciplink::open(way, target);
            (0..WARM_UP).for_each(|_| session.ask());
            let region = Region::new(COUNTED);
            (0..MESSAGES).for_each(|_| session.ask());
            let stats = region.change();
            session.close();
            stats
        }
    }
}

async fn repeat(mut sessions: Vec<impl Session>) -> Stats {
    let session = sessions.first_mut().expect("one session");
    for _ in 0..WARM_UP {
        session.ask().await;
    }
    let region = Region::new(COUNTED);
    for _ in 0..MESSAGES {
        session.ask().await;
    }
    let stats = region.change();
    for session in sessions {
        session.close().await;
    }
    stats
}
