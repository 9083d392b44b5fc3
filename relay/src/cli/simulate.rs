//! `cipdeck simulate`.

use std::fs;
use std::net::{IpAddr, SocketAddr};
use std::path::{Path, PathBuf};
use std::sync::{Arc, Mutex};

use cipdeck_shared::engine::Millis;
use cipdeck_shared::sim::{Device, Fault, Quirk, Registers, SimConfig, SimProfile, TagMemory, Tags};
use cipdeck_shared::wire::SocketAddress;
use clap::Args;
use tokio::net::{TcpListener, UdpSocket};

use super::{Exit, say};
use crate::runner::{Clock, lock};
use crate::{shutdown, simulate};

/// The flags of `simulate`.
#[derive(Debug, Args)]
pub(super) struct Simulate {
    /// Address and port, TCP and UDP; port 0 takes a free one. It listens where it is told to: a simulated device has
    /// nothing to protect.
    #[arg(long, value_name = "ADDRESS:PORT", default_value = "127.0.0.1:44818")]
    listen: SocketAddr,
    /// What kind of device: generic (a drive in a chassis), or a controller with tags: micro800, logix, omron
    #[arg(long, value_name = "KIND", default_value_t)]
    profile: SimProfile,
    /// The controller's tags, as JSON, instead of the usual ones: see docs/SIMULATOR.md
    #[arg(long, value_name = "FILE")]
    tags: Option<PathBuf>,
    /// From a request to its reply.
    #[arg(long, value_name = "MS", default_value_t = 0)]
    delay: u32,
    /// What goes wrong: the first reply suffers the first, and so on, round and round. One of ok, drop, half-frame,
    /// wrong-context, wrong-session, wrong-service, wrong-connection-id, wrong-sequence, garbage, close, status=N
    /// (encapsulation), error=N (general).
    #[arg(long = "fault", value_name = "KIND")]
    faults: Vec<Fault>,
    /// What it always does differently: no-context (sender context 0 in every reply) or own-connection-id (connected
    /// replies carry the id of the request).
    #[arg(long = "quirk", value_name = "KIND")]
    quirks: Vec<Quirk>,
    /// How many class 3 connections can be open at once
    #[arg(long, value_name = "N", default_value_t = SimConfig::default().max_connections)]
    max_connections: usize,
    /// Longest connected message, with its sequence count; Forward_Open alone cannot say more than 511. 4002, or 1994
    /// of an Omron
    #[arg(long, value_name = "BYTES")]
    connection_size: Option<u16>,
    /// It does not know Large_Forward_Open
    #[arg(long)]
    no_large: bool,
}

impl Simulate {
    /// Runs until the process is asked to stop; then it says in one line what it has done.
    pub(super) async fn execute(self) -> Exit {
        let shutdown = shutdown::requested();
        let tags = match self.tags.as_deref().map(|file| read_tags(self.profile, file)).transpose() {
            Ok(tags) => tags,
            Err(why) => return Exit::usage(&why),
        };
        let (tcp, udp) = match bind(self.listen).await {
            Ok(sockets) => sockets,
            Err(error) => return Exit::internal(&format!("cannot listen on {}: {error}", self.listen)),
        };
        let address = tcp.local_addr().unwrap_or(self.listen);
        let usual = self.profile.config();
        let config = SimConfig {
            address: socket_address(address),
            delay: Millis::from(self.delay),
            faults: self.faults,
            quirks: self.quirks,
            max_connections: self.max_connections,
            max_size: self.connection_size.unwrap_or(usual.max_size),
            large: !self.no_large,
            tags: tags.or(usual.tags),
            registers: Some(Registers::default()),
            ..usual
        };
        let clock = Clock::start();
        let device = Arc::new(Mutex::new(Device::new(config)));
        say(&format!("cipdeck simulates a device on {address} (TCP and UDP)"));
        tokio::select! {
            () = simulate::answer_tcp(tcp, Arc::clone(&device), clock) => {}
            () = simulate::answer_udp(udp, Arc::clone(&device)) => {}
            () = shutdown => {}
        }
        let counters = {
            let mut device = lock(&device);
            device.handle_timeout(clock.now());
            device.counters()
        };
        say(&counters.to_string());
        Exit::SUCCESS
    }
}

/// The tags of a file, or a sentence that says what is wrong with them.
fn read_tags(profile: SimProfile, file: &Path) -> Result<Tags, String> {
    let dialect = profile.dialect().ok_or("--tags needs --profile micro800, logix or omron")?;
    let shown = file.display();
    let text = fs::read_to_string(file).map_err(|error| format!("cannot read {shown}: {error}"))?;
    let memory = TagMemory::from_json(dialect, &text).map_err(|error| format!("{shown}: {error}"))?;
    Ok(memory.into())
}

/// How often a free TCP port may turn out to be taken on UDP.
const ATTEMPTS: usize = 16;

/// The same port on TCP and UDP.
async fn bind(listen: SocketAddr) -> std::io::Result<(TcpListener, UdpSocket)> {
    let mut attempt = 0;
    loop {
        attempt += 1;
        let tcp = TcpListener::bind(listen).await?;
        match UdpSocket::bind(tcp.local_addr()?).await {
            Ok(udp) => return Ok((tcp, udp)),
            Err(_) if listen.port() == 0 && attempt < ATTEMPTS => {}
            Err(error) => return Err(error),
        }
    }
}

/// `ListIdentity` has IPv4 only.
fn socket_address(address: SocketAddr) -> SocketAddress {
    let ip = match address.ip() {
        IpAddr::V4(ip) => ip.octets(),
        IpAddr::V6(ip) => ip.to_ipv4().map_or([127, 0, 0, 1], |ip| ip.octets()),
    };
    SocketAddress::v4(ip, address.port())
}
