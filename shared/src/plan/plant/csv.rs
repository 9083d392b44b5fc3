//! Variables as CSV (RFC 4180), and as what spreadsheets put on the clipboard: cells between tabs.
//!
//! The first line names the columns, in any order; only `name` and `address` are needed. A parent is named by its full
//! address. Spreadsheets run what looks like a formula: such a text is written with an apostrophe, which is taken off
//! again.

use alloc::borrow::Cow;
use alloc::format;
use alloc::string::{String, ToString};
use alloc::vec::Vec;

use super::finding::{PlantFinding, PlantRule};
use crate::config::{Choice, NewVariable, Variable, full_addresses};
use crate::tag::{Display, Scale};

/// The columns, as they are written.
pub const COLUMNS: [&str; 14] = [
    "parent", "name", "address", "type", "factor", "offset", "unit", "digits", "display", "choices",
    "writable", "min", "max", "order",
];

/// Reads a text with its head line. Returns the entries with the number of the line that each was in, counted from 1.
pub fn read_csv(text: &str) -> Result<Vec<(usize, NewVariable)>, Vec<PlantFinding>> {
    let text = text.strip_prefix('\u{feff}').unwrap_or(text);
    let head_end = text.find(['\r', '\n']).unwrap_or(text.len());
    let separator = separator(text.get(..head_end).unwrap_or_default());
    let mut lines = Lines { rest: text, separator, line: 0 };
    let Some((_, head)) = lines.next() else { return Err(line_finding(1, "", PlantRule::Missing)) };
    let columns: Vec<Option<usize>> = head.iter().flatten().map(|cell| column(cell)).collect();
    let unknown =
        head.iter().flatten().zip(&columns).filter(|(cell, found)| found.is_none() && !cell.is_empty());
    let mut findings: Vec<_> =
        unknown.flat_map(|(cell, _)| line_finding(1, "", PlantRule::UnknownColumn(cell.clone()))).collect();
    for needed in ["name", "address"] {
        if !columns.contains(&column(needed)) {
            findings.extend(line_finding(1, needed, PlantRule::Missing));
        }
    }
    if !findings.is_empty() {
        return Err(findings);
    }
    let mut all = Vec::new();
    for (number, cells) in lines {
        let Some(cells) =
            cells.filter(|cells| cells.len() <= columns.len() || is_empty(cells.get(columns.len()..)))
        else {
            findings.extend(line_finding(number, "", PlantRule::BadLine));
            continue;
        };
        if is_empty(Some(cells.as_slice())) {
            continue;
        }
        let mut entry = Entry { number, decimal_comma: separator != ',', ..Entry::default() };
        for (cell, column) in cells.iter().zip(&columns) {
            if let Some(name) = column.and_then(|column| COLUMNS.get(column)) {
                entry.cell(name, cell.trim());
            }
        }
        findings.append(&mut entry.findings);
        all.push((number, entry.variable));
    }
    if findings.is_empty() { Ok(all) } else { Err(findings) }
}

/// Writes all variables of a group, parents before their parts.
pub fn write_csv(all: &[Variable]) -> String {
    let addresses = full_addresses(all);
    let address_of = |id| {
        let place = all.iter().position(|variable| variable.id == id)?;
        addresses.get(place).cloned()
    };
    let mut out = COLUMNS.join(",");
    out.push_str("\r\n");
    for variable in parents_first(all) {
        let config = &variable.config;
        let number = |number: Option<f64>| number.map(|number| number.to_string()).unwrap_or_default();
        let choices: Vec<_> =
            config.choices.iter().map(|choice| format!("{}={}", choice.value, choice.text)).collect();
        let cells = [
            text(&config.parent.and_then(address_of).unwrap_or_default()),
            text(&config.name),
            text(&config.address),
            text(&config.kind),
            number(config.scale.map(|scale| scale.factor)),
            number(config.scale.map(|scale| scale.offset)),
            text(&config.unit),
            config.digits.map(|digits| digits.to_string()).unwrap_or_default(),
            if config.display == Display::Auto { String::new() } else { config.display.word().into() },
            text(&choices.join(";")),
            if config.writable { "yes" } else { "no" }.into(),
            number(config.min),
            number(config.max),
            config.order.to_string(),
        ];
        out.push_str(&cells.join(","));
        out.push_str("\r\n");
    }
    out
}

/// Whoever reads the file needs the parent first.
fn parents_first(all: &[Variable]) -> Vec<&Variable> {
    let depth = |variable: &Variable| {
        let mut depth = 0;
        let mut parent = variable.config.parent;
        while let Some(found) = parent.and_then(|id| all.iter().find(|other| other.id == id)) {
            depth += 1;
            parent = found.config.parent.filter(|_| depth < crate::config::MAX_DEPTH);
        }
        depth
    };
    let mut sorted: Vec<_> = all.iter().map(|variable| (depth(variable), variable)).collect();
    // Stable: neighbours stay as they are.
    sorted.sort_by_key(|(depth, _)| *depth);
    sorted.into_iter().map(|(_, variable)| variable).collect()
}

/// A cell of text, which is never a formula.
fn text(text: &str) -> String {
    let safe = if text.starts_with(FORMULA) { format!("'{text}") } else { text.into() };
    if safe.contains(['"', ',', ';', '\t', '\r', '\n']) {
        format!("\"{}\"", safe.replace('"', "\"\""))
    } else {
        safe
    }
}

const FORMULA: [char; 4] = ['=', '+', '-', '@'];

#[derive(Default)]
struct Entry {
    number: usize,
    /// `0,5` is a half where commas do not separate cells.
    decimal_comma: bool,
    variable: NewVariable,
    findings: Vec<PlantFinding>,
}

impl Entry {
    fn cell(&mut self, column: &'static str, cell: &str) {
        if cell.is_empty() {
            return;
        }
        let as_text = || match cell.strip_prefix('\'') {
            Some(rest) if rest.starts_with(FORMULA) => rest.to_string(),
            _ => cell.to_string(),
        };
        match column {
            "parent" => self.variable.parent_address = Some(as_text()),
            "name" => self.variable.config.name = as_text(),
            "address" => self.variable.config.address = as_text(),
            "type" => self.variable.config.kind = as_text(),
            "unit" => self.variable.config.unit = as_text(),
            "factor" | "offset" => {
                let Some(number) = self.float(column, cell) else { return };
                let scale = self.variable.config.scale.get_or_insert(Scale { factor: 1.0, offset: 0.0 });
                if column == "factor" { scale.factor = number } else { scale.offset = number }
            }
            "min" => self.variable.config.min = self.float(column, cell),
            "max" => self.variable.config.max = self.float(column, cell),
            "digits" => self.variable.config.digits = self.integer(column, cell),
            "order" => self.variable.config.order = self.integer(column, cell).unwrap_or_default(),
            "display" => self.display(cell),
            "choices" => self.choices(&as_text()),
            _ => self.writable(cell),
        }
    }

    fn display(&mut self, cell: &str) {
        let mut all = Display::ALL.into_iter();
        if let Some(display) = all.find(|display| display.word().eq_ignore_ascii_case(cell)) {
            self.variable.config.display = display;
        } else {
            let words = "auto, dec, hex, bin, float, ascii";
            self.wrong("display", PlantRule::NotAWord { found: cell.into(), words });
        }
    }

    /// `0=off;1=on`
    fn choices(&mut self, cell: &str) {
        for part in cell.split(';').map(str::trim).filter(|part| !part.is_empty()) {
            let (value, text) = part.split_once('=').unwrap_or((part, ""));
            match value.trim().parse() {
                Ok(value) => self.variable.config.choices.push(Choice { value, text: text.trim().into() }),
                Err(_) => self.wrong("choices", PlantRule::NotANumber(value.into())),
            }
        }
    }

    fn writable(&mut self, cell: &str) {
        let is = |words: &[&str]| words.iter().any(|word| word.eq_ignore_ascii_case(cell));
        if is(&["yes", "true", "1", "y", "x"]) {
            self.variable.config.writable = true;
        } else if !is(&["no", "false", "0", "n"]) {
            self.wrong("writable", PlantRule::NotYesOrNo(cell.into()));
        }
    }

    fn float(&mut self, column: &str, cell: &str) -> Option<f64> {
        let comma = self.decimal_comma && !cell.contains('.') && cell.matches(',').count() == 1;
        let text = if comma { Cow::Owned(cell.replace(',', ".")) } else { Cow::Borrowed(cell) };
        let number = text.parse().ok().filter(|number: &f64| number.is_finite());
        if number.is_none() {
            self.wrong(column, PlantRule::NotANumber(cell.into()));
        }
        number
    }

    fn integer(&mut self, column: &str, cell: &str) -> Option<i64> {
        let number = cell.parse().ok();
        if number.is_none() {
            self.wrong(column, PlantRule::NotANumber(cell.into()));
        }
        number
    }

    fn wrong(&mut self, column: &str, rule: PlantRule) {
        self.findings.extend(line_finding(self.number, column, rule));
    }
}

fn line_finding(line: usize, column: &str, rule: PlantRule) -> Vec<PlantFinding> {
    let point = if column.is_empty() { "" } else { "." };
    alloc::vec![PlantFinding { field: format!("line {line}{point}{column}"), rule }]
}

/// What the head line separates its cells with.
fn separator(head: &str) -> char {
    ['\t', ';', ','].into_iter().find(|separator| head.contains(*separator)).unwrap_or(',')
}

/// The column of this name.
fn column(cell: &str) -> Option<usize> {
    COLUMNS.iter().position(|name| name.eq_ignore_ascii_case(cell.trim()))
}

fn is_empty<T: AsRef<str>>(cells: Option<&[T]>) -> bool {
    cells.is_none_or(|cells| cells.iter().all(|cell| cell.as_ref().trim().is_empty()))
}

/// The lines of a text: their number, and their cells; `None` where a quotation mark does not end.
struct Lines<'a> {
    rest: &'a str,
    separator: char,
    line: usize,
}

impl Iterator for Lines<'_> {
    type Item = (usize, Option<Vec<String>>);

    fn next(&mut self) -> Option<Self::Item> {
        if self.rest.is_empty() {
            return None;
        }
        self.line += 1;
        let number = self.line;
        let (mut cells, mut cell, mut in_quotes) = (Vec::new(), String::new(), false);
        let mut letters = self.rest.char_indices().peekable();
        let mut end = self.rest.len();
        while let Some((at, letter)) = letters.next() {
            match letter {
                '"' if in_quotes && letters.next_if(|(_, next)| *next == '"').is_some() => cell.push('"'),
                '"' if in_quotes => in_quotes = false,
                '"' if cell.trim().is_empty() => {
                    cell.clear();
                    in_quotes = true;
                }
                '\r' if !in_quotes => {}
                '\n' if !in_quotes => {
                    end = at + 1;
                    break;
                }
                separator if separator == self.separator && !in_quotes => {
                    cells.push(core::mem::take(&mut cell));
                }
                letter => {
                    if letter == '\n' {
                        self.line += 1;
                    }
                    cell.push(letter);
                }
            }
        }
        cells.push(cell);
        self.rest = self.rest.get(end..).unwrap_or_default();
        Some((number, (!in_quotes).then_some(cells)))
    }
}
