//! Pasted tables of parameters: one row for each member, with its name, perhaps its type, and its value.
//!
//! The columns are those of document 13032001 (Parâmetro, Tipo de dados, Descrição) with one more for the value, or
//! just a name and a value. Heads in Portuguese, English, Spanish and German. Several blocks stand one below the other: a
//! member that comes again, or an empty line before the service, begins the next one.

mod member;

use alloc::format;
use alloc::string::{String, ToString};
use alloc::vec::Vec;

pub(super) use self::member::is_rule;
use self::member::{Member, head_of, member};
use super::dialect::Dialect;
use super::remark::{Remark, RemarkKind};
use super::{Found, Imported};
use crate::config::{MsgCipGeneric, read_hex, read_number, write_hex};
use crate::plan::Severity;

/// Whether a line is a row of such a table: its first cell names a member, or it is a head. A comment of a program, such
/// as `(* status: … *)`, is none.
pub(super) fn is_row(line: &str) -> bool {
    if line.trim_start().starts_with("(*") {
        return false;
    }
    let cells = cells(line);
    let named = cells.first().is_some_and(|name| member(name).is_some());
    cells.len() > 1 && (named || head_of(&columns(line)).is_some())
}

/// Blocks from a table.
pub(super) fn import(text: &str) -> Imported {
    let mut table = Table { imported: Imported::default(), block: None, value_at: None };
    for (number, line) in (1..).zip(text.lines()) {
        table.row(number, line);
        if table.imported.is_full() {
            break;
        }
    }
    table.close();
    table.imported
}

struct Table {
    imported: Imported,
    block: Option<Block>,
    /// The column of the values, where a head has told it.
    value_at: Option<usize>,
}

struct Block {
    config: MsgCipGeneric,
    told: Vec<Member>,
    lines: core::ops::Range<usize>,
    excerpt: String,
    remarks: Vec<Remark>,
}

impl Table {
    fn row(&mut self, number: usize, line: &str) {
        let cells = cells(line);
        if cells.is_empty() || is_rule(line) {
            return;
        }
        if let Some(head) = head_of(&columns(line)) {
            self.value_at = head.value;
            // A head begins a block, unless it is the head of another structure of the same one.
            if self.block.as_ref().is_some_and(|block| {
                block.told.contains(&Member::Service) && block.told.contains(&Member::Path)
            }) {
                self.close();
            }
            return;
        }
        let name = cells.first().copied().unwrap_or_default();
        let Some(member) = member(name) else {
            let (column, what) = (1, RemarkKind::UnknownMember(name.into()));
            self.imported.remarks.push(Remark::error(number, column, line, what));
            return;
        };
        if self.block.as_ref().is_some_and(|block| block.told.contains(&member) && member != Member::Nothing)
        {
            self.close();
        }
        let count = self.imported.blocks.len() + 1;
        let value_at = self.value_at;
        let block = self.block.get_or_insert_with(|| Block::new(count, number, line));
        block.lines.end = number + 1;
        block.set(member, name, &cells, value_at, number, line);
    }

    fn close(&mut self) {
        let Some(mut block) = self.block.take() else { return };
        for (member, name) in [
            (Member::Service, "Service"),
            (Member::Class, "Class"),
            (Member::Instance, "Instance"),
            (Member::Path, "Path"),
        ] {
            if !block.told.contains(&member) {
                let (line, severity) = (block.lines.start, Severity::Error);
                let what = if member == Member::Path {
                    RemarkKind::NoDevice
                } else {
                    RemarkKind::Missing(name.into())
                };
                let severity = if member == Member::Path { Severity::Warning } else { severity };
                block.remarks.push(Remark { severity, ..Remark::error(line, 1, &block.excerpt, what) });
            }
        }
        self.imported.blocks.push(Found {
            config: block.config.into(),
            dialect: Dialect::CcwSt,
            lines: block.lines,
            remarks: block.remarks,
        });
    }
}

impl Block {
    fn new(count: usize, line: usize, excerpt: &str) -> Self {
        let mut config = MsgCipGeneric::product_name("0,0");
        config.name = format!("message-{count}");
        let app = &mut config.app_cfg;
        (app.service, app.class, app.instance, app.attribute) = (0, 0, 0, 0);
        Self { config, told: Vec::new(), lines: line..line + 1, excerpt: excerpt.into(), remarks: Vec::new() }
    }

    fn set(
        &mut self,
        member: Member,
        name: &str,
        cells: &[&str],
        value_at: Option<usize>,
        number: usize,
        line: &str,
    ) {
        if member == Member::Nothing {
            let what = RemarkKind::NoEffect(name.into());
            self.remarks.push(Remark::note(number, 1, line, what));
            return;
        }
        let in_column = value_at.and_then(|at| columns(line).get(at).copied());
        if in_column == Some("") {
            // A variable without an initial value.
            let what = RemarkKind::NoEffect(format!("{name} without a value"));
            self.remarks.push(Remark::note(number, 1, line, what));
            return;
        }
        self.told.push(member);
        let value = in_column.or_else(|| member::value(member, cells));
        let column = |value: &str| {
            line.find(value).and_then(|at| line.get(..at)).map_or(1, |it| it.chars().count() + 1)
        };
        let Some(value) = value else {
            let what = RemarkKind::Missing(format!("the value of {name}"));
            self.remarks.push(Remark::error(number, 1, line, what));
            return;
        };
        if let Err(words) = self.assign(member, value) {
            let what = RemarkKind::Told(format!("{name}: {words}"));
            self.remarks.push(Remark::error(number, column(value), line, what));
        }
    }

    fn assign(&mut self, member: Member, value: &str) -> Result<(), String> {
        let whole = || read_number(value.trim_matches(['"', '\''])).map_err(|error| error.to_string());
        let truth = || match value.to_ascii_uppercase().as_str() {
            "TRUE" | "1" | "VERDADEIRO" | "VERDADERO" | "WAHR" => Ok(true),
            "FALSE" | "0" | "FALSO" | "FALSCH" => Ok(false),
            _ => Err("TRUE or FALSE is expected here".to_string()),
        };
        let config = &mut self.config;
        let (ctrl, app, target) = (&mut config.ctrl_cfg, &mut config.app_cfg, &mut config.target_cfg);
        match member {
            Member::Name => config.name = value.into(),
            Member::Cancel => ctrl.cancel = truth()?,
            Member::TriggerType => ctrl.trigger_type = whole()?,
            Member::StrMode => ctrl.str_mode = whole()?,
            Member::Service => app.service = whole()?,
            Member::Class => app.class = whole()?,
            Member::Instance => app.instance = whole()?,
            Member::Attribute => app.attribute = whole()?,
            Member::Count => app.member_cnt = whole()?,
            Member::Ids => {
                let inside = value.trim_matches(['[', ']', '{', '}', '(', ')']);
                let ids: Result<Vec<i64>, _> =
                    inside.split([',', ' ']).filter(|it| !it.is_empty()).map(read_number).collect();
                let mut ids = ids.map_err(|error| error.to_string())?;
                ids.resize(ids.len().max(3), 0);
                app.member_id = ids;
            }
            Member::IdAt(at) => {
                let id = whole()?;
                if let Some(place) = app.member_id.get_mut(at) {
                    *place = id;
                }
            }
            Member::Path => target.path = value.trim_matches(['"', '\'', '“', '”']).into(),
            Member::CipConnMode => target.cip_conn_mode = whole()?,
            Member::UcmmTimeout => target.ucmm_timeout = whole()?,
            Member::ConnMsgTimeout => target.conn_msg_timeout = whole()?,
            Member::ConnClose => target.conn_close = truth()?,
            Member::ReqData => {
                let bytes =
                    read_hex(value).map_err(|_| "bytes as two hexadecimal digits are expected here")?;
                config.req_data = write_hex(&bytes);
            }
            Member::ReqLength => config.req_length = Some(whole()?),
            Member::ResData => config.res_data_size = whole()?,
            Member::Nothing => {}
        }
        Ok(())
    }
}

/// All columns of a row, also those that are empty, where tabs or bars are between them.
fn columns(line: &str) -> Vec<&str> {
    let line = line.trim_matches(['\r', '\n']);
    if line.contains('\t') {
        return line.split('\t').map(str::trim).collect();
    }
    let inner = line.trim().trim_start_matches('|').trim_end_matches('|');
    if line.contains('|') { inner.split('|').map(str::trim).collect() } else { cells(line) }
}

/// The cells of a row: between tabs or bars; if there are none, between semicolons, or else between several spaces.
/// Also `name = value` and `name: value`.
fn cells(line: &str) -> Vec<&str> {
    let line = line.trim();
    let trimmed = |cells: core::str::Split<'_, char>| {
        // A function pointer would lose the lifetime.
        cells.map(str::trim).filter(|cell| !cell.is_empty()).count()
    };
    for separator in ['\t', '|', ';'] {
        if trimmed(line.split(separator)) > 1 {
            return line.split(separator).map(str::trim).filter(|cell| !cell.is_empty()).collect();
        }
    }
    let spaced: Vec<&str> = line.split("  ").map(str::trim).filter(|cell| !cell.is_empty()).collect();
    if spaced.len() > 1 {
        return spaced;
    }
    let pair = line.split_once('=').or_else(|| line.split_once(':')).filter(|_| !line.contains(":="));
    match pair {
        Some((name, value)) if !line.ends_with(';') => {
            [name.trim(), value.trim()].into_iter().filter(|cell| !cell.is_empty()).collect()
        }
        _ => spaced,
    }
}

#[cfg(test)]
mod tests;
