//! What is stored → a project.

use std::collections::BTreeMap;

use cipdeck_shared::config::project::{
    Project, ProjectGroup, ProjectTarget, ProjectVariable, free_file_name, is_portable,
};
use cipdeck_shared::config::{Variable, full_addresses};

use crate::store::{StoredGroup, StoredProject, StoredTarget};

/// Everything, under the names of files that are known, and new ones for the rest.
pub(crate) fn project_of(stored: &StoredProject) -> Project {
    let mut project = Project { head: stored.head.clone().unwrap_or_default(), ..Project::default() };
    for one in &stored.blocks {
        let file = file(one.file.as_deref(), one.block.config.name(), &project.blocks);
        project.blocks.insert(file, one.block.config.clone());
    }
    for one in &stored.targets {
        let mut target = target_of(one);
        for group in &one.groups {
            let file = file(group.file.as_deref(), &group.group.config.name, &target.groups);
            target.groups.insert(file, group_of(group));
        }
        let file = file(one.file.as_deref(), &one.device.config.name, &project.targets);
        project.targets.insert(file, target);
    }
    project
}

fn file<T>(known: Option<&str>, name: &str, taken: &BTreeMap<String, T>) -> String {
    let is_taken = |file: &str| taken.keys().any(|there| there.eq_ignore_ascii_case(file));
    match known.filter(|file| is_portable(file) && !is_taken(file)) {
        Some(file) => file.to_owned(),
        None => free_file_name(name, is_taken),
    }
}

/// A device, without its groups.
pub(crate) fn target_of(stored: &StoredTarget) -> ProjectTarget {
    let (config, extra) = (stored.device.config.clone(), stored.extra.clone());
    ProjectTarget { config, extra, groups: BTreeMap::new() }
}

/// A group with its variables, in their order.
pub(crate) fn group_of(stored: &StoredGroup) -> ProjectGroup {
    let all: Vec<Variable> = stored.variables.iter().map(|(variable, _)| variable.clone()).collect();
    let addresses: BTreeMap<_, _> =
        all.iter().map(|variable| variable.id).zip(full_addresses(&all)).collect();
    let variables = stored.variables.iter().map(|(variable, extra)| {
        let mut config = variable.config.clone();
        let parent_address = config.parent.take().and_then(|parent| addresses.get(&parent).cloned());
        ProjectVariable { parent_address, config, extra: extra.clone() }
    });
    let config = &stored.group.config;
    ProjectGroup {
        name: config.name.clone(),
        period_ms: config.period_ms,
        on: config.on,
        order: config.order,
        variables: variables.collect(),
        extra: stored.extra.clone(),
    }
}
