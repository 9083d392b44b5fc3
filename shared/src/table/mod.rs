//! Codes of the outside world in words: what a number is called, what it means, and how well that is known.
//!
//! The tables are `data/*.tsv`, compiled in. A number that is in none of them is simply not found: callers print
//! it as it is.

mod access;
mod attribute;
mod identity;
mod report;
mod tsv;

use crate::wire::{EncapsulationStatus, GeneralStatus, ServiceCode};

pub use self::access::{Access, classify};
pub use self::attribute::{Field, FieldKind, attribute};
pub use self::identity::{identity_state, identity_status};
pub use self::report::{MESSAGE_REFUSED, ReportList, communication_report, module_event, operation_report};
use self::tsv::Table;

const SERVICES: Table = Table::new(include_str!("../../data/services.tsv"));
const CLASSES: Table = Table::new(include_str!("../../data/classes.tsv"));
const GENERAL_STATUS: Table = Table::new(include_str!("../../data/general_status.tsv"));
const CONNECTION_MANAGER_STATUS: Table =
    Table::new(include_str!("../../data/extended_status_connection_manager.tsv"));
const OTHER_EXTENDED_STATUS: Table = Table::new(include_str!("../../data/extended_status_other.tsv"));
const ENCAPSULATION_STATUS: Table = Table::new(include_str!("../../data/encapsulation_status.tsv"));
const BLOCK_ERRORS: Table = Table::new(include_str!("../../data/block_errors.tsv"));
const VENDORS: Table = Table::new(include_str!("../../data/vendors.tsv"));
const DEVICE_TYPES: Table = Table::new(include_str!("../../data/device_types.tsv"));
const DATA_TYPES: Table = Table::new(include_str!("../../data/data_types.tsv"));

/// What is known about one code.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Entry {
    /// The number that was looked up; in a row about a whole `ErrorID`, that `ErrorID`.
    pub code: u32,
    /// Short, as the source spells it. Never empty.
    pub name: &'static str,
    /// What it is, in a sentence. May be empty.
    pub meaning: &'static str,
    /// What to look at, or what the data is. May be empty.
    pub hint: &'static str,
    /// How well this is known.
    pub confidence: Confidence,
    /// Where it can be checked.
    pub source: &'static str,
}

/// How well a row is known.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Confidence {
    /// Seen in the named source.
    Confirmed,
    /// Follows from confirmed facts.
    Inferred,
    /// From memory of a document; nobody has checked it.
    Recalled,
    /// Somebody who uses such a device wrote so.
    FieldReport,
    /// In the source, but it looks wrong there.
    Doubtful,
}

impl Confidence {
    /// The word to print.
    pub const fn word(self) -> &'static str {
        match self {
            Self::Confirmed => "confirmed",
            Self::Inferred => "inferred",
            Self::Recalled => "recalled",
            Self::FieldReport => "field report",
            Self::Doubtful => "doubtful",
        }
    }

    fn parse(column: &str) -> Option<Self> {
        Some(match column {
            "CONFIRMED" => Self::Confirmed,
            "INFERRED" => Self::Inferred,
            "RECALLED" => Self::Recalled,
            "FIELD_REPORT" => Self::FieldReport,
            "DOUBTFUL" => Self::Doubtful,
            _ => return None,
        })
    }
}

/// From this service code up a number means different things per class.
const FIRST_CLASS_SPECIFIC: u8 = 0x32;

/// A service: as the class defines it, otherwise as all classes have it. From 0x32 up only the class tells.
/// For a symbolic path take the class [`Symbol`](crate::wire::ClassCode::Symbol).
pub fn service(class: u16, code: ServiceCode) -> Option<Entry> {
    service_row(class, code).map(tsv::Row::entry)
}

fn service_row(class: u16, code: ServiceCode) -> Option<tsv::Row> {
    let number = Some(code.0.into());
    let own = SERVICES.find(Some(class.into()), number);
    own.or_else(|| if code.0 < FIRST_CLASS_SPECIFIC { SERVICES.find(None, number) } else { None })
}

/// A class (object type).
pub fn class(code: u16) -> Option<Entry> {
    plain(CLASSES, code.into())
}

/// General status of a CIP reply.
pub fn general_status(status: GeneralStatus) -> Option<Entry> {
    plain(GENERAL_STATUS, status.0.into())
}

/// First additional status word of a CIP reply. Under general status 0x01 it is the Connection Manager's,
/// otherwise a vendor's: `meaning` names the family.
pub fn extended_status(general: GeneralStatus, ext: u16) -> Option<Entry> {
    let table = match general {
        GeneralStatus::ConnectionFailure => CONNECTION_MANAGER_STATUS,
        _ => OTHER_EXTENDED_STATUS,
    };
    table.find(Some(general.0.into()), Some(ext.into())).map(tsv::Row::entry)
}

/// Status of an encapsulation reply.
pub fn encapsulation_status(status: EncapsulationStatus) -> Option<Entry> {
    plain(ENCAPSULATION_STATUS, status.0)
}

/// `ErrorID` and `SubErrorID` of a block's `CIPSTATUS`; an unknown `SubErrorID` gives the row of its `ErrorID`.
/// The `SubErrorID` of 224 is a general status: see [`general_status`].
pub fn block_error(error_id: u16, sub_error_id: u16) -> Option<Entry> {
    let group = Some(error_id.into());
    let row = BLOCK_ERRORS.find(group, Some(sub_error_id.into()));
    row.or_else(|| BLOCK_ERRORS.find(group, None)).map(tsv::Row::entry)
}

/// A vendor by the id that the specification's owner gave it: those a plant is likely to meet.
pub fn vendor(id: u16) -> Option<Entry> {
    plain(VENDORS, id.into())
}

/// A device type (profile).
pub fn device_type(code: u16) -> Option<Entry> {
    plain(DEVICE_TYPES, code.into())
}

/// A data type code, as in tag services.
pub fn data_type(code: u16) -> Option<Entry> {
    plain(DATA_TYPES, code.into())
}

fn plain(table: Table, code: u32) -> Option<Entry> {
    table.find(None, Some(code)).map(tsv::Row::entry)
}

#[cfg(test)]
mod tests;
