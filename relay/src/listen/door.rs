//! One listener, and the server behind it: HTTP/1.1 alone, every phase of a connection with its limit.
//!
//! Written here and not taken from a crate, because those that tell HTTP/1 and HTTP/2 apart by the first bytes wait for
//! these bytes without an end, and because a listener has to be gone at a known moment when the relay moves.

use core::fmt;
use std::net::SocketAddr;
use std::time::Duration;

use axum::Router;
use axum::extract::ConnectInfo;
use hyper::body::Incoming;
use hyper::server::conn::http1::Builder;
use hyper::service::{Service, service_fn};
use hyper_util::rt::{TokioIo, TokioTimer};
use hyper_util::service::TowerToHyperService;
use tokio::io::{AsyncRead, AsyncWrite};
use tokio::net::TcpListener;
use tokio::task::JoinHandle;
use tokio_rustls::TlsAcceptor;
use tokio_util::sync::CancellationToken;
use tokio_util::task::TaskTracker;

use super::Site;
use super::seats::{Seated, Seats};
use crate::error::RunError;
use crate::tls::Tls;

/// Time for the head of a request; it begins again with each request, so that it ends idle connections, too.
const HEAD: Duration = Duration::from_secs(15);

/// Time for a TLS handshake.
const HANDSHAKE: Duration = Duration::from_secs(10);

/// Bytes of the head of a request.
const MAX_HEAD: usize = 64 * 1024;

/// Pause after a failed accept: this process has too many files open, and others may close some.
const TOO_MANY_FILES: Duration = Duration::from_millis(50);

/// Where the relay answers from now on.
#[derive(Clone, Debug, PartialEq, Eq)]
pub(crate) struct Listening {
    /// Address and port.
    pub(crate) address: SocketAddr,
    /// SHA-256 of the certificate; `None` = plain HTTP.
    pub(crate) fingerprint: Option<String>,
}

impl fmt::Display for Listening {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match &self.fingerprint {
            None => write!(f, "cipdeck listens on http://{}", self.address),
            Some(print) => {
                write!(f, "cipdeck listens on https://{}\ncertificate SHA-256 {print}", self.address)
            }
        }
    }
}

/// A listener that is being answered on.
#[derive(Debug)]
pub(super) struct Door {
    /// Takes connections until it is closed.
    task: JoinHandle<()>,
    connections: TaskTracker,
    closing: CancellationToken,
    pub(super) listening: Listening,
}

/// What every connection behind a door needs.
#[derive(Clone)]
struct Reception {
    router: Router,
    tls: Option<Tls>,
    closing: CancellationToken,
}

impl Door {
    /// Begins to answer.
    pub(super) fn open(listener: TcpListener, site: &Site, tls: Option<&Tls>) -> Result<Self, RunError> {
        let address = listener.local_addr().map_err(RunError::Listen)?;
        let closing = CancellationToken::new();
        let connections = TaskTracker::new();
        let router = (site.router)(address, tls.is_some());
        let reception = Reception { router, tls: tls.cloned(), closing: closing.clone() };
        let task = tokio::spawn(reception.take(listener, site.seats.clone(), connections.clone()));
        tracing::info!(server.address = %address, tls = tls.is_some(), "listening");
        let listening = Listening { address, fingerprint: tls.map(Tls::fingerprint) };
        Ok(Self { task, connections, closing, listening })
    }

    /// Ready when no connections are taken any more; that is a failure unless it was asked for.
    pub(super) async fn ended(&mut self) {
        if !self.task.is_finished() {
            // Its result is nothing, and a panic is an end as well.
            let _ = (&mut self.task).await;
        }
    }

    /// Takes no more connections, and returns when the listener is gone. What is being answered goes on.
    pub(super) async fn close(&mut self) {
        self.closing.cancel();
        self.connections.close();
        self.ended().await;
    }

    /// After [`Self::close`]: ready when everything has been answered.
    pub(super) async fn is_empty(&self) {
        self.connections.wait().await;
    }
}

impl Reception {
    async fn take(self, listener: TcpListener, seats: Seats, connections: TaskTracker) {
        while let Some(accepted) = self.closing.run_until_cancelled(listener.accept()).await {
            match accepted {
                Ok((stream, peer)) => {
                    if let Some(seated) = seats.take(stream, peer.ip()) {
                        connections.spawn(self.clone().answer(seated, peer));
                    }
                }
                Err(error) => {
                    tracing::debug!(%error, "a connection could not be taken");
                    tokio::time::sleep(TOO_MANY_FILES).await;
                }
            }
        }
    }

    async fn answer(self, stream: Seated, peer: SocketAddr) {
        let result = match &self.tls {
            None => self.serve(stream, peer).await,
            Some(tls) => {
                let handshake = TlsAcceptor::from(tls.config()).accept(stream);
                match tokio::time::timeout(HANDSHAKE, handshake).await {
                    Ok(Ok(stream)) => self.serve(stream, peer).await,
                    Ok(Err(error)) => Err(error.to_string()),
                    Err(_) => Err("no handshake".to_owned()),
                }
            }
        };
        if let Err(error) = result {
            // Whoever can connect can cause this as often as they like.
            tracing::debug!(client.address = %peer, error, "a connection ended early");
        }
    }

    async fn serve(
        &self,
        stream: impl AsyncRead + AsyncWrite + Unpin + Send + 'static,
        peer: SocketAddr,
    ) -> Result<(), String> {
        let router = TowerToHyperService::new(self.router.clone());
        let service = service_fn(move |mut request: hyper::Request<Incoming>| {
            request.extensions_mut().insert(ConnectInfo(peer));
            router.call(request)
        });
        let mut builder = Builder::new();
        builder.timer(TokioTimer::new()).header_read_timeout(HEAD).max_buf_size(MAX_HEAD);
        let connection = builder.serve_connection(TokioIo::new(stream), service).with_upgrades();
        let mut connection = std::pin::pin!(connection);
        let result = tokio::select! {
            result = connection.as_mut() => result,
            () = self.closing.cancelled() => {
                connection.as_mut().graceful_shutdown();
                connection.await
            }
        };
        result.map_err(|error| error.to_string())
    }
}
