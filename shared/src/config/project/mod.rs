//! A project: blocks, targets, and what is read of them, as a folder of small files.
//!
//! | file | what |
//! | --- | --- |
//! | `cipdeck.json` | the version of the layout, and what people call the project |
//! | `blocks/NAME.json` | a block |
//! | `targets/NAME.json` | a device |
//! | `groups/TARGET/NAME.json` | a group of the device `targets/TARGET.json`, with its variables |
//!
//! Files and their text come in, files and their text go out; where they are kept is the caller's. A file holds what
//! people have entered: no ids, no revisions, no times, so that equal content is equal text. Members that this version
//! does not know are kept. Numbers with fractions are kept to the last digit where serde_json is built with
//! `float_roundtrip`, as the relay does.

mod culprit;
mod document;
mod error;
mod name;
mod place;
mod read;
mod reader;
mod scan;
mod variables;
mod write;

use alloc::collections::BTreeMap;
use alloc::string::String;
use alloc::vec::Vec;

use serde::{Deserialize, Serialize};

pub use self::document::{Places, twice};
pub use self::error::{ProjectError, ProjectErrorKind};
pub use self::name::{file_name, free_file_name, is_portable};
pub use self::place::Position;
pub use self::read::{Read, block, group, read, target};
pub use self::variables::{addresses, parents};
pub use self::write::{
    block_path, files, group_path, target_path, write_block, write_group, write_head, write_target,
};

use super::block_config::BlockConfig;
use super::device::DeviceConfig;
use super::group::GROUP_PERIOD_MS;
use super::msg_cip_generic::Extra;
use super::variable::VariableConfig;

/// The version of the layout that is written.
pub const PROJECT_VERSION: u64 = 1;

/// The file that makes a folder a project.
pub const PROJECT_HEAD: &str = "cipdeck.json";

/// Files of a project. Our own limit.
pub const MAX_PROJECT_FILES: usize = 20_000;

/// Bytes of one file. Our own limit; a group of 10,000 variables fits.
pub const MAX_PROJECT_FILE: usize = 8 * 1024 * 1024;

/// Bytes of all files together. Our own limit.
pub const MAX_PROJECT_BYTES: usize = 64 * 1024 * 1024;

/// Everything that is in a project. The keys are names of files, without their ending.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Project {
    /// What `cipdeck.json` says.
    pub head: ProjectHead,
    /// `blocks/KEY.json`
    pub blocks: BTreeMap<String, BlockConfig>,
    /// `targets/KEY.json`
    pub targets: BTreeMap<String, ProjectTarget>,
}

/// What the file `cipdeck.json` says beside the version.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct ProjectHead {
    /// What people call the project.
    #[serde(default)]
    pub name: String,
    /// Unknown members.
    #[serde(flatten)]
    pub extra: Extra,
}

/// A device with its groups.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct ProjectTarget {
    /// What people have entered.
    #[serde(flatten)]
    pub config: DeviceConfig,
    /// Unknown members.
    #[serde(flatten)]
    pub extra: Extra,
    /// `groups/TARGET/KEY.json`, in files of their own.
    #[serde(skip)]
    pub groups: BTreeMap<String, ProjectGroup>,
}

/// A group with its variables.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct ProjectGroup {
    /// What people call it.
    pub name: String,
    /// ms from the begin of one reading to the begin of the next.
    #[serde(default = "period_ms")]
    pub period_ms: i64,
    /// Whether it is read at all.
    #[serde(default)]
    pub on: bool,
    /// Its place among the groups of the device.
    #[serde(default)]
    pub order: i64,
    /// Those that are read together.
    #[serde(default)]
    pub variables: Vec<ProjectVariable>,
    /// Unknown members.
    #[serde(flatten)]
    pub extra: Extra,
}

/// A variable of a group.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct ProjectVariable {
    /// The full address of the structure or array that it is a part of: another variable of the same file.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub parent_address: Option<String>,
    /// What people have entered. Its `parent`, an id, means nothing here.
    #[serde(flatten)]
    pub config: VariableConfig,
    /// Unknown members.
    #[serde(flatten)]
    pub extra: Extra,
}

const fn period_ms() -> i64 {
    GROUP_PERIOD_MS
}

#[cfg(test)]
mod tests;
