//! The `MESSAGE` tags of an export, up to that of a whole project.

use alloc::collections::BTreeSet;
use alloc::format;
use alloc::string::String;
use alloc::vec::Vec;

use roxmltree::Node;

use super::super::dialect::Dialect;
use super::super::document;
use super::super::remark::{Remark, RemarkKind};
use super::super::{Found, Imported};
use super::logic::Rung;
use super::parameters::Parameters;
use super::project::Project;
use crate::plan::Severity;

/// Blocks from an L5X document.
pub(in super::super) fn import(text: &str) -> Imported {
    let mut imported = Imported::default();
    match document::parse(text) {
        Ok(document) => messages(&Project::new(&document, text), &mut imported),
        Err(remark) => imported.remarks.push(*remark),
    }
    imported
}

fn messages(project: &Project<'_, '_>, imported: &mut Imported) {
    let mut used = BTreeSet::new();
    for tag in project.tags().filter(|tag| is_message(*tag)) {
        used.insert(tag.id().get_usize());
        let parameters = tag.descendants().find(|node| node.has_tag_name("MessageParameters"));
        let Some(parameters) = parameters else {
            imported.remarks.push(project.error(tag, RemarkKind::Missing("MessageParameters".into())));
            continue;
        };
        match parameters.attribute("MessageType").unwrap_or_default() {
            "CIP Generic" => {}
            kind => {
                let words = format!(
                    "{}: a message of type {:?} is left out; only CIP Generic is one for any object",
                    tag.attribute("Name").unwrap_or_default(),
                    kind
                );
                imported.remarks.push(project.error(parameters, RemarkKind::Told(words)));
                continue;
            }
        }
        let mut reading = Parameters::new(project, tag, parameters);
        let config = reading.config();
        used.extend(reading.used.iter().map(|tag| tag.get_usize()));
        let range = tag.range();
        let [first, last] = [range.start, range.end].map(|at| project.place(at).0);
        imported.blocks.push(Found {
            config: config.into(),
            dialect: Dialect::L5x,
            lines: first..last + 1,
            remarks: reading.remarks,
        });
        if imported.is_full() {
            return;
        }
    }
    rest(project, imported, &used);
}

/// What of the document is about something else.
fn rest(project: &Project<'_, '_>, imported: &mut Imported, used: &BTreeSet<usize>) {
    let root = project.document.root_element();
    if imported.blocks.is_empty() && imported.remarks.is_empty() {
        let words = "no tag of type MESSAGE: there is nothing to read here";
        imported.remarks.push(project.error(root, RemarkKind::told(&words)));
        return;
    }
    let (starting, read) = starting(&project.rungs);
    let of_messages = |tag: &Node<'_, '_>| {
        let name = tag.attribute("Name").unwrap_or_default().to_ascii_lowercase();
        let is_logic = ["BOOL", "TIMER"].contains(&tag.attribute("DataType").unwrap_or_default());
        used.contains(&tag.id().get_usize()) || is_logic && starting.contains(&name)
    };
    let tags = project.tags().filter(|tag| !of_messages(tag)).count();
    let rungs = project.rungs.len().saturating_sub(read);
    let mut note = |words: String| {
        let remark = project.error(root, RemarkKind::Told(words));
        imported.remarks.push(Remark { severity: Severity::Note, ..remark });
    };
    if tags + rungs > 0 {
        note(format!("{tags} other tags and {rungs} rungs or statements without a MSG are not read"));
    }
    let protected = project.document.descendants().filter(|node| node.has_tag_name("EncodedData")).count();
    if protected > 0 {
        note(format!("{protected} protected parts cannot be read: what they do with a message is not known"));
    }
}

/// What the rungs that send name, also by way of a timer, and how many rungs these are.
fn starting(rungs: &[Rung]) -> (BTreeSet<String>, usize) {
    let base = |operand: &String| operand.split('.').next().unwrap_or_default().to_ascii_lowercase();
    let names = |rung: &Rung| -> Vec<String> {
        rung.instructions.iter().flat_map(|it| it.operands.iter().map(base)).collect()
    };
    let has = |rung: &Rung, name: &str| rung.instructions.iter().any(|it| it.name == name);
    let (sending, others): (Vec<&Rung>, Vec<&Rung>) = rungs.iter().partition(|rung| has(rung, "MSG"));
    let mut starting: BTreeSet<String> = sending.iter().flat_map(|rung| names(rung)).collect();
    let mut read = sending.len();
    for rung in others {
        let timers = rung.instructions.iter().filter(|it| it.name == "TON");
        if timers.filter_map(|it| it.operands.first()).any(|timer| starting.contains(&base(timer))) {
            starting.extend(names(rung));
            read += 1;
        }
    }
    (starting, read)
}

fn is_message(tag: Node<'_, '_>) -> bool {
    tag.attribute("DataType") == Some("MESSAGE")
}
