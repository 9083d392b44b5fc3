//! Projects as one file: what an upload does, or would do.

use alloc::string::String;
use alloc::vec::Vec;

use serde::{Deserialize, Serialize};

use super::rest::Finding;

/// `POST /api/v1/project` and `POST /api/v1/project/folder`, and with `?preview=true` what they would answer.
#[derive(Clone, Debug, Default, PartialEq, Eq, Serialize, Deserialize)]
#[cfg_attr(feature = "openapi", derive(utoipa::ToSchema))]
pub struct ProjectImport {
    /// Whether it was stored. Never in a preview.
    pub stored: bool,
    /// What people call the project.
    pub name: String,
    /// Everything in the project, and everything beside it that stays.
    pub parts: Vec<ProjectPart>,
    /// What is wrong with the files. `field` is the place: `blocks/drive.json:12:16`. With an error nothing is stored.
    pub findings: Vec<Finding>,
    /// Files that are none of a project's.
    pub ignored: Vec<String>,
    /// What the files of the folder are, in few characters: `seen` of a request that means these and no others. None of an
    /// archive.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub seen: Option<String>,
}

/// `GET /api/v1/project/folder`: what `serve --project` was given.
#[derive(Clone, Debug, Default, PartialEq, Eq, Serialize, Deserialize)]
#[cfg_attr(feature = "openapi", derive(utoipa::ToSchema))]
pub struct ProjectFolder {
    /// Where each change is written as files, as the relay's machine names it; absent: nowhere.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub folder: Option<String>,
}

/// A block, a target or a group, and what becomes of it.
#[derive(Clone, Debug, PartialEq, Eq, Serialize, Deserialize)]
#[cfg_attr(feature = "openapi", derive(utoipa::ToSchema))]
pub struct ProjectPart {
    /// What it is.
    pub what: ProjectPartKind,
    /// What becomes of it.
    pub how: ProjectChange,
    /// What people call it.
    pub name: String,
    /// The block, device or group that is meant; none of what a preview would make.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub id: Option<String>,
    /// Its file; none of what is not in the project.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub file: Option<String>,
    /// More in words, such as what becomes of a group's variables.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub detail: Option<String>,
}

/// What a part of a project is.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
#[cfg_attr(feature = "openapi", derive(utoipa::ToSchema))]
#[serde(rename_all = "lowercase")]
pub enum ProjectPartKind {
    /// A block.
    Block,
    /// A device.
    Target,
    /// A group with its variables.
    Group,
}

/// What becomes of a part.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Serialize, Deserialize)]
#[cfg_attr(feature = "openapi", derive(utoipa::ToSchema))]
#[serde(rename_all = "lowercase")]
pub enum ProjectChange {
    /// Nothing has this name yet.
    Created,
    /// What has this name is replaced.
    Changed,
    /// What has this name is the same already.
    Unchanged,
    /// Not in the project; it stays.
    Left,
    /// Its file is gone.
    Removed,
}
