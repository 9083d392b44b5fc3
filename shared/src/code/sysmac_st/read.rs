//! Statements → blocks.

use alloc::collections::{BTreeMap, BTreeSet};
use alloc::string::{String, ToString};
use alloc::vec::Vec;

use super::block::{Block, Types};
use super::instruction::{Instruction, Site};
use crate::code::dialect::Dialect;
use crate::code::remark::{Remark, RemarkKind};
use crate::code::text::{Call, Expression, Item, Memory, Reading, Script, Statement, left_over};
use crate::code::{Found, Imported};
use crate::plan::Severity;

/// Whether a call without declarations is one of an NJ or NX, by its name.
pub(in crate::code) fn is_instance(name: &str) -> bool {
    Instruction::of_name(name).is_some()
}

/// Blocks from Structured Text of an NJ or NX.
pub(in crate::code) fn import(text: &str) -> Imported {
    let script = Script::read(text);
    let mut imported = Imported { blocks: Vec::new(), remarks: script.remarks.clone() };
    let types = types(&script);
    let sites = sites(&script, &types);
    let mut memory = Memory::new(&script);
    let mut names = BTreeSet::new();
    let mut left = sites.iter().peekable();
    for (index, item) in script.items.iter().enumerate() {
        if let Some(site) = left.next_if(|site| site.item == index) {
            names.extend(variables(site.call));
            if site.only_resets() {
                let what = RemarkKind::NoEffect("a call with Execute := FALSE".to_string());
                let (line, column) = (item.place.line, item.place.column);
                imported.remarks.push(Remark::note(line, column, script.source(item), what));
            } else if matches!(site.instruction, Instruction::Unconnected | Instruction::Send) {
                let reading = Reading::new(&script, &memory, item);
                let mut block = Block { site, types: &types, reading };
                let config = block.config(&sites, &script, imported.blocks.len() + 1);
                let (lines, remarks) = (block.reading.lines(), block.reading.remarks);
                let dialect = Dialect::SysmacSt;
                imported.blocks.push(Found { config: config.into(), dialect, lines, remarks });
                if imported.is_full() {
                    return imported;
                }
            }
        }
        memory.step(index, item);
    }
    if memory.is_full() {
        let words = "there are too many values in this text: some were left out";
        imported.remarks.push(Remark::error(1, 1, "", RemarkKind::told(&words)));
    }
    let severity = if imported.blocks.is_empty() { Severity::Error } else { Severity::Note };
    imported.remarks.extend(left_over(&script, names, severity));
    imported
}

fn types<'s, 'a>(script: &'s Script<'a>) -> Types<'s, 'a> {
    let mut types = BTreeMap::new();
    for item in &script.items {
        if let Statement::Declaration(declaration) = &item.statement {
            types.extend(
                declaration.names.iter().map(|(name, _)| (name.to_ascii_lowercase(), &declaration.kind)),
            );
        }
    }
    types
}

fn sites<'s, 'a>(script: &'s Script<'a>, types: &Types<'_, '_>) -> Vec<Site<'s, 'a>> {
    let site = |(item, it): (usize, &'s Item<'a>)| {
        let Statement::Call(call) = &it.statement else { return None };
        let declared = types.get(&call.name.root.to_ascii_lowercase());
        let instruction = match declared {
            Some(kind) => Instruction::of_type(kind.name)?,
            None => Instruction::of_name(call.name.root).or_else(|| Instruction::of_inputs(call))?,
        };
        Some(Site { item, call, instruction })
    };
    script.items.iter().enumerate().filter_map(site).collect()
}

/// The variables of a call, and its instance.
fn variables(call: &Call<'_>) -> Vec<String> {
    let of = call.arguments.iter().filter_map(|argument| match &argument.value {
        Some(Expression::Reference(reference)) => Some(reference.root.to_ascii_lowercase()),
        _ => None,
    });
    core::iter::once(call.name.root.to_ascii_lowercase()).chain(of).collect()
}
