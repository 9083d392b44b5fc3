//! A target that follows a script: it can be silent, late, half, wrong, or gone.

use std::net::SocketAddr;
use std::sync::{Arc, Mutex, PoisonError};

use tokio::io::AsyncWriteExt as _;
use tokio::net::{TcpListener, TcpStream};
use tokio::sync::Semaphore;
use tokio::task::JoinHandle;

use crate::frame::{Frame, REGISTER_SESSION, SEND_RR_DATA, encapsulate, unconnected};

/// What came in.
#[derive(Clone, Debug)]
pub struct Request {
    /// Which TCP connection, counted from 1.
    pub connection: usize,
    /// Which frame of its command over all connections, counted from 1.
    pub number: usize,
    /// The frame.
    pub frame: Frame,
}

/// What the target does next.
#[derive(Clone, Debug)]
pub enum Act {
    /// Write these bytes.
    Send(Vec<u8>),
    /// Do nothing until the test calls [`FakePlc::release`].
    Hold,
    /// Close the TCP connection.
    Close,
}

impl Request {
    /// The frame that accepts a RegisterSession.
    pub fn registered(&self) -> Vec<u8> {
        encapsulate(REGISTER_SESSION, self.own_session(), 0, self.frame.context(), &[1, 0, 0, 0])
    }

    /// The right frame around a message router reply.
    pub fn reply(&self, message: &[u8]) -> Vec<u8> {
        self.reply_as(self.frame.session(), self.frame.context(), message)
    }

    /// A frame around a message router reply, with any session and sender context.
    pub fn reply_as(&self, session: u32, context: [u8; 8], message: &[u8]) -> Vec<u8> {
        encapsulate(SEND_RR_DATA, session, 0, context, &unconnected(message))
    }

    /// A successful reply of the requested service, in the right frame.
    pub fn success(&self, data: &[u8]) -> Vec<u8> {
        self.reply(&success(self.frame.message()[0], data))
    }

    fn own_session(&self) -> u32 {
        0x5E55_0000 + u32::try_from(self.connection).expect("few connections")
    }
}

/// Message router bytes of a successful reply.
pub fn success(service: u8, data: &[u8]) -> Vec<u8> {
    [&[service | 0x80, 0, 0, 0], data].concat()
}

/// A script that accepts sessions and leaves the messages to `script`.
pub fn messages(
    mut script: impl FnMut(&Request) -> Vec<Act> + Send + 'static,
) -> impl FnMut(&Request) -> Vec<Act> + Send + 'static {
    move |request| match request.frame.command() {
        REGISTER_SESSION => vec![Act::Send(request.registered())],
        SEND_RR_DATA => script(request),
        _ => vec![Act::Close],
    }
}

/// A script that answers every message with success and `data`.
pub fn answering(data: &[u8]) -> impl FnMut(&Request) -> Vec<Act> + Send + 'static {
    let data = data.to_vec();
    messages(move |request| vec![Act::Send(request.success(&data))])
}

/// The target; it stops listening, and its connections close, when it is dropped.
#[derive(Debug)]
pub struct FakePlc {
    address: SocketAddr,
    shared: Arc<Shared>,
    accepting: JoinHandle<()>,
}

type Script = Box<dyn FnMut(&Request) -> Vec<Act> + Send>;

struct Shared {
    script: Mutex<Script>,
    requests: Mutex<Vec<Request>>,
    gate: Semaphore,
}

impl FakePlc {
    /// Listens on a free port and follows `script` for every frame.
    pub async fn start(script: impl FnMut(&Request) -> Vec<Act> + Send + 'static) -> Self {
        let listener = TcpListener::bind(("127.0.0.1", 0)).await.expect("a free port");
        let address = listener.local_addr().expect("the port that is bound");
        let shared = Arc::new(Shared {
            script: Mutex::new(Box::new(script)),
            requests: Mutex::default(),
            gate: Semaphore::new(0),
        });
        let accepting = tokio::spawn(accept(listener, Arc::clone(&shared)));
        Self { address, shared, accepting }
    }

    /// Where it listens.
    pub fn address(&self) -> SocketAddr {
        self.address
    }

    /// `TargetCfg.Path` of this target.
    pub fn path(&self) -> String {
        path(self.address)
    }

    /// Every frame that came in, in order.
    pub fn requests(&self) -> Vec<Request> {
        locked(&self.shared.requests).clone()
    }

    /// The message router bytes of every SendRRData that came in, in order.
    pub fn messages(&self) -> Vec<Vec<u8>> {
        let requests = self.requests();
        let messages = requests.iter().filter(|request| request.frame.command() == SEND_RR_DATA);
        messages.map(|request| request.frame.message().to_vec()).collect()
    }

    /// Ends one [`Act::Hold`], the present or the next one.
    pub fn release(&self) {
        self.shared.gate.add_permits(1);
    }
}

impl Drop for FakePlc {
    fn drop(&mut self) {
        self.accepting.abort();
    }
}

impl std::fmt::Debug for Shared {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        f.debug_struct("Shared").field("requests", &self.requests).finish_non_exhaustive()
    }
}

/// `TargetCfg.Path` of a target at a TCP port.
pub fn path(address: SocketAddr) -> String {
    format!("4,{address}")
}

async fn accept(listener: TcpListener, shared: Arc<Shared>) {
    // Dropped with this task, which ends all connections.
    let mut connections = tokio::task::JoinSet::new();
    for number in 1.. {
        let Ok((stream, _)) = listener.accept().await else { return };
        let shared = Arc::clone(&shared);
        connections.spawn(async move {
            let _ = converse(stream, number, &shared).await;
        });
    }
}

async fn converse(mut stream: TcpStream, connection: usize, shared: &Shared) -> std::io::Result<()> {
    stream.set_nodelay(true)?;
    loop {
        let frame = Frame::read(&mut stream).await?;
        for act in shared.decide(connection, frame) {
            match act {
                Act::Send(bytes) => stream.write_all(&bytes).await?,
                Act::Hold => shared.gate.acquire().await.expect("never closed").forget(),
                Act::Close => return Ok(()),
            }
        }
    }
}

impl Shared {
    fn decide(&self, connection: usize, frame: Frame) -> Vec<Act> {
        let request = {
            let mut requests = locked(&self.requests);
            let earlier = requests.iter().filter(|earlier| earlier.frame.command() == frame.command());
            let request = Request { connection, number: earlier.count() + 1, frame };
            requests.push(request.clone());
            request
        };
        (locked(&self.script))(&request)
    }
}

fn locked<T>(mutex: &Mutex<T>) -> std::sync::MutexGuard<'_, T> {
    mutex.lock().unwrap_or_else(PoisonError::into_inner)
}
