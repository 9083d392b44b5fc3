//! Reports of SEND_REQ and DATA_EXCH: the two bytes of `Management_Param[1]`.

use super::Entry;
use super::tsv::{Row, Table};

const REPORTS: Table = Table::new(include_str!("../../data/reports.tsv"));

/// Communication report 16#FF: the operation report says why.
pub const MESSAGE_REFUSED: u8 = 0xFF;

/// Which list of operation reports a module has.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum ReportList {
    /// TSX ETC 100.
    Etc100,
    /// DATA_EXCH of BMX NOC 0401 and M580. That a TSX ETC 101 has the same is inferred: its help comes from the same book.
    DataExch,
}

/// The low byte of `Management_Param[1]`: how the exchange went.
pub fn communication_report(code: u8) -> Option<Entry> {
    find(0, code.into())
}

/// The high byte of `Management_Param[1]`, which depends on the low one.
pub fn operation_report(list: ReportList, communication: u8, code: u8) -> Option<Entry> {
    let group = match (list, communication) {
        (ReportList::Etc100, 0) => 1,
        (ReportList::Etc100, _) => 2,
        (ReportList::DataExch, _) => 3,
    };
    find(group, code.into())
}

/// Event codes that such a module shows to MBP_MSTR, and in its diagnostics.
pub fn module_event(code: u16) -> Option<Entry> {
    find(4, code.into())
}

fn find(group: u32, code: u32) -> Option<Entry> {
    REPORTS.find(Some(group), Some(code)).map(Row::entry)
}
