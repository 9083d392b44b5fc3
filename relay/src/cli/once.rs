//! Runs one block from here, once or several times, with the runner that the relay uses.

use std::path::PathBuf;
use std::sync::Arc;

use cipdeck_shared::config::BlockConfig;
use cipdeck_shared::plan::MessagePlan;
use clap::Args;

use super::report::{self, Report};
use super::{Exit, say};
use crate::capture::Recorder;
use crate::client::{Answer, Client, Message};
use crate::runner::Tap;
use crate::shutdown;

/// How often, and how it is printed.
#[derive(Clone, Debug, Args)]
pub(super) struct Mode {
    /// Run N times, one line each; goes on after failures and exits as the first failure does
    #[arg(long, value_name = "N", value_parser = clap::value_parser!(u64).range(1..))]
    repeat: Option<u64>,
    /// For machines: block status, request, response and decoded values, one JSON object a line
    #[arg(long)]
    json: bool,
    /// Record everything that goes over the sockets, for Wireshark (pcapng). A file of that name is replaced. The
    /// bytes and the times are the real ones; the TCP packets around them are made up
    #[arg(long, value_name = "FILE")]
    pcap: Option<PathBuf>,
}

impl Mode {
    /// Whether a recording of the sockets is wanted.
    pub(super) const fn records(&self) -> bool {
        self.pcap.is_some()
    }

    /// Whether machines read what is printed.
    pub(super) const fn json(&self) -> bool {
        self.json
    }

    /// The numbers of the runs.
    pub(super) fn numbers(&self) -> std::ops::RangeInclusive<u64> {
        1..=self.repeat.unwrap_or(1)
    }
}

/// Runs what can be run and prints it.
pub(super) async fn execute(config: &BlockConfig, mode: &Mode) -> Exit {
    let (plan, findings) = MessagePlan::check(config);
    report::findings(&findings);
    let Some(plan) = plan else {
        if mode.json {
            say(&report::checked(None, &findings));
        }
        return Exit::FINDINGS;
    };
    let recorder = match mode.pcap.as_deref().map(Recorder::create).transpose() {
        Ok(recorder) => recorder.map(Arc::new),
        Err(error) => return Exit::internal(&error),
    };
    let client = Client::tapped(recorder.clone().map(|tap| tap as Arc<dyn Tap>));
    let mut message = client.planned(plan);
    let exit = tokio::select! {
        exit = repeat(&mut message, config, mode) => exit,
        // What is under way is cancelled by stopping: nobody waits for its answer.
        () = shutdown::requested() => Exit::interrupted(&"interrupted; what had been sent may have been carried out"),
    };
    client.stop().await;
    match recorder.map_or(Ok(()), |recorder| recorder.complete()) {
        Ok(()) => exit,
        Err(error) => {
            eprintln!("cipdeck: {error}");
            if exit == Exit::SUCCESS { Exit::INCOMPLETE } else { exit }
        }
    }
}

async fn repeat(message: &mut Message, config: &BlockConfig, mode: &Mode) -> Exit {
    let mut exit = Exit::SUCCESS;
    for number in mode.numbers() {
        // Whoever types the command has seen what it sends.
        let answer = match message.run().await {
            Ok(answer) => answer,
            Err(error) => return Exit::internal(&format!("the message could not be started: {error}")),
        };
        print(&answer, config, mode, number);
        if exit == Exit::SUCCESS {
            exit = Exit::message(&answer.view.status);
        }
    }
    exit
}

fn print(answer: &Answer, config: &BlockConfig, mode: &Mode, number: u64) {
    let status = answer.status();
    let exchange = &answer.exchange;
    show(&Report::new(&status, &exchange.request, exchange.response(), config), config, mode, number);
}

/// Prints how a run has ended.
pub(super) fn show(report: &Report<'_>, config: &BlockConfig, mode: &Mode, number: u64) {
    match (mode.json, mode.repeat) {
        (true, _) => say(&report.json()),
        (false, Some(_)) => say(&format!("{number:>4}  {}", report.line())),
        (false, None) => say(&report.text(config)),
    }
    if mode.json && report.is_error() {
        eprintln!("{}", report.line());
    }
}
