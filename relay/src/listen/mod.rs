//! Where the relay answers: on loopback until there is an administrator, then where it was told to, with TLS.

mod door;
mod names;
mod seats;

#[cfg(test)]
mod tests;

use std::net::{IpAddr, Ipv4Addr, Ipv6Addr, SocketAddr};

use axum::Router;
use tokio::net::TcpListener;
use tokio::sync::watch;

use self::door::Door;
pub(crate) use self::door::Listening;
pub(crate) use self::names::{in_url, is_name, own as own_names, secure_url};
pub(crate) use self::seats::Seats;
use crate::error::RunError;
use crate::settings::Settings;
use crate::tls::Tls;

/// Where to listen while there is no administrator: where others cannot reach it.
pub(crate) fn before_set_up(listen: SocketAddr) -> SocketAddr {
    match listen.ip() {
        ip if ip.is_loopback() => listen,
        IpAddr::V4(_) => (Ipv4Addr::LOCALHOST, listen.port()).into(),
        IpAddr::V6(_) => (Ipv6Addr::LOCALHOST, listen.port()).into(),
    }
}

/// What to serve with. `None` = plain HTTP: on loopback, unless TLS is configured.
pub(crate) fn tls(settings: &Settings) -> Result<Option<Tls>, RunError> {
    let tls = match &settings.tls {
        None if settings.listen.ip().is_loopback() => return Ok(None),
        Some(given) if let Some((chain, key)) = given.files() => Tls::from_files(chain, key),
        _ => {
            let hosts = settings.allow_hosts.iter().map(|host| host.name().to_owned());
            let names = own_names(settings.listen.ip()).into_iter().chain(hosts).collect();
            Tls::self_signed(settings.data.as_deref(), names)
        }
    };
    tls.map(Some).map_err(|error| RunError::Tls(error.to_string()))
}

/// What is answered, and with what.
pub(crate) struct Site {
    /// Where others can reach it, if that is no loopback address.
    pub(crate) listen: SocketAddr,
    /// What it is served with there.
    pub(crate) tls: Option<Tls>,
    /// How many connections there may be.
    pub(crate) seats: Seats,
    /// The requests that are answered at an address, with TLS or without.
    pub(crate) router: Box<dyn Fn(SocketAddr, bool) -> Router + Send + Sync>,
}

/// Binds an address.
pub(crate) async fn bind(address: SocketAddr) -> Result<TcpListener, RunError> {
    TcpListener::bind(address).await.map_err(|source| RunError::Bind(address, source))
}

/// Where the relay answers now, and where it did until there was an administrator.
#[derive(Debug)]
pub(crate) struct Doors {
    current: Door,
    former: Option<Door>,
    is_set_up: watch::Receiver<bool>,
}

impl Doors {
    /// Begins to answer: on the listener, or, if there is an administrator already, where others can reach the relay.
    pub(crate) async fn open(
        listener: TcpListener,
        site: &Site,
        is_set_up: watch::Receiver<bool>,
        ready: &mut impl FnMut(&Listening),
    ) -> Result<Self, RunError> {
        let current = if site.listen.ip().is_loopback() {
            Door::open(listener, site, site.tls.as_ref())?
        } else if *is_set_up.borrow() {
            drop(listener);
            Door::open(bind(site.listen).await?, site, site.tls.as_ref())?
        } else {
            Door::open(listener, site, None)?
        };
        ready(&current.listening);
        Ok(Self { current, former: None, is_set_up })
    }

    /// Answers until something fails, and moves when there is an administrator.
    pub(crate) async fn keep(&mut self, site: &Site, ready: &mut impl FnMut(&Listening)) -> RunError {
        let listen = site.listen;
        if !listen.ip().is_loopback() && self.current.listening.address.ip().is_loopback() {
            tokio::select! {
                () = set_up(&mut self.is_set_up) => {}
                () = self.current.ended() => return RunError::Stopped,
            }
            // First the old one: both may have the same port.
            self.current.close().await;
            match bind(listen).await.and_then(|listener| Door::open(listener, site, site.tls.as_ref())) {
                Ok(door) => self.former = Some(std::mem::replace(&mut self.current, door)),
                Err(error) => return error,
            }
            ready(&self.current.listening);
        }
        self.current.ended().await;
        RunError::Stopped
    }

    /// Takes no more connections. What is being answered goes on.
    pub(crate) async fn close(&mut self) {
        self.current.close().await;
    }

    /// After [`Self::close`]: ready when everything has been answered.
    pub(crate) async fn are_empty(&self) {
        self.current.is_empty().await;
        if let Some(former) = &self.former {
            former.is_empty().await;
        }
    }
}

async fn set_up(is_set_up: &mut watch::Receiver<bool>) {
    if is_set_up.wait_for(|is_set_up| *is_set_up).await.is_err() {
        // Nobody can do it any more.
        std::future::pending::<()>().await;
    }
}
