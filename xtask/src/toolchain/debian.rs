//! x
use super::{Preference, WasmToolchain};
use anyhow::{Result, bail};
pub(super) fn linked() -> Option<WasmToolchain> {
    None
}
pub(super) fn is_possible() -> bool {
    false
}
pub(super) fn toolchain(_: &Preference) -> Result<WasmToolchain> {
    bail!("no")
}
