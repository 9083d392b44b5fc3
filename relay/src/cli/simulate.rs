//! `cipdeck simulate`.

use std::net::{IpAddr, SocketAddr};
use std::sync::{Arc, Mutex};

use cipdeck_shared::engine::Millis;
use cipdeck_shared::sim::{Device, Fault, SimConfig};
use cipdeck_shared::wire::SocketAddress;
use clap::Args;
use tokio::net::{TcpListener, UdpSocket};

use super::{Exit, say};
use crate::runner::Clock;
use crate::{shutdown, simulate};

/// The flags of `simulate`.
#[derive(Debug, Args)]
pub(super) struct Simulate {
    /// Address and port, TCP and UDP; port 0 takes a free one. It listens where it is told to: a simulated device has
    /// nothing to protect.
    #[arg(long, value_name = "ADDRESS:PORT", default_value = "127.0.0.1:44818")]
    listen: SocketAddr,
    /// From a request to its reply.
    #[arg(long, value_name = "MS", default_value_t = 0)]
    delay: u32,
    /// What goes wrong: the first reply suffers the first, and so on, round and round. One of ok, drop, half-frame,
    /// wrong-context, wrong-session, wrong-service, garbage, close, status=N (encapsulation), error=N (general).
    #[arg(long = "fault", value_name = "KIND")]
    faults: Vec<Fault>,
}

impl Simulate {
    /// Runs until the process is asked to stop.
    pub(super) async fn execute(self) -> Exit {
        let shutdown = shutdown::requested();
        let (tcp, udp) = match bind(self.listen).await {
            Ok(sockets) => sockets,
            Err(error) => return Exit::internal(&format!("cannot listen on {}: {error}", self.listen)),
        };
        let address = tcp.local_addr().unwrap_or(self.listen);
        let config = SimConfig {
            address: socket_address(address),
            delay: Millis::from(self.delay),
            faults: self.faults,
            ..SimConfig::default()
        };
        let device = Arc::new(Mutex::new(Device::new(config)));
        say(&format!("cipdeck simulates a device on {address} (TCP and UDP)"));
        tokio::select! {
            () = simulate::answer_tcp(tcp, Arc::clone(&device), Clock::start()) => {}
            () = simulate::answer_udp(udp, device) => {}
            () = shutdown => {}
        }
        Exit::SUCCESS
    }
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
