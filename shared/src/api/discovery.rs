//! Devices that have introduced themselves.

use alloc::format;
use alloc::string::{String, ToString};
use alloc::vec::Vec;

use serde::{Deserialize, Serialize};

use crate::table::{self, Entry};
use crate::wire::ListIdentityItem;

/// `POST /api/v1/discover`; an empty body asks on all networks of the machine.
#[derive(Clone, Debug, Default, PartialEq, Eq, Serialize, Deserialize)]
#[cfg_attr(feature = "openapi", derive(utoipa::ToSchema))]
#[serde(deny_unknown_fields)]
pub struct DiscoverRequest {
    /// `192.168.1.100`, `192.168.1.100:44818`, or the broadcast address of one of the machine's own networks. Absent
    /// or empty: the broadcast addresses of all of them.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub addresses: Option<Vec<String>>,
    /// How long to wait for answers, 100 to 10000 ms; 1000 if absent.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub timeout_ms: Option<u64>,
}

/// Who has answered.
#[derive(Clone, Debug, Default, PartialEq, Eq, Serialize, Deserialize)]
#[cfg_attr(feature = "openapi", derive(utoipa::ToSchema))]
pub struct Discovered {
    /// Each device once, by address.
    pub devices: Vec<DiscoveredDevice>,
    /// Where nothing could be sent, in words.
    pub errors: Vec<String>,
}

/// One device: names and conditions in words, and the numbers behind them. A number without a word is its own word, in
/// hexadecimal.
#[derive(Clone, Debug, PartialEq, Eq, Serialize, Deserialize)]
#[cfg_attr(feature = "openapi", derive(utoipa::ToSchema))]
pub struct DiscoveredDevice {
    /// Where the answer came from.
    pub address: String,
    /// The UDP port that it came from; the TCP port is nearly always the same.
    pub port: u16,
    /// The vendor's name.
    pub vendor: String,
    /// The vendor's number.
    pub vendor_id: u16,
    /// The device type's name.
    pub device_type: String,
    /// The device type's number.
    pub device_type_id: u16,
    /// The vendor's own number of the product.
    pub product_code: u16,
    /// Major and minor with three digits: `1.001`.
    pub revision: String,
    /// The status word in words.
    pub status: String,
    /// Identity attribute 5.
    pub status_word: u16,
    /// Serial number, eight hexadecimal digits.
    pub serial: String,
    /// Product name.
    pub name: String,
    /// The state in a word.
    pub state: String,
    /// 255 where the device does not say it.
    pub state_code: u8,
    /// `ADDRESS:PORT` where the device itself thinks it is, if that is somewhere else.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub announced: Option<String>,
}

impl DiscoveredDevice {
    /// What a device has said, from this IPv4 address and port.
    pub fn new(address: [u8; 4], port: u16, item: &ListIdentityItem) -> Self {
        let own = &item.address;
        // 0.0.0.0 says nothing.
        let elsewhere = own.ip != [0; 4] && (own.ip, own.port) != (address, port);
        Self {
            address: dotted(address),
            port,
            vendor: named(table::vendor(item.vendor), item.vendor),
            vendor_id: item.vendor,
            device_type: named(table::device_type(item.device_type), item.device_type),
            device_type_id: item.device_type,
            product_code: item.product_code,
            revision: format!("{}.{:03}", item.major, item.minor),
            status: table::identity_status(item.status),
            status_word: item.status,
            serial: format!("{:08x}", item.serial),
            name: item.name.text(),
            state: table::identity_state(item.state)
                .map_or_else(|| format!("{:#04x}", item.state), ToString::to_string),
            state_code: item.state,
            announced: elsewhere.then(|| format!("{}:{}", dotted(own.ip), own.port)),
        }
    }
}

fn named(entry: Option<Entry>, number: u16) -> String {
    entry.map_or_else(|| format!("{number:#06x}"), |entry| entry.name.to_string())
}

fn dotted([a, b, c, d]: [u8; 4]) -> String {
    format!("{a}.{b}.{c}.{d}")
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::wire::{ShortString, SocketAddress};

    fn item() -> ListIdentityItem {
        ListIdentityItem {
            protocol_version: 1,
            address: SocketAddress::v4([192, 168, 1, 20], 44_818),
            vendor: 1,
            device_type: 2,
            product_code: 9,
            major: 1,
            minor: 2,
            status: 0x0030,
            serial: 0x00C0_FFEE,
            name: ShortString::new(b"drive").unwrap(),
            state: 3,
        }
    }

    #[test]
    fn a_known_device_is_all_words() {
        let device = DiscoveredDevice::new([192, 168, 1, 20], 44_818, &item());
        assert_eq!(
            serde_json::to_string(&device).unwrap(),
            r#"{"address":"192.168.1.20","port":44818,"vendor":"Rockwell Automation / Allen-Bradley","vendor_id":1,"device_type":"AC Drive Device","device_type_id":2,"product_code":9,"revision":"1.002","status":"no I/O connection","status_word":48,"serial":"00c0ffee","name":"drive","state":"operational","state_code":3}"#
        );
    }

    #[test]
    fn an_unknown_device_is_all_numbers_and_says_where_it_thinks_it_is() {
        let item = ListIdentityItem { vendor: 0xFFFE, device_type: 0xEE, state: 9, ..item() };
        let device = DiscoveredDevice::new([10, 0, 0, 7], 44_818, &item);
        assert_eq!((device.vendor.as_str(), device.device_type.as_str()), ("0xfffe", "0x00ee"));
        assert_eq!(
            (device.state.as_str(), device.announced.as_deref()),
            ("0x09", Some("192.168.1.20:44818"))
        );
    }
}
