//! One connection: its task, and the handle by which the runner reaches it.

use std::future::Future;
use std::io;
use std::sync::Arc;

use cipdeck_shared::config::Target;
use cipdeck_shared::engine::LinkId;
use tokio::io::{AsyncRead, AsyncWrite};
use tokio::sync::Notify;
use tokio_util::sync::{CancellationToken, DropGuard};

use super::trail::{Carrier, Ends};
use super::{Inner, connect, driver};

/// The runner's end. Dropping it drops the socket.
#[derive(Debug)]
pub(super) struct Socket {
    pub(super) target: Target,
    wake: Arc<Notify>,
    _close: DropGuard,
}

impl Socket {
    /// There is something to write.
    pub(super) fn wake(&self) {
        self.wake.notify_one();
    }
}

/// The two ends of a new connection: the handle, and the task to be spawned.
pub(super) fn open(link: LinkId, target: Target, inner: Arc<Inner>) -> (Socket, impl Future<Output = ()>) {
    let (wake, closed) = (Arc::new(Notify::new()), inner.stop.child_token());
    let socket =
        Socket { target: target.clone(), wake: Arc::clone(&wake), _close: closed.clone().drop_guard() };
    (socket, serve(link, target, inner, wake, closed))
}

async fn serve(
    link: LinkId,
    target: Target,
    inner: Arc<Inner>,
    wake: Arc<Notify>,
    closed: CancellationToken,
) {
    // However this task ends, even by a panic, the engine hears of it.
    let _farewell = Farewell { link, inner: Arc::clone(&inner) };
    let work = async {
        match &target {
            Target::BuiltIn => {
                let stream = connect::built_in(Arc::clone(&inner.device), inner.clock);
                carry(stream, link, connect::built_in_ends(link), &inner, &wake).await
            }
            Target::Network(endpoint) => match connect::open(endpoint, inner.lists()).await {
                Ok((stream, ends)) => {
                    tracing::debug!(target.address = %endpoint, link = link.0, "connected");
                    carry(stream, link, ends, &inner, &wake).await
                }
                Err((error, detail)) => {
                    tracing::debug!(target.address = %endpoint, link = link.0, %detail, "not connected");
                    inner.with(|state, now| state.engine.connect_failed(link, error, &detail, now));
                    Ok(())
                }
            },
        }
    };
    if let Some(Err(error)) = closed.run_until_cancelled(work).await {
        tracing::debug!(target.address = %target, link = link.0, %error, "connection broken");
    }
}

/// Carries bytes until the other side closes.
async fn carry<S>(stream: S, link: LinkId, ends: Ends, inner: &Arc<Inner>, wake: &Notify) -> io::Result<()>
where
    S: AsyncRead + AsyncWrite + Unpin,
{
    let carrier = Carrier::open(link, ends, inner);
    let ended = driver::drive(stream, link, &carrier, wake).await;
    carrier.hung_up();
    ended
}

struct Farewell {
    link: LinkId,
    inner: Arc<Inner>,
}

impl Drop for Farewell {
    fn drop(&mut self) {
        self.inner.with(|state, now| {
            state.engine.closed(self.link, now);
            state.sockets.remove(&self.link)
        });
    }
}
