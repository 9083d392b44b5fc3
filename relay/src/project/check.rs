//! What is wrong with what files say, beside their form: the findings that the page shows, each with its place.

use std::collections::BTreeMap;
use std::path::Path;

use cipdeck_shared::api::Finding;
use cipdeck_shared::config::project::{
    Places, ProjectError, ProjectGroup, ProjectVariable, Read, addresses, block_path, group_path, parents,
    read, target_path,
};
use cipdeck_shared::config::{DeviceId, GroupConfig, GroupId, Variable, VariableId};
use cipdeck_shared::plan::plant::{self, MAX_IN_GROUP, PlantFinding};
use cipdeck_shared::plan::{MessagePlan, Severity};
use cipdeck_shared::tag::Types;

use super::{FilesError, Folder};
use crate::plant::{MAX_DEVICES, MAX_GROUPS};

/// The rule of what is wrong with a file as a file.
pub(crate) const FILE_RULE: &str = "project_file";

/// A folder as it is, and what is to be said of it.
#[derive(Debug)]
pub(crate) struct Looked {
    /// None, if something in it is no file of a project at all, such as a link.
    pub(crate) folder: Option<Folder>,
    pub(crate) read: Read,
    pub(crate) findings: Vec<Finding>,
}

impl Looked {
    /// Reads a folder that is there.
    pub(crate) fn at(root: &Path) -> Result<Self, FilesError> {
        match Folder::read(root) {
            Ok(folder) => {
                let (read, findings) = found(folder.files());
                Ok(Self { folder: Some(folder), read, findings })
            }
            Err(FilesError::Wrong(errors)) => {
                let read = Read { errors, ..Read::default() };
                let findings = findings(&BTreeMap::new(), &read);
                Ok(Self { folder: None, read, findings })
            }
            Err(error) => Err(error),
        }
    }
}

/// What files say, and what is to be said of them.
pub(crate) fn found(files: &BTreeMap<String, String>) -> (Read, Vec<Finding>) {
    let read = read(files);
    let findings = findings(files, &read);
    (read, findings)
}

/// Everything that is wrong, and everything that somebody should know, by file. `field` is the place.
pub(crate) fn findings(files: &BTreeMap<String, String>, read: &Read) -> Vec<Finding> {
    let mut found = Found { files, findings: Vec::new(), at: None };
    for error in &read.errors {
        found.of_files(error, Severity::Error);
    }
    for warning in &read.warnings {
        found.of_files(warning, Severity::Warning);
    }
    for (file, block) in &read.project.blocks {
        let path = read.origins.get(file).cloned().unwrap_or_else(|| block_path(file));
        let (_, all) = MessagePlan::check(block);
        for finding in all.iter().filter(|finding| finding.severity != Severity::Note) {
            let (field, words) = (finding.field.to_string(), finding.rule.to_string());
            found.add(&path, &field, finding.severity, finding.rule.name(), &words);
        }
    }
    found.at_most("targets", read.project.targets.len(), MAX_DEVICES);
    for (file, target) in &read.project.targets {
        let plan = plant::device(&target.config);
        let path = target_path(file);
        found.of_plant(&path, "", plan.as_ref().err().map_or(&[][..], Vec::as_slice));
        found.at_most(&path, target.groups.len(), MAX_GROUPS);
        let types = plan.map(|plan| plan.types).unwrap_or_default();
        for (name, group) in &target.groups {
            found.group(&group_path(file, name), group, &types);
        }
    }
    found.leave();
    found.findings
}

struct Found<'a> {
    files: &'a BTreeMap<String, String>,
    findings: Vec<Finding>,
    at: Option<At<'a>>,
}

/// The file that is looked at.
struct At<'a> {
    path: String,
    places: Option<Places<'a>>,
    told: usize,
    /// What is not told one by one, and the worst of it.
    more: Option<(usize, Severity)>,
}

/// Of one file so much is told one by one.
const MAX_TOLD: usize = 100;

impl Found<'_> {
    fn of_files(&mut self, error: &ProjectError, severity: Severity) {
        let place = error.position.map(|place| format!(":{}:{}", place.line, place.column));
        let field = format!("{}{}", error.file, place.unwrap_or_default());
        self.push(field, severity, FILE_RULE, error.what.to_string());
    }

    fn group(&mut self, path: &str, group: &ProjectGroup, types: &Types) {
        // Ids that mean nothing: whether they are right does not depend on them.
        let config = GroupConfig {
            device: DeviceId(0),
            name: group.name.clone(),
            period_ms: group.period_ms,
            on: group.on,
            order: group.order,
        };
        self.of_plant(path, "", plant::group(&config).err().as_deref().unwrap_or_default());
        self.at_most(path, group.variables.len(), MAX_IN_GROUP);
        let id = |place: usize| VariableId(u32::try_from(place).unwrap_or(u32::MAX));
        let Ok(parents) = parents(&group.variables) else { return };
        let variable = |(place, (variable, parent)): (usize, (&ProjectVariable, Option<usize>))| {
            let mut config = variable.config.clone();
            config.parent = parent.map(id);
            Variable { id: id(place), revision: 0, group: GroupId(0), config }
        };
        let all: Vec<_> = group.variables.iter().zip(parents).enumerate().map(variable).collect();
        let addresses = addresses(&group.variables);
        for (variable, plan) in plant::variables(&all, types) {
            let place = variable.0 as usize;
            if let Err(findings) = plan {
                let address = addresses.get(place).map(|address| format!("{address}: ")).unwrap_or_default();
                self.of_variable(path, place, &address, &findings);
            }
        }
    }

    fn of_variable(&mut self, path: &str, place: usize, address: &str, findings: &[PlantFinding]) {
        for finding in findings {
            let field = format!("variables[{place}].{}", finding.field);
            let words = format!("{address}{}", finding.rule);
            self.add(path, &field, Severity::Error, finding.rule.key(), &words);
        }
    }

    fn of_plant(&mut self, path: &str, prefix: &str, findings: &[PlantFinding]) {
        for finding in findings {
            let field = format!("{prefix}{}", finding.field);
            self.add(path, &field, Severity::Error, finding.rule.key(), &finding.rule.to_string());
        }
    }

    fn at_most(&mut self, path: &str, there: usize, max: usize) {
        if there > max {
            let words = format!("there are {there} here, and no more than {max} fit");
            self.push(path.to_owned(), Severity::Error, "too_many", words);
        }
    }

    /// A finding about a member of a file, at its place.
    fn add(&mut self, path: &str, field: &str, severity: Severity, rule: &str, words: &str) {
        if self.at.as_ref().is_none_or(|at| at.path != path) {
            self.leave();
            let places = self.files.get(path).and_then(|text| Places::of(text));
            self.at = Some(At { path: path.to_owned(), places, told: 0, more: None });
        }
        let Some(at) = &mut self.at else { return };
        at.told += 1;
        if at.told > MAX_TOLD {
            let (count, worst) = at.more.unwrap_or((0, severity));
            at.more = Some((count + 1, worst.min(severity)));
            return;
        }
        let place = at.places.as_ref().map(|places| places.locate(field));
        let place = place.map(|place| format!(":{}:{}", place.line, place.column)).unwrap_or_default();
        self.push(format!("{path}{place}"), severity, rule, format!("{field}: {words}"));
    }

    /// All of a file has been said.
    fn leave(&mut self) {
        let Some(At { path, more: Some((count, worst)), .. }) = self.at.take() else { return };
        self.push(path, worst, "more", format!("and {count} more in this file"));
    }

    fn push(&mut self, field: String, severity: Severity, rule: &str, message: String) {
        let rule = rule.to_owned();
        self.findings.push(Finding {
            field,
            severity,
            rule,
            message,
            min: None,
            max: None,
            error_id: None,
            sub_error_id: None,
            communication_report: None,
        });
    }
}
