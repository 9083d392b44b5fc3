//! Refusals of tag services in words.

use alloc::string::String;
use core::fmt::Write;

use crate::table;
use crate::wire::GeneralStatus;

/// What a general status and the first word behind it mean: `0xFF, extended 0x2107: Tag type in request differs …`.
pub fn refusal(status: GeneralStatus, extended: Option<u16>) -> String {
    // 0 says nothing more: cpppo has it behind each status, and the table's "out of memory" would mislead.
    let extended = extended.filter(|word| *word != 0);
    let mut text = alloc::format!("{status}");
    if let Some(entry) = table::general_status(status) {
        // Writing to a String never fails.
        let _ = write!(text, " {}", entry.name);
    }
    if let Some(extended) = extended {
        let _ = write!(text, ", extended {extended:#06x}");
        if let Some(entry) = table::extended_status(status, extended) {
            let _ = write!(text, ": {}", entry.name);
            if !entry.meaning.is_empty() {
                let _ = write!(text, " ({})", entry.meaning);
            }
        }
    }
    if extended.is_none()
        && let Some(hint) = hint(status)
    {
        let _ = write!(text, ": {hint}");
    }
    text
}

/// What a plain status means where a tag was asked for.
const fn hint(status: GeneralStatus) -> Option<&'static str> {
    match status {
        GeneralStatus::PathSegmentError => {
            Some("the device has no tag of this name, or does not show it to others")
        }
        GeneralStatus::PathDestinationUnknown => {
            Some("there is no such tag or element; is an index outside of the array?")
        }
        _ => None,
    }
}

/// Whether a refusal is about this one tag: asking for it again soon changes nothing, and others are not concerned.
pub const fn is_about_the_tag(status: GeneralStatus) -> bool {
    matches!(
        status,
        GeneralStatus::PathSegmentError
            | GeneralStatus::PathDestinationUnknown
            | GeneralStatus::ObjectStateConflict
            | GeneralStatus::PrivilegeViolation
            | GeneralStatus::VendorSpecific
            | GeneralStatus::InvalidParameter
            | GeneralStatus::PathSizeInvalid
            | GeneralStatus::ObjectSpecific
            | GeneralStatus::NotEnoughData
            | GeneralStatus::TooMuchData
    )
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_refusal_says_what_it_is_about() {
        for (status, extended, words) in [
            (
                0x04,
                None,
                "0x04 Path segment error: the device has no tag of this name, or does not show it to others",
            ),
            (0x05, Some(0), "there is no such tag or element"),
            (0xFF, Some(0x2107), "extended 0x2107: Tag type in request differs from tag data type"),
            (0x20, Some(0x8022), "extended 0x8022: Data type differs from the variable"),
            (0x20, Some(0x8FFF), "extended 0x8fff"),
        ] {
            let said = refusal(GeneralStatus(status), extended);
            assert!(said.contains(words), "{said}");
        }
        assert!(!refusal(GeneralStatus(5), Some(0)).contains("memory"));
    }
}
