//! Targets in a process of their own.

use std::io::{BufRead as _, BufReader, Write as _};
use std::net::{Ipv4Addr, SocketAddr};
use std::process::{Child, Command, Stdio};

use cipdeck_shared::sim::SimProfile;
use cipdeck_tests::peers::CiplinkAdapter;
use clap::ValueEnum;
use tokio::net::TcpListener;

use crate::processor;

/// Whose.
#[derive(Clone, Copy, Debug, PartialEq, Eq, ValueEnum)]
pub(crate) enum Kind {
    /// ciplink's adapter: blocking, a thread per connection.
    Ciplink,
    /// Our simulated device: tokio.
    Simulated,
    /// The same as a Logix with tags.
    Logix,
}

impl Kind {
    /// The name on the command line.
    const fn word(self) -> &'static str {
        match self {
            Self::Ciplink => "ciplink",
            Self::Simulated => "simulated",
            Self::Logix => "logix",
        }
    }
}

/// This process: targets on one processor, until nobody holds its input open any more.
pub(crate) fn serve(kind: Kind, count: usize, on: usize) {
    processor::pin(on);
    match kind {
        Kind::Ciplink => {
            let adapters: Vec<_> = (0..count).map(|_| CiplinkAdapter::start()).collect();
            say_and_wait(adapters.iter().map(CiplinkAdapter::address));
        }
        Kind::Simulated | Kind::Logix => {
            let profile = if kind == Kind::Logix { SimProfile::Logix } else { SimProfile::Generic };
            let runtime =
                tokio::runtime::Builder::new_multi_thread().enable_all().build().expect("a runtime");
            let addresses: Vec<_> = (0..count)
                .map(|_| {
                    let bound = runtime.block_on(TcpListener::bind((Ipv4Addr::LOCALHOST, 0)));
                    let listener = bound.expect("a free port");
                    let address = listener.local_addr().expect("an address");
                    runtime.spawn(cipdeck_relay::simulate(listener, profile.config()));
                    address
                })
                .collect();
            say_and_wait(addresses.into_iter());
            runtime.shutdown_background();
        }
    }
}

fn say_and_wait(addresses: impl Iterator<Item = SocketAddr>) {
    let text: Vec<_> = addresses.map(|address| address.to_string()).collect();
    println!("{}", text.join(" "));
    std::io::stdout().flush().expect("somebody reads");
    let _ = std::io::stdin().read_line(&mut String::new());
}

/// A process of targets; it ends when it is dropped.
#[derive(Debug)]
pub(crate) struct Targets {
    child: Child,
    /// Where they listen.
    pub(crate) addresses: Vec<SocketAddr>,
}

impl Targets {
    /// Starts them on a processor.
    pub(crate) fn start(kind: Kind, count: usize, on: usize) -> Self {
        let program = std::env::current_exe().expect("this program");
        let mut child = Command::new(program)
            .args(["target", kind.word(), &count.to_string(), &on.to_string()])
            .stdin(Stdio::piped())
            .stdout(Stdio::piped())
            .spawn()
            .expect("this program starts again");
        let mut line = String::new();
        let out = child.stdout.take().expect("its output");
        BufReader::new(out).read_line(&mut line).expect("a line");
        let addresses = line.split_whitespace().map(|word| word.parse().expect("an address")).collect();
        Self { child, addresses }
    }
}

impl Drop for Targets {
    fn drop(&mut self) {
        drop(self.child.stdin.take());
        let _ = self.child.wait();
    }
}
