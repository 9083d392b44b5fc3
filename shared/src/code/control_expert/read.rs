//! Sections with calls of `SEND_REQ` and `DATA_EXCH`, tables of words without a call, and words alone.

use alloc::collections::BTreeSet;
use alloc::format;
use alloc::string::{String, ToString};
use alloc::vec::Vec;

use super::super::dialect::Dialect;
use super::super::remark::{Remark, RemarkKind};
use super::super::text::{Call, Expression, Item, Lexeme, Memory, Reference, Script, Statement, tokens};
use super::super::{Found, Imported};
use super::call::read_call;
use super::located::Located;
use super::variables::{Names, Variables, memory_words};
use super::{exchange, form, il, table};
use crate::config::SendReqForm;
use crate::plan::Severity;

/// Blocks from sections and words, and from exchange files.
pub(in super::super) fn import(text: &str, dialect: Dialect) -> Imported {
    if !exchange::is_exchange(text) {
        return sections(text, dialect);
    }
    match exchange::as_text(text) {
        Ok(sections_of_file) => of_file(sections(&sections_of_file, dialect)),
        Err(remark) => Imported { blocks: Vec::new(), remarks: alloc::vec![*remark] },
    }
}

/// A file is a whole program: what of it is no message is counted.
fn of_file(mut imported: Imported) -> Imported {
    let before = imported.remarks.len();
    imported.remarks.retain(|remark| remark.severity != Severity::Note);
    let others = before - imported.remarks.len();
    if imported.blocks.is_empty() {
        let words = "no call of SEND_REQ or DATA_EXCH is in this file".to_string();
        imported.remarks.push(Remark::error(1, 1, "", RemarkKind::Told(words)));
    } else if others > 0 {
        let words = format!("{others} other statements and conditions of this file are not read");
        imported.remarks.push(Remark::note(1, 1, "", RemarkKind::Told(words)));
    }
    imported
}

fn sections(text: &str, dialect: Dialect) -> Imported {
    let plain = il::uncommented(text);
    let (blocks, remarks, rest) = table::take(&plain, dialect.kind().form());
    let mut imported = Imported { blocks, remarks };
    let (st, il_remarks) = il::as_st(&rest);
    imported.remarks.extend(il_remarks);
    let script = Script::read(&st);
    imported.remarks.extend(script.remarks.iter().cloned());
    let mut used = BTreeSet::new();
    let located = Located::of(&script);
    let names = Names::of(&script);
    let mut memory = Memory::new(&script);
    for (index, item) in script.items.iter().enumerate() {
        if let Statement::Call(call) = &item.statement
            && is_exchange(call)
        {
            let variables = Variables { script: &script, memory: &memory, located: &located, names: &names };
            let found = read_call(&variables, call, item, &mut used);
            imported.blocks.push(found);
            if imported.is_full() {
                return imported;
            }
        }
        memory.step(index, item);
    }
    if memory.is_full() {
        let words = "there are too many values in this text: some were left out";
        imported.remarks.push(Remark::error(1, 1, "", RemarkKind::told(&words)));
    }
    let variables = Variables { script: &script, memory: &memory, located: &located, names: &names };
    alone(&variables, &mut used, &mut imported, dialect.kind().form());
    unused(&script, &used, &mut imported);
    slips(&st, &script, &mut imported);
    if imported.blocks.is_empty() && imported.remarks.is_empty() {
        let what = RemarkKind::Expected("SEND_REQ (…) or a table of words".to_string());
        imported.remarks.push(Remark::error(1, 1, text, what));
    }
    imported
}

fn is_exchange(call: &Call<'_>) -> bool {
    call.is("SEND_REQ") || call.is("DATA_EXCH")
}

/// Variables that are looked at for tables that no call uses.
const MAX_TABLES: usize = 1000;

/// Tables of words that no call uses: each may be a request by itself.
fn alone(
    variables: &Variables<'_, '_, '_>,
    used: &mut BTreeSet<String>,
    imported: &mut Imported,
    asked: Option<SendReqForm>,
) {
    let mut seen = BTreeSet::new();
    for item in &variables.script.items {
        let (reference, name) = match &item.statement {
            Statement::Declaration(declaration) if declaration.initial.is_some() => {
                let Some((name, place)) = declaration.names.first() else { continue };
                (Reference { root: name, steps: Vec::new(), place: *place }, *name)
            }
            Statement::Assignment { target, .. } => {
                (Reference { root: target.root, steps: Vec::new(), place: target.place }, target.root)
            }
            _ => continue,
        };
        if used.contains(&key_of(name)) || !seen.insert(key_of(name)) {
            continue;
        }
        if seen.len() > MAX_TABLES {
            let words = format!("more than {MAX_TABLES} variables: from here on no tables are looked for");
            let place = item.place;
            imported.remarks.push(Remark::error(place.line, place.column, name, RemarkKind::Told(words)));
            return;
        }
        let known = variables.table(&reference).words;
        let words: Option<Vec<u16>> = known
            .iter()
            .map(|word| match word {
                Some(super::variables::Word::Known(word)) => Some(*word),
                _ => None,
            })
            .collect();
        let Some(words) = words.filter(|words| words.len() > 1) else { continue };
        let possible = form::possible(&words);
        let Some(form) = asked.filter(|form| possible.contains(form)).or(possible.first().copied()) else {
            continue;
        };
        let line = item.place.line;
        let say = |severity, words: String| Remark {
            severity,
            ..Remark::error(line, item.place.column, name, RemarkKind::Told(words))
        };
        let mut remarks = alloc::vec![
            say(Severity::Note, form::why(form, &words)),
            say(Severity::Warning, "no call uses these words: timeout and Address are not known".to_string()),
            say(Severity::Warning, form::no_address(form).to_string()),
        ];
        for other in possible.iter().filter(|other| **other != form) {
            remarks
                .push(say(Severity::Warning, format!("these words could be {other}, too: {form} is taken")));
        }
        let config = form::block(form, name.trim_start_matches('%'), &words);
        let last = line.max(item.last_line) + 1;
        imported.blocks.push(Found {
            config: config.into(),
            dialect: table::dialect(form),
            lines: line..last,
            remarks,
        });
        for index in 0..words.len() {
            used.extend(memory_words(name).map(|(first, _)| format!("%mw{}", first.saturating_add(index))));
        }
        used.insert(key_of(name));
    }
}

/// How a variable is known among those that are used.
pub(super) fn key_of(root: &str) -> String {
    root.split(':').next().unwrap_or_default().to_ascii_lowercase()
}

/// Assignments and calls that no message needs.
fn unused(script: &Script<'_>, used: &BTreeSet<String>, imported: &mut Imported) {
    for item in &script.items {
        let what = match &item.statement {
            Statement::Assignment { target, value } => {
                let reads = |reference: &Reference<'_>| used.contains(&key_of(reference.root));
                if used.contains(&key_of(target.root)) || value.reference().is_some_and(reads) {
                    continue;
                }
                "this assignment"
            }
            Statement::Call(call) if !is_exchange(call) => "this call",
            _ => continue,
        };
        imported.remarks.push(note(script, item, RemarkKind::NoEffect(what.to_string())));
    }
}

fn note(script: &Script<'_>, item: &Item<'_>, what: RemarkKind) -> Remark {
    let excerpt = script.text.get(item.span.clone()).unwrap_or_default();
    Remark::note(item.place.line, item.place.column, excerpt, what)
}

/// What printed manuals get wrong: `ARRAY [0.3]`, and `Tab_Gest[1].0` for the activity bit.
fn slips(text: &str, script: &Script<'_>, imported: &mut Imported) {
    for item in &script.items {
        if let Statement::Declaration(declaration) = &item.statement
            && let Some(place) = declaration.kind.slip
        {
            let words =
                "the bounds of an array are written 0..3: a slip of the printed manual, read as meant";
            let excerpt = text.get(item.span.clone()).unwrap_or_default();
            imported.remarks.push(Remark::note(place.line, place.column, excerpt, RemarkKind::told(&words)));
        }
    }
    let (tokens, _) = tokens(text, false);
    for window in tokens.windows(6) {
        let [name, open, index, close, dot, bit] = window else { continue };
        let is_bit = open.is_sign("[") && index.text == "1" && close.is_sign("]") && dot.is_sign(".");
        if name.lexeme == Lexeme::Name && is_bit && bit.text == "0" {
            let words = format!(
                "the activity bit is {0}[0].0: {0}[1].0, as a printed manual has it, is bit 0 of the reports",
                name.text
            );
            let remark = Remark::note(name.place.line, name.place.column, name.text, RemarkKind::Told(words));
            imported.remarks.push(remark);
        }
    }
}

/// Whether an expression is a variable, and which.
pub(super) fn variable<'e, 'a>(value: Option<&'e Expression<'a>>) -> Option<&'e Reference<'a>> {
    value.and_then(Expression::reference)
}
