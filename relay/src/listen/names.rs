//! The names under which this machine can be called.

use std::net::{IpAddr, Ipv4Addr, Ipv6Addr, SocketAddr};

/// Names and addresses for who listens on `address`: those of loopback always, beyond it the address itself (all of
/// this machine for `0.0.0.0` and `[::]`) and the machine's name.
pub(crate) fn own(address: IpAddr) -> Vec<String> {
    let mut names: Vec<String> = vec!["localhost".to_owned()];
    let mut addresses = vec![Ipv4Addr::LOCALHOST.into(), Ipv6Addr::LOCALHOST.into()];
    if address.is_unspecified() {
        let interfaces = if_addrs::get_if_addrs().unwrap_or_default();
        addresses.extend(interfaces.iter().map(if_addrs::Interface::ip).filter(|ip| !is_link_local(*ip)));
    } else {
        addresses.push(address);
    }
    if !address.is_loopback() {
        names.extend(host_name());
    }
    names.extend(addresses.iter().map(ToString::to_string));
    let mut seen = std::collections::BTreeSet::new();
    names.retain(|name| seen.insert(name.clone()));
    names
}

/// A name or an address as it stands in a URL.
pub(crate) fn in_url(name: &str) -> String {
    if name.parse::<Ipv6Addr>().is_ok() { format!("[{name}]") } else { name.to_owned() }
}

/// The URL of the relay where it is served with TLS, as far as that can be told beforehand.
pub(crate) fn secure_url(listen: SocketAddr) -> String {
    let address = Some(listen.ip()).filter(|ip| !ip.is_unspecified()).map(|ip| ip.to_string());
    let name = address.or_else(host_name).unwrap_or_else(|| "localhost".to_owned());
    match listen.port() {
        0 | 443 => format!("https://{}/", in_url(&name)),
        port => format!("https://{}:{port}/", in_url(&name)),
    }
}

/// Such an address means another machine on each network, and has no place in a URL.
const fn is_link_local(address: IpAddr) -> bool {
    match address {
        IpAddr::V4(ip) => ip.is_link_local(),
        IpAddr::V6(ip) => ip.is_unicast_link_local(),
    }
}

#[cfg(unix)]
fn host_name() -> Option<String> {
    let name = rustix::system::uname().nodename().to_str().ok()?.to_ascii_lowercase();
    is_name(&name).then_some(name)
}

#[cfg(not(unix))]
fn host_name() -> Option<String> {
    std::env::var("COMPUTERNAME").ok().map(|name| name.to_ascii_lowercase()).filter(|name| is_name(name))
}

/// Could be a name of the DNS.
pub(crate) fn is_name(text: &str) -> bool {
    let is_label = |label: &str| {
        (1..=63).contains(&label.len())
            && !label.starts_with('-')
            && !label.ends_with('-')
            && label.bytes().all(|byte| byte.is_ascii_alphanumeric() || byte == b'-' || byte == b'_')
    };
    text.len() <= 253 && text.split('.').all(is_label)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn loopback_has_no_names_that_others_could_use() {
        assert_eq!(own(Ipv4Addr::LOCALHOST.into()), ["localhost", "127.0.0.1", "::1"]);
        assert_eq!(own("127.0.0.2".parse().unwrap()), ["localhost", "127.0.0.1", "::1", "127.0.0.2"]);
    }

    #[test]
    fn an_address_is_one_of_its_names() {
        let names = own("192.0.2.17".parse().unwrap());
        assert!(names.contains(&"192.0.2.17".to_owned()), "{names:?}");
        assert!(!own(Ipv4Addr::UNSPECIFIED.into()).contains(&"0.0.0.0".to_owned()));
    }

    #[test]
    fn a_browser_is_told_where_to_go() {
        let url = |listen: &str| secure_url(listen.parse().unwrap());
        assert_eq!(url("192.0.2.17:8818"), "https://192.0.2.17:8818/");
        assert_eq!(url("[2001:db8::7]:443"), "https://[2001:db8::7]/");
        assert!(!url("0.0.0.0:8818").contains("0.0.0.0"));
    }

    #[test]
    fn a_name_is_what_the_dns_takes() {
        for name in ["plc-gateway", "relay.plant.local", "10.0.0.7"] {
            assert!(is_name(name), "{name}");
        }
        for text in ["", "a..b", "-a", "a b", "https://a", "*", "a:1", &"a".repeat(64)] {
            assert!(!is_name(text), "{text}");
        }
    }
}
