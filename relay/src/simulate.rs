//! Sockets around the simulated device of `shared::sim`: a stream, a TCP listener, a UDP socket.

use std::io;
use std::sync::{Arc, Mutex};
use std::time::Duration;

use cipdeck_shared::sim::{Device, SimConnection, handle_datagram};
use tokio::io::{AsyncRead, AsyncReadExt, AsyncWrite, AsyncWriteExt};
use tokio::net::{TcpListener, UdpSocket};

use crate::runner::{Clock, lock};

/// Bytes of one read or datagram: the largest frame of EtherNet/IP.
const READ_SIZE: usize = 65_535;

/// Answers one connection until either side closes it.
pub(crate) async fn answer_stream<S>(mut io: S, device: &Mutex<Device>, clock: Clock) -> io::Result<()>
where
    S: AsyncRead + AsyncWrite + Unpin,
{
    let mut connection = SimConnection::new();
    let (mut out, mut input) = (Vec::new(), vec![0; READ_SIZE]);
    loop {
        while connection.poll_transmit(&mut out, clock.now()) {
            io.write_all(&out).await?;
            out.clear();
        }
        if connection.is_closed() {
            return io.shutdown().await;
        }
        let due = async {
            match connection.poll_timeout() {
                Some(at) => tokio::time::sleep_until(clock.at(at)).await,
                None => std::future::pending().await,
            }
        };
        tokio::select! {
            read = io.read(&mut input) => match read? {
                0 => return Ok(()),
                length => {
                    let bytes = input.get(..length).unwrap_or_default();
                    connection.handle_input(&mut lock(device), bytes, clock.now());
                }
            },
            () = due => {}
        }
    }
}

/// Accepts connections until the task is dropped.
pub(crate) async fn answer_tcp(listener: TcpListener, device: Arc<Mutex<Device>>, clock: Clock) {
    loop {
        match listener.accept().await {
            Ok((stream, peer)) => {
                // Replies are small and waited for.
                let _ = stream.set_nodelay(true);
                let device = Arc::clone(&device);
                tokio::spawn(async move {
                    tracing::debug!(client.address = %peer, "connected");
                    if let Err(error) = answer_stream(stream, &device, clock).await {
                        tracing::debug!(client.address = %peer, %error, "connection broken");
                    }
                });
            }
            Err(error) => {
                tracing::warn!(%error, "cannot accept a connection");
                // Out of file descriptors: trying again at once would only burn time.
                tokio::time::sleep(Duration::from_millis(100)).await;
            }
        }
    }
}

/// Answers datagrams until the task is dropped.
pub(crate) async fn answer_udp(socket: UdpSocket, device: Arc<Mutex<Device>>) {
    let mut input = vec![0; READ_SIZE];
    loop {
        match socket.recv_from(&mut input).await {
            Ok((length, peer)) => {
                let reply = handle_datagram(&lock(&device), input.get(..length).unwrap_or_default());
                if let Some(reply) = reply
                    && let Err(error) = socket.send_to(&reply, peer).await
                {
                    tracing::debug!(client.address = %peer, %error, "cannot answer a datagram");
                }
            }
            // Windows reports an answer that nobody took on the next receive.
            Err(error) => tracing::debug!(%error, "cannot receive a datagram"),
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[tokio::test]
    async fn a_registered_client_that_unregisters_is_hung_up_on() {
        let (mut ours, theirs) = tokio::io::duplex(1);
        let device = Mutex::new(Device::default());
        let client = async {
            let mut register = [0; 28];
            (register[0], register[2], register[24]) = (0x65, 4, 1);
            ours.write_all(&register).await.unwrap();
            let mut reply = [0; 28];
            ours.read_exact(&mut reply).await.unwrap();
            assert_ne!(reply[4..8], [0; 4], "a session handle");
            let mut unregister = [0; 24];
            unregister[0] = 0x66;
            unregister[4..8].copy_from_slice(&reply[4..8]);
            ours.write_all(&unregister).await.unwrap();
            assert_eq!(ours.read(&mut reply).await.unwrap(), 0);
        };
        let (ended, ()) = tokio::join!(answer_stream(theirs, &device, Clock::start()), client);
        ended.unwrap();
    }
}
