//! What a device says about its condition: Identity attribute 5 and the state at the end of `ListIdentity`. Sources:
//! OpENer `cipidentity.h`; pycomm3 `status_info.py`.

use alloc::format;
use alloc::string::String;
use alloc::vec::Vec;

/// Whose it is, and whether it has been set up.
const OWNERSHIP: [(u16, &str); 2] = [(1 << 0, "owned"), (1 << 2, "configured")];

/// What is broken.
const FAULTS: [(u16, &str); 4] = [
    (1 << 8, "minor recoverable fault"),
    (1 << 9, "minor unrecoverable fault"),
    (1 << 10, "major recoverable fault"),
    (1 << 11, "major unrecoverable fault"),
];

/// Bits 4 to 7: the extended device status. Numbers above are a vendor's own.
const EXTENDED: [&str; 8] = [
    "self test or unknown",
    "firmware update in progress",
    "an I/O connection is faulted",
    "no I/O connection",
    "saved configuration is bad",
    "major fault",
    "an I/O connection is in run mode",
    "all I/O connections are idle",
];

/// Bits 1, 3 and 12 to 15: reserved, or a vendor's own. Logix controllers tell the position of their key here.
const OTHER: u16 = 0xF00A;

/// The status word of the Identity object (attribute 5) in words, never empty:
/// `owned, configured, an I/O connection is in run mode`.
pub fn identity_status(status: u16) -> String {
    let extended = status >> 4 & 0xF;
    let extended = match EXTENDED.get(usize::from(extended)) {
        Some(words) => String::from(*words),
        None => format!("extended device status {extended:#03x}"),
    };
    let flag = |(bit, words): &(u16, &'static str)| (status & bit != 0).then(|| String::from(*words));
    let mut parts: Vec<_> = OWNERSHIP.iter().filter_map(flag).collect();
    parts.push(extended);
    parts.extend(FAULTS.iter().filter_map(flag));
    if status & OTHER != 0 {
        parts.push(format!("other bits {:#06x}", status & OTHER));
    }
    parts.join(", ")
}

/// The state at the end of a `ListIdentity` reply.
pub const fn identity_state(state: u8) -> Option<&'static str> {
    Some(match state {
        0 => "nonexistent",
        1 => "self test",
        2 => "standby",
        3 => "operational",
        4 => "major recoverable fault",
        5 => "major unrecoverable fault",
        // Also what is said of a device that leaves it out.
        255 => "not given",
        _ => return None,
    })
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_status_word_reads_as_its_bits() {
        for (status, words) in [
            (0x0000, "self test or unknown"),
            (0x0030, "no I/O connection"),
            (0x0065, "owned, configured, an I/O connection is in run mode"),
            (0x0150, "major fault, minor recoverable fault"),
            (
                0x0E54,
                "configured, major fault, minor unrecoverable fault, major recoverable fault, major unrecoverable fault",
            ),
            (0x00F0, "extended device status 0xf"),
            (0x8032, "no I/O connection, other bits 0x8002"),
        ] {
            assert_eq!(identity_status(status), words, "{status:#06x}");
        }
    }

    #[test]
    fn no_status_word_is_without_words() {
        assert!((0..=u16::MAX).all(|status| !identity_status(status).is_empty()));
    }
}
