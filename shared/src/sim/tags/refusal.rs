//! What is wrong with a request, and how each family says so.
//!
//! Logix: 1756-PM020 as pycomm3 status_info.py has it. Omron: W506 8-6 as aphyt cip.py has it. Micro800: the statuses
//! of a Logix without the vendor's words; what a real one adds is not known to us.

use alloc::vec::Vec;

use crate::tag::Dialect;
use crate::wire::GeneralStatus;

use crate::sim::request::Refusal;

/// Why a request about a tag is not carried out.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Wrong {
    /// There is no such tag, no such member, or it is not to be seen.
    Missing,
    /// More than one element of what is no array.
    NoArray,
    /// No element, or elements behind the end.
    Outside,
    /// Bytes behind the end.
    PastEnd,
    /// A part by bytes of what has no parts.
    NotInParts,
    /// The type in the request is not that of the tag.
    Kind,
    /// Neither 0 nor 2 bytes between type and data.
    AddInfo,
    /// It can only be read.
    ReadOnly,
    /// A value that the variable cannot have.
    Value,
    /// The request ends too early.
    Short,
    /// The request goes on.
    Long,
    /// The reply does not fit.
    TooLarge,
    /// Not of this kind of controller.
    Service,
}

impl Wrong {
    /// In the words of the family.
    pub(super) fn refusal(self, dialect: Dialect) -> Refusal {
        let (status, words) = match dialect {
            Dialect::Logix => self.logix(),
            Dialect::Micro800 => (self.logix().0, &[][..]),
            Dialect::Omron => self.omron(),
        };
        let additional: Vec<u8> = words.iter().copied().flat_map(u16::to_le_bytes).collect();
        Refusal { additional, ..Refusal::from(status) }
    }

    const fn logix(self) -> (GeneralStatus, &'static [u16]) {
        match self {
            Self::Missing => (GeneralStatus::PathSegmentError, &[]),
            Self::NoArray | Self::Outside | Self::PastEnd => (GeneralStatus::ObjectSpecific, &[0x2105]),
            Self::Kind | Self::AddInfo => (GeneralStatus::ObjectSpecific, &[0x2107]),
            Self::Value => (GeneralStatus::ObjectSpecific, &[0x2002]),
            Self::NotInParts => (GeneralStatus::ObjectSpecific, &[0x201C]),
            Self::ReadOnly => (GeneralStatus::PrivilegeViolation, &[]),
            _ => (self.common(), &[]),
        }
    }

    const fn omron(self) -> (GeneralStatus, &'static [u16]) {
        const PARAMETER: GeneralStatus = GeneralStatus::InvalidParameter;
        match self {
            Self::Missing => (GeneralStatus::PathSegmentError, &[]),
            Self::NoArray => (PARAMETER, &[0x8017]),
            Self::Outside => (PARAMETER, &[0x8018]),
            Self::AddInfo => (PARAMETER, &[0x8021]),
            Self::Kind => (PARAMETER, &[0x8022]),
            Self::Value => (PARAMETER, &[0x8028]),
            Self::NotInParts => (PARAMETER, &[0x8029]),
            // Two words each: a constant or read-only variable; past a segment's boundary.
            Self::ReadOnly => (GeneralStatus::VendorSpecific, &[0x0102, 0x2103]),
            Self::PastEnd => (GeneralStatus::VendorSpecific, &[0x0104, 0x1103]),
            _ => (self.common(), &[]),
        }
    }

    const fn common(self) -> GeneralStatus {
        match self {
            Self::Long => GeneralStatus::TooMuchData,
            Self::TooLarge => GeneralStatus::ReplyDataTooLarge,
            Self::Service => GeneralStatus::ServiceNotSupported,
            _ => GeneralStatus::NotEnoughData,
        }
    }
}
