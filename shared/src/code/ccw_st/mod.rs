//! Connected Components Workbench: Structured Text of Micro800 around one `MSG_CIPGENERIC`.
//!
//! Parameters and members: 2080-RM001D p. 177 to 195. From memory, because no public page shows them: that the editor
//! keeps declarations in tables, so that the section from VAR to END_VAR is to be typed there; the functions
//! `ANY_TO_…`, `AND_MASK`, `SHR` and `COP`; that `MemberId` begins at 0.

mod fields;
mod read;
mod write;

pub(super) use self::read::{import, is_positional};
pub(super) use self::write::export;

/// The parameters of the block, in their order.
const PARAMETERS: [&str; 7] = ["IN", "CtrlCfg", "AppCfg", "TargetCfg", "ReqData", "ReqLength", "ResData"];

#[cfg(test)]
mod tests;
