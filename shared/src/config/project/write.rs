//! A project → its files.

use alloc::collections::BTreeMap;
use alloc::format;
use alloc::string::String;

use serde::Serialize;

use super::super::block_config::BlockConfig;
use super::{PROJECT_HEAD, PROJECT_VERSION, Project, ProjectGroup, ProjectHead, ProjectTarget};

/// All files of a project.
pub fn files(project: &Project) -> BTreeMap<String, String> {
    let mut files = BTreeMap::new();
    files.insert(PROJECT_HEAD.into(), write_head(&project.head));
    for (name, block) in &project.blocks {
        files.insert(block_path(name), write_block(block));
    }
    for (name, target) in &project.targets {
        files.insert(target_path(name), write_target(target));
        for (group_name, group) in &target.groups {
            files.insert(group_path(name, group_name), write_group(group));
        }
    }
    files
}

/// `blocks/NAME.json`
pub fn block_path(name: &str) -> String {
    format!("blocks/{name}.json")
}

/// `targets/NAME.json`
pub fn target_path(name: &str) -> String {
    format!("targets/{name}.json")
}

/// `groups/TARGET/NAME.json`
pub fn group_path(target: &str, name: &str) -> String {
    format!("groups/{target}/{name}.json")
}

/// The text of `cipdeck.json`.
pub fn write_head(head: &ProjectHead) -> String {
    #[derive(Serialize)]
    struct Versioned<'a> {
        project: u64,
        #[serde(flatten)]
        head: &'a ProjectHead,
    }
    pretty(&Versioned { project: PROJECT_VERSION, head })
}

/// The text of a block's file.
pub fn write_block(block: &BlockConfig) -> String {
    pretty(block)
}

/// The text of a device's file, without its groups.
pub fn write_target(target: &ProjectTarget) -> String {
    pretty(target)
}

/// The text of a group's file.
pub fn write_group(group: &ProjectGroup) -> String {
    pretty(group)
}

/// Two spaces, members in the order of the structure, what is unknown last and by name, a line break at the end.
fn pretty(value: &impl Serialize) -> String {
    // Keys are texts, which is all that could fail.
    let mut text = serde_json::to_string_pretty(value).unwrap_or_default();
    text.push('\n');
    text
}
