//! `cipdeck --relay https://HOST:PORT run FILE`: the relay sends, and decides whether it may.

mod client;
mod trust;

use std::path::PathBuf;

use cipdeck_shared::api::{BlockStatus, WriteTicket};
use cipdeck_shared::config::{Block, BlockConfig, read_hex};
use cipdeck_shared::plan::MessagePlan;
use clap::Args;

use self::client::{Client, Failed};
use super::once::{Mode, show};
use super::report::{self, Report};
use super::{Exit, say};
use crate::shutdown;

/// These are seen in the help of every command.
const HEADING: &str = "Another relay, for run";

/// Which relay, and how it is known and knows us.
#[derive(Clone, Debug, Args)]
pub(super) struct Remote {
    /// Let a relay send, with `run`: https://HOST:PORT; plain http only on this machine
    #[arg(long, global = true, help_heading = HEADING, value_name = "URL")]
    relay: Option<String>,
    /// File with an API token of the relay; without it the environment's CIPDECK_TOKEN
    #[arg(long, global = true, help_heading = HEADING, value_name = "FILE")]
    token_file: Option<PathBuf>,
    /// SHA-256 of the relay's certificate, for one that it has made for itself: as `cipdeck serve` prints it
    #[arg(long, global = true, help_heading = HEADING, value_name = "SHA256")]
    fingerprint: Option<String>,
}

impl Remote {
    /// Whether a relay was named, or anything about one.
    pub(super) const fn is_given(&self) -> bool {
        self.relay.is_some() || self.token_file.is_some() || self.fingerprint.is_some()
    }

    /// Stores the block, runs it, and deletes it again, whatever happens in between.
    pub(super) async fn run(&self, config: &BlockConfig, mode: &Mode) -> Exit {
        if mode.records() {
            return Exit::usage(
                &"--pcap records what goes over the sockets of this machine: leave out --relay",
            );
        }
        let (plan, findings) = MessagePlan::check(config);
        report::findings(&findings);
        let Some(plan) = plan else {
            if mode.json() {
                say(&report::checked(None, &findings));
            }
            return Exit::FINDINGS;
        };
        let client = match Client::new(self) {
            Ok(client) => client,
            Err(why) => return Exit::usage(&why),
        };
        let block = match client.create(config).await {
            Ok(block) => block,
            Err(failed) => return failed.exit(),
        };
        let may_write = plan.access().may_write();
        let exit = tokio::select! {
            exit = repeat(&client, &block, may_write, mode) => exit.unwrap_or_else(|failed| failed.exit()),
            () = shutdown::requested() => {
                Exit::interrupted(&"interrupted; what had been sent may have been carried out")
            }
        };
        // It is cancelled by that, too.
        if let Err(failed) = client.delete(&block).await {
            eprintln!("cipdeck: the block {} is still stored in the relay: {failed}", block.id);
        }
        exit
    }
}

async fn repeat(client: &Client, block: &Block, may_write: bool, mode: &Mode) -> Result<Exit, Failed> {
    let mut exit = Exit::SUCCESS;
    for number in mode.numbers() {
        let ticket = if may_write { Some(offered(client, block).await?) } else { None };
        let status = client.run(block, ticket).await?;
        print(client, block, &status, mode, number).await?;
        if exit == Exit::SUCCESS {
            exit = Exit::message(&status.status);
        }
    }
    Ok(exit)
}

/// The relay shows what will be overwritten. Whoever types the command has seen what it sends.
async fn offered(client: &Client, block: &Block) -> Result<String, Failed> {
    let WriteTicket { ticket, old, no_old, new, .. } = client.offer(block).await?;
    if let Some(new) = new {
        let over = match (old, no_old) {
            (Some(old), _) => format!(" over {}", old.text),
            (None, Some(why)) => format!(" (what is there cannot be read: {why})"),
            (None, None) => String::new(),
        };
        eprintln!("writes {}{over}", new.text);
    }
    Ok(ticket)
}

async fn print(
    client: &Client,
    block: &Block,
    status: &BlockStatus,
    mode: &Mode,
    number: u64,
) -> Result<(), Failed> {
    let bytes = |text: &str| read_hex(text).unwrap_or_default();
    let response = client.last_response(block).await?;
    let report = Report::new(
        status,
        &bytes(&status.request),
        response.as_deref().map(bytes).as_deref(),
        &block.config,
    );
    show(&report, &block.config, mode, number);
    if let Some(written) = &status.written
        && let Some(read_back) = &written.read_back
    {
        let verdict = if written.is_equal == Some(false) { ": not what was written" } else { "" };
        eprintln!("read back {}{verdict}", read_back.text);
    }
    Ok(())
}
