//! Another machine, as far as one machine can play that: two network namespaces and a cable between them.

use std::process::Command;

/// A network of two. It ends with the value, also when the test fails.
#[derive(Debug)]
pub struct Network {
    /// The namespace of the relay, and its address.
    relay: (String, String),
    /// The namespace of somebody else.
    elsewhere: String,
}

impl Network {
    /// Needs root.
    pub fn make() -> Self {
        let id = std::process::id();
        let network = Self {
            relay: (format!("cipdeck-{id}-a"), "10.213.77.1".to_owned()),
            elsewhere: format!("cipdeck-{id}-b"),
        };
        let (Self { relay: (relay, address), elsewhere }, cable) = (&network, "cipdeck");
        for words in [
            format!("netns add {relay}"),
            format!("netns add {elsewhere}"),
            format!("-n {relay} link add {cable} type veth peer name {cable} netns {elsewhere}"),
            format!("-n {relay} addr add {address}/30 dev {cable}"),
            format!("-n {elsewhere} addr add 10.213.77.2/30 dev {cable}"),
            format!("-n {relay} link set {cable} up"),
            format!("-n {elsewhere} link set {cable} up"),
            format!("-n {relay} link set lo up"),
        ] {
            if let Err(why) = ip(&words) {
                panic!(
                    "`ip {words}`: {why}; this test makes network namespaces: run it as root, and install `ip` and \
                     `openssl` with `apt-get install iproute2 openssl curl`"
                );
            }
        }
        network
    }

    /// The relay's address in this network.
    pub fn address(&self) -> &str {
        &self.relay.1
    }

    /// What a command begins with to be run where the relay is.
    pub fn at_relay(&self) -> [&str; 4] {
        ["ip", "netns", "exec", &self.relay.0]
    }

    /// What a command begins with to be run elsewhere.
    pub fn elsewhere(&self) -> [&str; 4] {
        ["ip", "netns", "exec", &self.elsewhere]
    }
}

impl Drop for Network {
    fn drop(&mut self) {
        for name in [&self.relay.0, &self.elsewhere] {
            // The cable goes with them. What was not made cannot be removed.
            let _ = ip(&format!("netns del {name}"));
        }
    }
}

fn ip(words: &str) -> Result<(), String> {
    let output = Command::new("ip").args(words.split(' ')).output().map_err(|error| error.to_string())?;
    if output.status.success() {
        return Ok(());
    }
    Err(String::from_utf8_lossy(&output.stderr).trim().to_owned())
}
