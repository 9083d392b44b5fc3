//! From a target to an open stream.

use std::io;
use std::net::{Ipv4Addr, SocketAddr};
use std::sync::{Arc, Mutex, PoisonError};

use cipdeck_shared::config::{Endpoint, Host};
use cipdeck_shared::engine::{ConnectError, LinkId};
use cipdeck_shared::sim::{Device, Registers, SimConfig};
use tokio::io::DuplexStream;
use tokio::net::TcpStream;

use super::clock::Clock;
use super::trail::Ends;
use crate::permit::{Denied, Lists};
use crate::simulate;

/// Bytes between the engine and the built-in device.
const PIPE: usize = 64 * 1024;

/// Opens a TCP connection. How long that may take is the engine's business: it gives up by dropping this future.
/// With lists, an address that has been checked is connected to: a name is not asked for again.
pub(super) async fn open(
    endpoint: &Endpoint,
    lists: Option<&Lists>,
) -> Result<(TcpStream, Ends), (ConnectError, String)> {
    let addresses = match lists {
        Some(lists) => admitted(endpoint, lists).await?,
        None => resolve(endpoint).await?,
    };
    let mut last = (ConnectError::Unresolved, format!("{} has no address", endpoint.host));
    for address in addresses {
        match connect(address).await {
            Ok((stream, ends)) => {
                // Without it a request may wait for the acknowledgement of the one before.
                if let Err(error) = stream.set_nodelay(true) {
                    tracing::debug!(%error, target.address = %address, "cannot set TCP_NODELAY");
                }
                // What has not arrived when the socket is given up must not arrive any more: otherwise the system goes
                // on sending a write whose block has long ended, until a cable is plugged in again.
                if let Err(error) = stream.set_zero_linger() {
                    tracing::warn!(%error, target.address = %address, "cannot set SO_LINGER");
                }
                return Ok((stream, ends));
            }
            Err(error) => last = (reason(&error), format!("{address}: {error}")),
        }
    }
    Err(last)
}

async fn connect(address: SocketAddr) -> io::Result<(TcpStream, Ends)> {
    let stream = TcpStream::connect(address).await?;
    let ends = Ends { local: stream.local_addr()?, peer: stream.peer_addr()? };
    Ok((stream, ends))
}

/// A connection to the device that is part of the relay.
pub(super) fn built_in(device: Arc<Mutex<Device>>, clock: Clock) -> DuplexStream {
    let (ours, theirs) = tokio::io::duplex(PIPE);
    tokio::spawn(async move {
        let _ = simulate::answer_stream(theirs, &device, clock).await;
    });
    ours
}

/// Addresses for a connection that has none, from the block that is reserved for documentation (RFC 5737). Each
/// connection has a port of its own, as the ports of the system would be.
pub(super) fn built_in_ends(link: LinkId) -> Ends {
    let port = u16::try_from(link.0 % 16_384).unwrap_or_default() + 49_152;
    Ends { local: ([192, 0, 2, 1], port).into(), peer: ([192, 0, 2, 2], 44_818).into() }
}

/// A device of the relay's own.
pub(super) fn built_in_device() -> Arc<Mutex<Device>> {
    let registers = Some(Registers::default());
    Arc::new(Mutex::new(Device::new(SimConfig { registers, ..SimConfig::default() })))
}

async fn admitted(endpoint: &Endpoint, lists: &Lists) -> Result<Vec<SocketAddr>, (ConnectError, String)> {
    let denied = |denied: Denied| (ConnectError::NotPermitted, denied.to_string());
    lists.allow_endpoint(endpoint).map_err(denied)?;
    let Host::Name(name) = &endpoint.host else { return resolve(endpoint).await };
    let ips = match lists.pinned(name) {
        Some(ips) => ips,
        None => resolve(endpoint).await?.iter().map(SocketAddr::ip).collect(),
    };
    // Pinned addresses are checked again, too: the port may be another one.
    let ips = lists.pin(name, endpoint.port, ips).map_err(denied)?;
    Ok(ips.into_iter().map(|ip| SocketAddr::new(ip, endpoint.port)).collect())
}

async fn resolve(endpoint: &Endpoint) -> Result<Vec<SocketAddr>, (ConnectError, String)> {
    match &endpoint.host {
        Host::Ip(ip) => Ok(vec![SocketAddr::new(Ipv4Addr::from(*ip).into(), endpoint.port)]),
        Host::Name(name) => match tokio::net::lookup_host((name.as_str(), endpoint.port)).await {
            Ok(addresses) => Ok(addresses.collect()),
            Err(error) => Err((ConnectError::Unresolved, format!("{name}: {error}"))),
        },
    }
}

fn reason(error: &io::Error) -> ConnectError {
    match error.kind() {
        io::ErrorKind::ConnectionRefused => ConnectError::Refused,
        _ => ConnectError::Unreachable,
    }
}

/// A panic while somebody held the device leaves a usable device behind: its state is plain values.
pub(crate) fn lock<T>(mutex: &Mutex<T>) -> std::sync::MutexGuard<'_, T> {
    mutex.lock().unwrap_or_else(PoisonError::into_inner)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[tokio::test]
    async fn a_port_without_a_listener_refuses() {
        let listener = tokio::net::TcpListener::bind("127.0.0.1:0").await.unwrap();
        let port = listener.local_addr().unwrap().port();
        drop(listener);
        let (error, detail) =
            open(&Endpoint { host: Host::Ip([127, 0, 0, 1]), port }, None).await.unwrap_err();
        assert_eq!(error, ConnectError::Refused);
        assert!(detail.contains("127.0.0.1"), "{detail}");
    }

    #[tokio::test]
    async fn what_has_not_arrived_when_a_socket_is_given_up_never_arrives() {
        use tokio::io::{AsyncReadExt, AsyncWriteExt};

        let listener = tokio::net::TcpListener::bind("127.0.0.1:0").await.unwrap();
        let port = listener.local_addr().unwrap().port();
        let endpoint = Endpoint { host: Host::Ip([127, 0, 0, 1]), port };
        let (mut ours, _) = open(&endpoint, None).await.unwrap();
        let (mut theirs, _) = listener.accept().await.unwrap();
        // The target takes nothing: what is written waits in the system.
        let piece = vec![0x5A; 64 * 1024];
        let mut written = 0;
        while let Ok(length) =
            tokio::time::timeout(std::time::Duration::from_millis(200), ours.write(&piece)).await
        {
            written += length.unwrap();
        }
        drop(ours);
        let (mut arrived, mut input) = (0, vec![0; 64 * 1024]);
        let end = loop {
            match theirs.read(&mut input).await {
                Ok(0) => break Ok(()),
                Ok(length) => arrived += length,
                Err(error) => break Err(error.kind()),
            }
        };
        assert_eq!(end, Err(io::ErrorKind::ConnectionReset));
        assert!(arrived < written, "{arrived} of {written}");
    }

    #[tokio::test]
    async fn an_unknown_name_is_unresolved() {
        let name = Host::Name("no-such-host.invalid".to_owned());
        let (error, detail) = open(&Endpoint { host: name, port: 44818 }, None).await.unwrap_err();
        assert_eq!(error, ConnectError::Unresolved);
        assert!(detail.contains("no-such-host.invalid"), "{detail}");
    }
}
