//! Connected Components Workbench: Structured Text of Micro800 around one `MSG_CIPGENERIC`.
//!
//! Parameters and members: 2080-RM001D p. 177 to 195. `COP` is a function block and works by bytes between any two types
//! (p. 304). That types are never converted by themselves, hence `ANY_TO_…`: public programs for CCW. From memory: that the
//! editor keeps declarations in tables, so that the section from VAR to END_VAR is to be typed there; `AND_MASK` and `SHR`;
//! the parameters of `COP`, and that its length counts elements of the destination; that `MemberId` begins at 0.

mod fields;
mod read;
mod write;

pub(super) use self::read::{import, is_instance, is_positional};
pub(super) use self::write::export;

/// The parameters of the block, in their order.
const PARAMETERS: [&str; 7] = ["IN", "CtrlCfg", "AppCfg", "TargetCfg", "ReqData", "ReqLength", "ResData"];

#[cfg(test)]
mod tests;
