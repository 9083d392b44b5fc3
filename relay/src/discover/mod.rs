//! Who is on the network: asks with `ListIdentity` over UDP and collects who answers.
//!
//! One datagram of 24 bytes goes to each address. Without addresses that is the broadcast address of each of the
//! machine's own IPv4 networks, sent from the address that the machine has there. No other network's broadcast address
//! and no multicast address is ever sent to.

mod collect;
mod destination;
mod network;

use std::hash::{BuildHasher, RandomState};
use std::io;
use std::net::{Ipv4Addr, SocketAddr, SocketAddrV4};
use std::time::Duration;

use cipdeck_shared::api::Discovered;
use cipdeck_shared::wire::{Command, Encapsulation, Header, SenderContext, SessionHandle};
use tokio::net::UdpSocket;
use tokio::sync::mpsc;
use tokio::task::JoinSet;
use tokio::time::Instant;

use self::collect::Collector;
use self::destination::Destination;
pub(crate) use self::destination::{AddressError, EXPLICIT_PORT};
use self::network::Network;

/// How long to wait for answers, in ms.
pub(crate) const TIMEOUT: std::ops::RangeInclusive<u64> = 100..=10_000;

/// Without a wish.
pub(crate) const DEFAULT_TIMEOUT: u64 = 1_000;

/// Addresses of one search.
const MAX_ADDRESSES: usize = 256;

/// A search that may be made.
#[derive(Clone, Debug)]
pub(crate) struct Search {
    destinations: Vec<Destination>,
    elsewhere: Vec<SocketAddrV4>,
    timeout: Duration,
}

/// Why a search is not made: nothing has been sent.
#[derive(Debug, thiserror::Error)]
pub(crate) enum SearchError {
    /// One of the addresses cannot be asked.
    #[error("{0}")]
    Address(#[from] AddressError),
    /// Too much at once.
    #[error("{0} addresses are too many: at most {MAX_ADDRESSES} at once")]
    TooMany(usize),
    /// A wait that makes no sense.
    #[error("timeout_ms is {0}, but must be {min} to {max}", min = TIMEOUT.start(), max = TIMEOUT.end())]
    Timeout(u64),
    /// The system does not say which addresses it has.
    #[error("the machine's own addresses cannot be read: {0}")]
    Networks(#[source] io::Error),
}

impl Search {
    /// Of these addresses, or of all networks of the machine if there are none.
    pub(crate) fn parse(addresses: &[String], timeout_ms: Option<u64>) -> Result<Self, SearchError> {
        let timeout = timeout_ms.unwrap_or(DEFAULT_TIMEOUT);
        if !TIMEOUT.contains(&timeout) {
            return Err(SearchError::Timeout(timeout));
        }
        if addresses.len() > MAX_ADDRESSES {
            return Err(SearchError::TooMany(addresses.len()));
        }
        let networks = Network::own().map_err(SearchError::Networks)?;
        let destinations: Vec<Destination> = if addresses.is_empty() {
            networks.iter().filter_map(Destination::everybody).collect()
        } else {
            let parse = |address: &String| Destination::parse(address, &networks);
            addresses.iter().map(parse).collect::<Result<_, _>>()?
        };
        let elsewhere = destinations.iter().filter_map(|to| to.elsewhere(&networks)).collect();
        Ok(Self { destinations, elsewhere, timeout: Duration::from_millis(timeout) })
    }

    /// Addresses that are not the usual port of a device in a network of this machine: a relay asks them only where its
    /// lists allow it.
    pub(crate) fn elsewhere(&self) -> &[SocketAddrV4] {
        &self.elsewhere
    }

    /// Asks, and listens until the time is over.
    pub(crate) async fn run(&self) -> Discovered {
        let deadline = Instant::now() + self.timeout;
        let context = context(self.timeout);
        let mut collector = Collector::new(context);
        let (sender, mut heard) = mpsc::channel(64);
        // Dropping it ends the listeners.
        let mut listeners = JoinSet::new();
        let (sockets, mut errors) = self.ask(&request(context)).await;
        for socket in sockets {
            listeners.spawn(listen(socket, sender.clone()));
        }
        drop(sender);
        if listeners.is_empty() {
            // Nobody can answer: there is nothing to wait for.
            return Discovered { devices: Vec::new(), errors };
        }
        while let Ok(Some((from, datagram))) = tokio::time::timeout_at(deadline, heard.recv()).await {
            collector.take(from, &datagram);
            if Instant::now() >= deadline {
                // Whoever never stops talking is not listened to for longer.
                break;
            }
        }
        let devices = collector.finish(&mut errors);
        Discovered { devices, errors }
    }

    /// Sends to all destinations. The sockets on which answers may come, and what went wrong.
    async fn ask(&self, request: &[u8]) -> (Vec<UdpSocket>, Vec<String>) {
        let (mut sockets, mut errors) = (Vec::new(), Vec::new());
        if self.destinations.is_empty() {
            errors.push("this machine has no IPv4 network to broadcast on: name an address".to_owned());
        }
        let mut devices = Vec::new();
        for destination in &self.destinations {
            match destination {
                Destination::Device(address) => devices.push(*address),
                Destination::Network { from, to } => match broadcast(*from, *to, request).await {
                    Ok(socket) => sockets.push(socket),
                    Err(error) => errors.push(format!("{to} from {from}: {error}")),
                },
            }
        }
        if !devices.is_empty() {
            match UdpSocket::bind((Ipv4Addr::UNSPECIFIED, 0)).await {
                Ok(socket) => {
                    for to in devices {
                        if let Err(error) = socket.send_to(request, to).await {
                            errors.push(format!("{to}: {error}"));
                        }
                    }
                    sockets.push(socket);
                }
                Err(error) => errors.push(format!("no UDP socket: {error}")),
            }
        }
        (sockets, errors)
    }
}

/// Sends from the address that the machine has in the network, so that answers come back to it.
async fn broadcast(from: Ipv4Addr, to: SocketAddrV4, request: &[u8]) -> io::Result<UdpSocket> {
    let socket = UdpSocket::bind((from, 0)).await?;
    socket.set_broadcast(true)?;
    socket.send_to(request, to).await?;
    Ok(socket)
}

/// Bytes of one datagram; an answer has at most 321. A longer one is cut, and then makes no sense.
const MAX_DATAGRAM: usize = 1_500;

/// Passes on what arrives until the task is dropped.
async fn listen(socket: UdpSocket, heard: mpsc::Sender<(SocketAddr, Vec<u8>)>) {
    let mut input = [0; MAX_DATAGRAM];
    loop {
        match socket.recv_from(&mut input).await {
            Ok((length, from)) => {
                let datagram = input.get(..length).unwrap_or_default().to_vec();
                if heard.send((from, datagram)).await.is_err() {
                    return;
                }
            }
            Err(error) => {
                // Windows says here that an earlier datagram found no listener; others may still answer.
                tracing::debug!(%error, "cannot receive a datagram");
                tokio::time::sleep(Duration::from_millis(10)).await;
            }
        }
    }
}

/// What is sent: `ListIdentity` without data.
fn request(context: SenderContext) -> Vec<u8> {
    let mut out = Vec::new();
    Encapsulation::empty(Header::request(Command::ListIdentity, SessionHandle(0), context)).encode(&mut out);
    out
}

/// Two bytes say how long a device may wait with its answer (ms), so that not all answer at once: half of the time.
/// The others are any number, to tell our answers from those to somebody else.
fn context(timeout: Duration) -> SenderContext {
    let delay = u16::try_from(timeout.as_millis() / 2).unwrap_or(u16::MAX);
    let mut context = RandomState::new().hash_one(std::process::id()).to_le_bytes();
    let [low, high, ..] = &mut context;
    [*low, *high] = delay.to_le_bytes();
    SenderContext(context)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn one_datagram_of_24_bytes_carries_the_delay_and_a_tag() {
        let context = context(Duration::from_secs(1));
        let request = request(context);
        assert_eq!(request.len(), 24);
        assert_eq!(request[..12], [0x63, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0]);
        assert_eq!(request[12..14], 500_u16.to_le_bytes());
        assert_eq!(request[14..20], context.0[2..]);
    }

    #[test]
    fn what_cannot_be_asked_is_refused_before_anything_is_sent() {
        let refused =
            |addresses: &[String], timeout| Search::parse(addresses, timeout).unwrap_err().to_string();
        assert!(refused(&["224.0.0.1".to_owned()], None).contains("multicast"));
        assert!(refused(&vec!["127.0.0.1".to_owned(); 257], None).contains("257"));
        for timeout in [0, 99, 10_001, u64::MAX] {
            assert!(refused(&[], Some(timeout)).contains("100 to 10000"));
        }
    }
}
