//! Words for what `shared::code` names.

use cipdeck_shared::{
    code::{Dialect, Grade},
    plan::Severity,
};
use yew::AttrValue;

use super::i18n::tr;
use crate::kit::Shape;

/// The dialects by who makes the editor that takes them.
pub(super) fn groups() -> [(AttrValue, &'static [Dialect]); 5] {
    [
        (tr!("vendor.rockwell"), &[Dialect::CcwSt, Dialect::L5x]),
        (tr!("vendor.schneider"), &[Dialect::SendReqEtc100, Dialect::SendReqEtc101, Dialect::DataExch]),
        (tr!("vendor.omron"), &[Dialect::SysmacSt]),
        (tr!("vendor.programs"), &[Dialect::Pycomm3, Dialect::Rust, Dialect::Cli]),
        (tr!("vendor.data"), &[Dialect::Hex, Dialect::Json]),
    ]
}

/// A dialect in a list that names the vendor already.
pub(super) fn dialect(dialect: Dialect) -> AttrValue {
    match dialect {
        Dialect::CcwSt => tr!("dialect.ccw_st"),
        Dialect::L5x => tr!("dialect.l5x"),
        Dialect::SendReqEtc100 => tr!("dialect.etc100"),
        Dialect::SendReqEtc101 => tr!("dialect.etc101"),
        Dialect::DataExch => tr!("dialect.data_exch"),
        Dialect::SysmacSt => tr!("dialect.sysmac_st"),
        Dialect::Pycomm3 => tr!("dialect.pycomm3"),
        Dialect::Rust => tr!("dialect.rust"),
        Dialect::Cli => tr!("dialect.cli"),
        Dialect::Hex => tr!("dialect.hex"),
        Dialect::Json => tr!("dialect.json"),
    }
}

/// A grade: its word, its shape, its class.
pub(super) fn grade(grade: Grade) -> (AttrValue, Shape, &'static str) {
    match grade {
        Grade::Carried => (tr!("changes.carried"), Shape::Tick, "tick"),
        Grade::Adjusted => (tr!("changes.adjusted"), Shape::Half, "half"),
        Grade::Lost => (tr!("changes.lost"), Shape::Cross, "cross"),
        Grade::Request => (tr!("changes.request"), Shape::Cross, "cross loud"),
    }
}

/// A severity of a remark: its word, its shape, its class.
pub(super) fn severity(severity: Severity) -> (AttrValue, Shape, &'static str) {
    match severity {
        Severity::Error => (tr!("remarks.error"), Shape::Cross, "cross"),
        Severity::Warning => (tr!("remarks.warning"), Shape::Half, "half"),
        Severity::Note => (tr!("remarks.note"), Shape::Ring, "ring"),
    }
}

/// `1 block`, `3 blocks`.
pub(super) fn blocks(count: usize) -> AttrValue {
    if count == 1 { tr!("found.block") } else { tr!("found.blocks", count = count) }
}

/// `1 place not understood`, `3 places not understood`.
pub(super) fn errors(count: usize) -> AttrValue {
    if count == 1 { tr!("found.error") } else { tr!("found.errors", count = count) }
}

/// `1 to look at`, `3 to look at`.
pub(super) fn warnings(count: usize) -> AttrValue {
    if count == 1 { tr!("found.warning") } else { tr!("found.warnings", count = count) }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn every_dialect_is_in_one_group() {
        let mut listed: Vec<_> = groups().iter().flat_map(|(_, dialects)| dialects.iter().copied()).collect();
        listed.sort();
        let mut all = Dialect::ALL;
        all.sort();
        assert_eq!(listed, all);
    }
}
