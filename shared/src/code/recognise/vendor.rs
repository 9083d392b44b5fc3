//! Whose Structured Text it is: told by the calls, and by the variables that belong to them.

use alloc::borrow::Cow;
use alloc::collections::BTreeMap;
use alloc::string::String;
use alloc::vec;
use alloc::vec::Vec;
use core::ops::Range;

use super::line::is_instruction;
use super::only;
use crate::code::dialect::Dialect;
use crate::code::text::{Expression, Item, Script, Statement, roots};
use crate::code::{ccw_st, sysmac_st};

/// One piece for each vendor that has a call in the text.
pub(super) fn split(text: &str) -> Vec<(Dialect, Cow<'_, str>)> {
    let script = Script::read(text);
    let types = types(&script);
    let calls: Vec<Option<Dialect>> =
        script.items.iter().map(|item| vendor(&item.statement, &types)).collect();
    let instructions = text.lines().any(is_instruction) && has_block_of_control_expert(text);
    let mut vendors: Vec<Dialect> = calls.iter().flatten().copied().collect();
    if instructions {
        vendors.push(control_expert(text));
    }
    vendors.sort_unstable();
    vendors.dedup_by_key(|dialect| family(*dialect));
    match vendors.as_slice() {
        [] => vec![(guess(text), Cow::Borrowed(text))],
        [only] => vec![(*only, Cow::Borrowed(text))],
        several => apart(&script, &calls, several),
    }
}

/// The three of Control Expert are read by one reader.
const fn family(dialect: Dialect) -> Dialect {
    match dialect {
        Dialect::SendReqEtc101 | Dialect::DataExch => Dialect::SendReqEtc100,
        other => other,
    }
}

fn has_block_of_control_expert(text: &str) -> bool {
    let upper = text.to_ascii_uppercase();
    upper.contains("SEND_REQ") || upper.contains("DATA_EXCH")
}

fn control_expert(text: &str) -> Dialect {
    let upper = text.to_ascii_uppercase();
    if upper.contains("SEND_REQ") { Dialect::SendReqEtc100 } else { Dialect::DataExch }
}

/// Without any call: by the names that are in it.
fn guess(text: &str) -> Dialect {
    let upper = text.to_ascii_uppercase();
    let has = |words: &[&str]| words.iter().any(|word| upper.contains(word));
    if has(&["SEND_REQ", "DATA_EXCH", "%MW", "ADDR(", "ADDM(", "ADDMX(", "MANAGEMENT_PARAM", "TAB_GEST"]) {
        control_expert(text)
    } else if has(&["CIPUCMMSEND", "CIPSEND", "CIPOPEN", "_SREQUEST_PATH"]) {
        Dialect::SysmacSt
    } else {
        Dialect::CcwSt
    }
}

/// The type of each declared variable, both in lower case.
fn types(script: &Script<'_>) -> BTreeMap<String, String> {
    let mut types = BTreeMap::new();
    for item in &script.items {
        if let Statement::Declaration(declaration) = &item.statement {
            for (name, _) in &declaration.names {
                types.insert(name.to_ascii_lowercase(), declaration.kind.name.to_ascii_lowercase());
            }
        }
    }
    types
}

/// Whose call it is, if it is one.
fn vendor(statement: &Statement<'_>, types: &BTreeMap<String, String>) -> Option<Dialect> {
    let call = match statement {
        Statement::Call(call) => call,
        Statement::Assignment { value: Expression::Call(call), .. } => call,
        _ => return None,
    };
    let named = |words: &[&str]| {
        call.arguments
            .iter()
            .any(|it| it.name.is_some_and(|name| words.iter().any(|word| name.eq_ignore_ascii_case(word))))
    };
    let kind = types
        .get(&call.name.root.to_ascii_lowercase())
        .cloned()
        .unwrap_or_else(|| call.name.root.to_ascii_lowercase());
    match kind.as_str() {
        "send_req" => Some(Dialect::SendReqEtc100),
        "data_exch" => Some(Dialect::DataExch),
        "msg_cipgeneric" => Some(Dialect::CcwSt),
        "cipucmmsend" | "cipsend" | "cipopen" | "cipopenwithdatasize" | "cipclose" => Some(Dialect::SysmacSt),
        name if sysmac_st::is_instance(name) => Some(Dialect::SysmacSt),
        name if ccw_st::is_instance(name) => Some(Dialect::CcwSt),
        _ if named(&["CtrlCfg", "AppCfg", "TargetCfg"]) => Some(Dialect::CcwSt),
        _ if named(&["RqPath", "RoutePath", "ServiceCode"]) => Some(Dialect::SysmacSt),
        _ if ccw_st::is_positional(call) => Some(Dialect::CcwSt),
        _ => None,
    }
}

/// Each statement goes to the vendor whose call shares a variable with it, directly or through others; what shares none
/// goes with the statement before it.
fn apart<'a>(
    script: &Script<'a>,
    calls: &[Option<Dialect>],
    vendors: &[Dialect],
) -> Vec<(Dialect, Cow<'a, str>)> {
    let owners = owners(script, calls);
    let mut keep: Vec<Vec<Range<usize>>> = vec![Vec::new(); vendors.len()];
    let mut give = |owner: Dialect, range: Range<usize>| {
        let at = vendors.iter().position(|vendor| family(*vendor) == family(owner));
        if let Some(ranges) = at.and_then(|at| keep.get_mut(at)) {
            ranges.push(range);
        }
    };
    let first = vendors.first().copied().unwrap_or(Dialect::CcwSt);
    let mut at = 0;
    let mut last = first;
    for (item, owner) in script.items.iter().zip(owners) {
        gap(script.text, at..item.span.start, last, &mut give);
        last = owner.unwrap_or(last);
        give(last, item.span.clone());
        at = item.span.end;
    }
    gap(script.text, at..script.text.len(), last, &mut give);
    let texts = keep.iter().map(|ranges| Cow::Owned(only(script.text, ranges)));
    vendors.iter().copied().zip(texts).collect()
}

/// What is between statements, line by line: the sections of declarations are not needed, instructions are Control
/// Expert's, and the rest goes with the statement before.
fn gap(text: &str, range: Range<usize>, owner: Dialect, give: &mut impl FnMut(Dialect, Range<usize>)) {
    let mut at = range.start;
    for line in text.get(range).unwrap_or_default().split_inclusive('\n') {
        let upper = line.trim().to_ascii_uppercase();
        let is_section = upper.starts_with("VAR") || upper.starts_with("END_VAR");
        if !is_section {
            give(if is_instruction(line) { Dialect::SendReqEtc100 } else { owner }, at..at + line.len());
        }
        at += line.len();
    }
}

/// Whose each statement is. The calls come first: what two of them share, such as the flag that starts both, is the
/// first one's and does not make them one.
fn owners(script: &Script<'_>, calls: &[Option<Dialect>]) -> Vec<Option<Dialect>> {
    let mut groups = Groups::default();
    for (item, call) in script.items.iter().zip(calls).filter(|(_, call)| call.is_some()) {
        groups.join(&names(item), *call);
    }
    let others = script.items.iter().zip(calls).filter(|(_, call)| call.is_none());
    for (item, _) in others.clone() {
        groups.join(&names(item), None);
    }
    let mut owner =
        |(item, call): (&Item<'_>, &Option<Dialect>)| call.or_else(|| groups.vendor(&names(item)));
    script.items.iter().zip(calls).map(&mut owner).collect()
}

/// The variables of a statement. A function belongs to nobody, an instance to its message.
fn names(item: &Item<'_>) -> Vec<String> {
    let mut names = roots(item);
    names.retain(|name| !matches!(name.as_str(), "send_req" | "data_exch"));
    names
}

/// Names that belong together, and to whom.
#[derive(Default)]
struct Groups {
    of: BTreeMap<String, usize>,
    groups: Vec<Group>,
}

#[derive(Clone, Copy)]
struct Group {
    parent: usize,
    vendor: Option<Dialect>,
}

impl Groups {
    /// Names of one statement belong together, unless two of them have different vendors already.
    fn join(&mut self, names: &[String], vendor: Option<Dialect>) {
        let mut whole = self.groups.len();
        self.groups.push(Group { parent: whole, vendor });
        for name in names {
            let known = self.of.get(name).copied();
            let group = known.map_or(whole, |group| self.root(group));
            if known.is_none() {
                self.of.insert(name.clone(), whole);
            }
            let Some((of_group, of_whole)) = self.groups.get(group).zip(self.groups.get(whole)) else {
                continue;
            };
            let (vendor, other) = (of_group.vendor, of_whole.vendor);
            if group == whole || vendor.zip(other).is_some_and(|(one, other)| family(one) != family(other)) {
                continue;
            }
            if let Some(place) = self.groups.get_mut(whole) {
                place.parent = group;
            }
            if let Some(place) = self.groups.get_mut(group) {
                place.vendor = vendor.or(other);
            }
            whole = group;
        }
    }

    /// Of the first name that has one.
    fn vendor(&mut self, names: &[String]) -> Option<Dialect> {
        names.iter().find_map(|name| {
            let group = self.of.get(name).copied()?;
            let root = self.root(group);
            self.groups.get(root)?.vendor
        })
    }

    /// Halves the way on the way, so that no chain grows long.
    fn root(&mut self, group: usize) -> usize {
        let mut group = group;
        while let Some(parent) = self.groups.get(group).map(|it| it.parent).filter(|parent| *parent != group)
        {
            let next = self.groups.get(parent).map_or(parent, |it| it.parent);
            if let Some(place) = self.groups.get_mut(group) {
                place.parent = next;
            }
            group = next;
        }
        group
    }
}
