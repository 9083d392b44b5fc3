//! `cipdeck discover`.

use cipdeck_shared::api::DiscoveredDevice;
use clap::Args;

use super::{Exit, say};
use crate::discover::{DEFAULT_TIMEOUT, EXPLICIT_PORT, Search, SearchError, TIMEOUT};
use crate::shutdown;

/// Who is there.
#[derive(Debug, Args)]
#[command(
    after_help = "Sends one datagram of 24 bytes (ListIdentity, UDP) to each address. Without addresses that is the \
                        broadcast address of each of this machine's own IPv4 networks; broadcasts to other networks \
                        are refused. Exits with 4 when nobody answers"
)]
pub(super) struct Discover {
    /// Whom to ask: devices, or broadcast addresses of this machine's own networks
    #[arg(value_name = "ADDRESS[:PORT]")]
    addresses: Vec<String>,
    /// How long to wait for answers, 100 to 10000
    #[arg(long, value_name = "MS", default_value_t = DEFAULT_TIMEOUT,
          value_parser = clap::value_parser!(u64).range(*TIMEOUT.start()..=*TIMEOUT.end()))]
    timeout: u64,
    /// For machines: one JSON array, one object a device
    #[arg(long)]
    json: bool,
}

impl Discover {
    /// Asks and prints.
    pub(super) async fn execute(self) -> Exit {
        let search = match Search::parse(&self.addresses, Some(self.timeout)) {
            Ok(search) => search,
            Err(error @ SearchError::Networks(_)) => return Exit::internal(&error),
            Err(error) => return Exit::usage(&error),
        };
        let found = tokio::select! {
            found = search.run() => found,
            () = shutdown::requested() => return Exit::interrupted(&"interrupted"),
        };
        for error in &found.errors {
            eprintln!("cipdeck: {error}");
        }
        if self.json {
            // Plain texts and numbers: nothing that could fail.
            say(&serde_json::to_string(&found.devices).unwrap_or_default());
        }
        if found.devices.is_empty() {
            return self.nobody(found.errors.is_empty());
        }
        if !self.json {
            for row in table(&found.devices) {
                say(&row);
            }
        }
        Exit::SUCCESS
    }

    fn nobody(&self, asked: bool) -> Exit {
        if !asked {
            return Exit::unanswered(&"nobody answered");
        }
        let hint = if self.addresses.is_empty() {
            "Broadcasts do not pass routers: ask a device by its address (cipdeck discover 192.168.1.100). A firewall \
             on this machine may hold the answers back. Some devices answer late: --timeout 5000."
        } else {
            "Is the device on, and is it this address? A firewall on the way may hold UDP back; cipdeck send uses TCP. \
             Some devices answer late: --timeout 5000."
        };
        Exit::unanswered(&format!("nobody answered within {} ms. {hint}", self.timeout))
    }
}

const HEADINGS: [&str; 9] =
    ["address", "name", "vendor", "device type", "product", "revision", "serial", "state", "status"];

/// Columns as wide as what is in them.
fn table(devices: &[DiscoveredDevice]) -> Vec<String> {
    let rows: Vec<_> =
        std::iter::once(HEADINGS.map(str::to_owned)).chain(devices.iter().map(cells)).collect();
    let width = |column: usize| {
        let cells = rows.iter().filter_map(|row| row.get(column));
        cells.map(|cell| cell.chars().count()).max().unwrap_or_default()
    };
    let widths: Vec<_> = (0..HEADINGS.len()).map(width).collect();
    let line = |row: &[String; 9]| {
        let cells = row.iter().zip(&widths).map(|(cell, width)| format!("{cell:<width$}"));
        cells.collect::<Vec<_>>().join("  ").trim_end().to_owned()
    };
    rows.iter().map(line).collect()
}

fn cells(device: &DiscoveredDevice) -> [String; 9] {
    let DiscoveredDevice { address, port, .. } = device;
    let announced = device.announced.as_ref();
    [
        if *port == EXPLICIT_PORT { address.clone() } else { format!("{address}:{port}") },
        printable(&device.name),
        device.vendor.clone(),
        device.device_type.clone(),
        device.product_code.to_string(),
        device.revision.clone(),
        device.serial.clone(),
        device.state.clone(),
        device.status.clone() + &announced.map(|own| format!(" (says it is {own})")).unwrap_or_default(),
    ]
}

/// A device's name is whatever it likes to send: nothing of it may steer the terminal.
fn printable(name: &str) -> String {
    name.chars().map(|letter| if letter.is_control() { '\u{FFFD}' } else { letter }).collect()
}

#[cfg(test)]
mod tests {
    use cipdeck_shared::wire::{ListIdentityItem, ShortString, SocketAddress};

    use super::*;

    #[test]
    fn columns_are_aligned_and_names_cannot_steer_the_terminal() {
        let item = ListIdentityItem {
            protocol_version: 1,
            address: SocketAddress::v4([10, 0, 0, 9], 44_818),
            vendor: 1,
            device_type: 12,
            product_code: 65,
            major: 3,
            minor: 12,
            status: 0x0030,
            serial: 0xAB,
            name: ShortString::new(b"A\x1b[2J\x9b").unwrap(),
            state: 3,
        };
        let short = ListIdentityItem { name: ShortString::new(b"B").unwrap(), ..item.clone() };
        let devices = [
            DiscoveredDevice::new([10, 0, 0, 9], 44_818, &item),
            DiscoveredDevice::new([10, 0, 0, 10], 2_222, &short),
        ];
        let rows = table(&devices);
        assert!(rows.iter().all(|row| !row.contains(char::is_control)), "{rows:?}");
        assert!(rows[1].contains("A\u{FFFD}[2J\u{FFFD}"), "{rows:?}");
        let column = |row: &str, text: &str| row.find(text).map(|at| row[..at].chars().count());
        assert_eq!(column(&rows[1], "3.012"), column(&rows[0], "revision"));
        assert_eq!(column(&rows[2], "B  "), column(&rows[0], "name"));
        assert!(rows[2].starts_with("10.0.0.10:2222  "), "{rows:?}");
        assert!(rows[2].ends_with("(says it is 10.0.0.9:44818)"), "{rows:?}");
    }
}
