//! A further name under which the relay may be called.

use core::fmt;
use std::net::IpAddr;
use std::str::FromStr;

use serde::Deserialize;

use crate::listen::{in_url, is_name};

/// `gateway.plant.local`, `gateway.plant.local:9000` or an address: what a browser has as `Host` when it comes through a
/// tunnel, out of a container's host, or by a name that the relay does not know of.
#[derive(Clone, Debug, PartialEq, Eq, Deserialize)]
#[serde(try_from = "String")]
pub struct HostName {
    name: String,
    port: Option<u16>,
}

impl HostName {
    /// The name or address alone.
    pub(crate) fn name(&self) -> &str {
        &self.name
    }

    /// What `Host` may be: with the port that was given; without one the relay's, or none, as for ports 80 and 443.
    pub(crate) fn hosts(&self, own_port: u16) -> Vec<String> {
        let name = in_url(&self.name);
        match self.port {
            Some(port) => vec![format!("{name}:{port}")],
            None => vec![format!("{name}:{own_port}"), name],
        }
    }
}

impl FromStr for HostName {
    type Err = NoHostName;

    fn from_str(text: &str) -> Result<Self, NoHostName> {
        let refused = || NoHostName(text.to_owned());
        // Before the last colon, unless that is inside of an IPv6 address.
        let (name, port) = match text.rsplit_once(':') {
            Some((name, port)) if !name.contains(':') || name.ends_with(']') => {
                (name, Some(port.parse().ok().filter(|port| *port > 0).ok_or_else(refused)?))
            }
            _ => (text, None),
        };
        let bare = name.strip_prefix('[').and_then(|name| name.strip_suffix(']')).unwrap_or(name);
        let is_known = is_name(bare) || bare.parse::<IpAddr>().is_ok();
        is_known.then(|| Self { name: bare.to_ascii_lowercase(), port }).ok_or_else(refused)
    }
}

impl TryFrom<String> for HostName {
    type Error = NoHostName;

    fn try_from(text: String) -> Result<Self, NoHostName> {
        text.parse()
    }
}

impl fmt::Display for HostName {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(&in_url(&self.name))?;
        self.port.map_or(Ok(()), |port| write!(f, ":{port}"))
    }
}

/// Something else was given.
#[derive(Clone, Debug, PartialEq, Eq, thiserror::Error)]
#[error(
    "{0:?} is not the name of a host: give one as gateway.plant.local or gateway.plant.local:9000, without https:// and without a path"
)]
pub struct NoHostName(String);

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn names_and_addresses_with_and_without_a_port_are_read() {
        let hosts = |text: &str| text.parse::<HostName>().unwrap().hosts(8818);
        assert_eq!(hosts("Gateway.plant.local"), ["gateway.plant.local:8818", "gateway.plant.local"]);
        assert_eq!(hosts("gateway:9000"), ["gateway:9000"]);
        assert_eq!(hosts("10.0.0.7"), ["10.0.0.7:8818", "10.0.0.7"]);
        assert_eq!(hosts("fd00::7"), ["[fd00::7]:8818", "[fd00::7]"]);
        assert_eq!(hosts("[fd00::7]:443"), ["[fd00::7]:443"]);
    }

    #[test]
    fn anything_else_is_refused_in_words() {
        for text in
            ["", "https://gateway", "gateway/page", "*", "*.plant.local", "gateway:0", "gateway:x", "a b"]
        {
            let refused = text.parse::<HostName>().unwrap_err().to_string();
            assert!(refused.contains("without https://"), "{refused}");
        }
    }
}
