//! How fast: our client beside others on the same targets, through the relay, and 1,000 cyclic blocks.
//!
//! Run by `cargo xtask bench`; docs/PERFORMANCE.md says how the numbers are made. This program starts itself again
//! for each target and for each measurement, so that every client begins afresh and on the processor it is given.

mod compare;
mod cyclic;
mod history;
mod load;
mod plant;
mod processor;
mod relay;
mod senders;
mod sessions;
mod tags;
mod target;
mod way;

use std::net::SocketAddr;
use std::path::PathBuf;

use clap::{Parser, Subcommand};

use self::load::Load;
use self::way::Sender;

#[derive(Debug, Parser)]
struct Cli {
    /// What `cargo bench` adds.
    #[arg(long, hide = true, global = true)]
    bench: bool,
    #[command(subcommand)]
    command: Command,
}

#[derive(Debug, Subcommand)]
enum Command {
    /// Everything; prints tables.
    All {
        /// Fewer and shorter rounds: good for a look, not for a document.
        #[arg(long)]
        quick: bool,
        /// Only tables whose name contains this.
        #[arg(long, default_value = "")]
        only: String,
        /// Where the tables are written.
        #[arg(long)]
        out: Option<PathBuf>,
    },
    /// Targets on one processor until the input ends.
    Target { kind: target::Kind, count: usize, processor: usize },
    /// One measurement on one processor.
    Send {
        sender: Sender,
        processor: usize,
        #[command(flatten)]
        load: Load,
    },
    /// Reads tags of one target; the processor is the caller's.
    Read { reader: tags::Reader, target: SocketAddr, warm_up: u64, measure: u64 },
    /// A relay on one processor until the input ends.
    Relay {
        processor: usize,
        /// Keeps no history.
        #[arg(long)]
        no_history: bool,
    },
}

fn main() {
    match Cli::parse().command {
        Command::All { quick, only, out } => all(quick, &only, out),
        Command::Target { kind, count, processor } => target::serve(kind, count, processor),
        Command::Send { sender, processor, load } => {
            processor::pin(processor);
            println!("{}", serde_json::to_string(&senders::run(sender, &load)).expect("numbers"));
        }
        Command::Read { reader, target, warm_up, measure } => {
            let reads = tags::read(reader, target, warm_up, measure);
            println!("{}", serde_json::to_string(&reads).expect("numbers"));
        }
        Command::Relay { processor, no_history } => relay::serve(processor, !no_history),
    }
}

fn all(quick: bool, only: &str, out: Option<PathBuf>) {
    let mut text = String::new();
    let mut add = |name: &str, make: &dyn Fn(bool) -> String| {
        if name.contains(only) {
            let table = make(quick);
            println!("{table}");
            text.push_str(&table);
            text.push('\n');
        }
    };
    add("peers", &|quick| compare::table(target::Kind::Ciplink, quick));
    add("simulated", &|quick| compare::table(target::Kind::Simulated, quick));
    add("websocket", &relay::table);
    add("history", &history::table);
    add("cyclic", &cyclic::table);
    add("tags", &tags::table);
    add("plant", &plant::table);
    if let Some(folder) = out {
        std::fs::create_dir_all(&folder).expect("a folder");
        std::fs::write(folder.join("speed.md"), text).expect("a file");
    }
}
