//! How many connections there may be, in all and from one client. One more is closed at once.

use std::collections::HashMap;
use std::io;
use std::net::{IpAddr, Ipv6Addr};
use std::pin::Pin;
use std::sync::{Arc, Mutex, MutexGuard, PoisonError};
use std::task::{Context, Poll};
use std::time::{Duration, Instant};

use tokio::io::{AsyncRead, AsyncWrite, ReadBuf};
use tokio::net::TcpStream;

use crate::metrics::Metrics;

/// How often it is logged that connections are closed.
const COMPLAINTS: Duration = Duration::from_mins(1);

/// The seats of a relay. Clones share them.
#[derive(Clone, Debug)]
pub(crate) struct Seats(Arc<Shared>);

#[derive(Debug)]
struct Shared {
    total: usize,
    per_client: usize,
    taken: Mutex<Taken>,
    metrics: Metrics,
}

#[derive(Debug, Default)]
struct Taken {
    total: usize,
    by_client: HashMap<IpAddr, usize>,
    complained: Option<Instant>,
}

/// One connection's seat, which is free again when this is dropped.
#[derive(Debug)]
struct Seat {
    seats: Seats,
    client: IpAddr,
}

impl Seats {
    /// So many connections in all, and from one client.
    pub(crate) fn new(total: usize, per_client: usize, metrics: Metrics) -> Self {
        Self(Arc::new(Shared { total, per_client, taken: Mutex::default(), metrics }))
    }

    /// Gives a new connection its seat; without a free one it is closed.
    pub(super) fn take(&self, stream: TcpStream, address: IpAddr) -> Option<Seated> {
        let seat = self.seat(address)?;
        // An answer right behind news would wait 40 ms until the viewer has acknowledged the news. A connection that is
        // gone already shows later.
        let _ = stream.set_nodelay(true);
        Some(Seated { stream, _seat: seat })
    }

    fn seat(&self, address: IpAddr) -> Option<Seat> {
        let client = client(address);
        let mut taken = self.taken();
        let by_client = taken.by_client.get(&client).copied().unwrap_or_default();
        if taken.total >= self.0.total || by_client >= self.0.per_client {
            self.0.metrics.unseated();
            let now = Instant::now();
            if taken.complained.is_none_or(|last| now - last >= COMPLAINTS) {
                taken.complained = Some(now);
                tracing::warn!(
                    client.address = %address, connections = taken.total, client.connections = by_client,
                    "closed a connection: there are too many"
                );
            }
            return None;
        }
        taken.total += 1;
        taken.by_client.insert(client, by_client + 1);
        Some(Seat { seats: self.clone(), client })
    }

    fn taken(&self) -> MutexGuard<'_, Taken> {
        self.0.taken.lock().unwrap_or_else(PoisonError::into_inner)
    }
}

impl Drop for Seat {
    fn drop(&mut self) {
        let mut taken = self.seats.taken();
        taken.total -= 1;
        if let Some(by_client) = taken.by_client.get_mut(&self.client) {
            *by_client -= 1;
            if *by_client == 0 {
                taken.by_client.remove(&self.client);
            }
        }
    }
}

/// Who counts as one: an IPv4 address, or the network that one place usually has of IPv6.
fn client(address: IpAddr) -> IpAddr {
    match address.to_canonical() {
        IpAddr::V6(ip) if !ip.is_loopback() => {
            IpAddr::V6(Ipv6Addr::from_bits(ip.to_bits() & (u128::MAX << 64)))
        }
        ip => ip,
    }
}

/// A connection with a seat, which it keeps when it becomes a WebSocket.
#[derive(Debug)]
pub(super) struct Seated {
    stream: TcpStream,
    _seat: Seat,
}

impl AsyncRead for Seated {
    fn poll_read(
        mut self: Pin<&mut Self>,
        context: &mut Context<'_>,
        buffer: &mut ReadBuf<'_>,
    ) -> Poll<io::Result<()>> {
        Pin::new(&mut self.stream).poll_read(context, buffer)
    }
}

impl AsyncWrite for Seated {
    fn poll_write(
        mut self: Pin<&mut Self>,
        context: &mut Context<'_>,
        bytes: &[u8],
    ) -> Poll<io::Result<usize>> {
        Pin::new(&mut self.stream).poll_write(context, bytes)
    }

    fn poll_write_vectored(
        mut self: Pin<&mut Self>,
        context: &mut Context<'_>,
        slices: &[io::IoSlice<'_>],
    ) -> Poll<io::Result<usize>> {
        Pin::new(&mut self.stream).poll_write_vectored(context, slices)
    }

    fn is_write_vectored(&self) -> bool {
        self.stream.is_write_vectored()
    }

    fn poll_flush(mut self: Pin<&mut Self>, context: &mut Context<'_>) -> Poll<io::Result<()>> {
        Pin::new(&mut self.stream).poll_flush(context)
    }

    fn poll_shutdown(mut self: Pin<&mut Self>, context: &mut Context<'_>) -> Poll<io::Result<()>> {
        Pin::new(&mut self.stream).poll_shutdown(context)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_client_has_its_share_and_all_together_have_theirs() {
        let seats = Seats::new(5, 2, Metrics::default());
        let ip = |last: u8| IpAddr::from([10, 0, 0, last]);
        let first = (seats.seat(ip(1)).unwrap(), seats.seat(ip(1)).unwrap());
        assert!(seats.seat(ip(1)).is_none());
        let others: Vec<_> = [2, 2, 3].into_iter().map(|last| seats.seat(ip(last)).unwrap()).collect();
        assert!(seats.seat(ip(4)).is_none(), "all are taken");
        drop(first);
        assert!(seats.seat(ip(1)).is_some() && seats.seat(ip(4)).is_some());
        drop(others);
        assert!(seats.taken().by_client.is_empty() && seats.taken().total == 0);
    }

    #[test]
    fn one_place_is_one_client() {
        let one = |text: &str| client(text.parse().unwrap());
        assert_eq!(one("2001:db8:0:1::7"), one("2001:db8:0:1:ffff::8"));
        assert_ne!(one("2001:db8:0:1::7"), one("2001:db8:0:2::7"));
        assert_eq!(one("::ffff:10.0.0.7"), one("10.0.0.7"));
        assert_ne!(one("::1"), one("::2"));
    }
}
