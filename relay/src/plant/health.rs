//! Whether a device answers, and what it says of itself.

use cipdeck_shared::api::{DeviceHealth, DeviceIdentity, HealthState};
use cipdeck_shared::table::{self, Entry};
use cipdeck_shared::wire::IdentityAttributes;

use crate::desk::{Lost, Why};
use crate::wall_clock;

/// What everybody sees of a device that has said who it is.
pub(super) fn good(identity: &IdentityAttributes) -> DeviceHealth {
    DeviceHealth {
        state: if is_fault(identity.status) { HealthState::Fault } else { HealthState::Good },
        words: table::identity_status(identity.status),
        status_word: Some(identity.status),
        identity: Some(DeviceIdentity {
            vendor: named(table::vendor(identity.vendor), identity.vendor),
            device_type: named(table::device_type(identity.device_type), identity.device_type),
            name: identity.name.text(),
            revision: format!("{}.{:03}", identity.major, identity.minor),
            serial: format!("{:08x}", identity.serial),
        }),
        at: Some(wall_clock::now()),
    }
}

/// What everybody sees of a device that does not answer; what it said before stays.
pub(super) fn lost(before: &DeviceHealth, lost: &Lost) -> DeviceHealth {
    let state = if lost.why == Why::Denied { HealthState::Denied } else { HealthState::Lost };
    DeviceHealth { state, words: lost.reason.clone(), status_word: None, ..before.clone() }
}

/// Minor and major faults, bits 8 to 11 of the status word, and the extended status "major fault". CIP Vol 1, 5A-2.
const fn is_fault(status: u16) -> bool {
    status & 0x0F00 != 0 || status >> 4 & 0xF == 5
}

fn named(entry: Option<Entry>, number: u16) -> String {
    entry.map_or_else(|| format!("{number:#06x}"), |entry| entry.name.to_owned())
}
