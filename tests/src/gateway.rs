//! A gateway that keeps one session with a device for all its clients, holds one reply back, and says it, late, to
//! whoever asks next; what it has said before, too. Gateways like this exist; only contexts, connection ids and sequence
//! counts protect against them.

use std::net::SocketAddr;
use std::sync::Arc;

use tokio::io::AsyncWriteExt as _;
use tokio::net::{TcpListener, TcpStream};
use tokio::sync::Mutex;
use tokio::task::JoinHandle;

use crate::frame::{Frame, REGISTER_SESSION, SEND_RR_DATA, SEND_UNIT_DATA, UNREGISTER_SESSION};

/// The gateway; it stops when it is dropped.
#[derive(Debug)]
pub struct Gateway {
    address: SocketAddr,
    accepting: JoinHandle<()>,
}

#[derive(Debug)]
struct Device {
    stream: TcpStream,
    /// The reply to RegisterSession.
    registered: Option<Frame>,
    messages: usize,
    held: usize,
    late: Option<Frame>,
    former: Option<Frame>,
}

impl Gateway {
    /// In front of a device; the reply to the message of this number, counted from 1, is held back. Connections that are
    /// opened and closed are no messages.
    pub async fn start(device: &str, held: usize) -> Self {
        let stream = TcpStream::connect(device).await.expect("the device listens");
        stream.set_nodelay(true).expect("a socket");
        let (registered, late, former) = (None, None, None);
        let device = Arc::new(Mutex::new(Device { stream, registered, messages: 0, held, late, former }));
        let listener = TcpListener::bind(("127.0.0.1", 0)).await.expect("a free port");
        let address = listener.local_addr().expect("the port that is bound");
        Self { address, accepting: tokio::spawn(accept(listener, device)) }
    }

    /// `TargetCfg.Path` of the device behind it.
    pub fn path(&self) -> String {
        crate::fake_plc::path(self.address)
    }
}

impl Drop for Gateway {
    fn drop(&mut self) {
        self.accepting.abort();
    }
}

async fn accept(listener: TcpListener, device: Arc<Mutex<Device>>) {
    let mut clients = tokio::task::JoinSet::new();
    while let Ok((client, _)) = listener.accept().await {
        let device = Arc::clone(&device);
        clients.spawn(async move {
            let _ = serve(client, &device).await;
        });
    }
}

async fn serve(mut client: TcpStream, device: &Mutex<Device>) -> std::io::Result<()> {
    client.set_nodelay(true)?;
    loop {
        let request = Frame::read(&mut client).await?;
        let replies = match request.command() {
            UNREGISTER_SESSION => return Ok(()),
            _ => device.lock().await.ask(request).await?,
        };
        for reply in replies {
            client.write_all(&reply.0).await?;
        }
    }
}

impl Device {
    /// What the client hears.
    async fn ask(&mut self, request: Frame) -> std::io::Result<Vec<Frame>> {
        if let Some(mut registered) =
            self.registered.clone().filter(|_| request.command() == REGISTER_SESSION)
        {
            registered.0[12..20].copy_from_slice(&request.context());
            return Ok(vec![registered]);
        }
        self.stream.write_all(&request.0).await?;
        let reply = Frame::read(&mut self.stream).await?;
        if request.command() == REGISTER_SESSION {
            self.registered = Some(reply.clone());
        }
        if !is_message(&request) {
            return Ok(vec![reply]);
        }
        self.messages += 1;
        if self.messages == self.held {
            self.late = Some(reply);
            return Ok(Vec::new());
        }
        let former = self.former.replace(reply.clone());
        Ok(self.late.clone().into_iter().chain(former).chain([reply]).collect())
    }
}

fn is_message(request: &Frame) -> bool {
    const FORWARD_CLOSE: u8 = 0x4E;
    const FORWARD_OPEN: u8 = 0x54;
    const LARGE_FORWARD_OPEN: u8 = 0x5B;
    match request.command() {
        SEND_UNIT_DATA => true,
        SEND_RR_DATA => !matches!(request.message()[0], FORWARD_CLOSE | FORWARD_OPEN | LARGE_FORWARD_OPEN),
        _ => false,
    }
}
