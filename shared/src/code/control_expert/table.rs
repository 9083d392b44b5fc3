//! Words that somebody has pasted without a program: `0000 030E 0120 0124 0730`, a row of a table, or several lines.

use alloc::format;
use alloc::string::{String, ToString};
use alloc::vec::Vec;
use core::ops::Range;

use super::super::Found;
use super::super::dialect::Dialect;
use super::super::remark::{Remark, RemarkKind};
use super::form;
use crate::config::{SendReqForm, read_words};
use crate::plan::Severity;

/// Lines that are nothing but words.
#[derive(Clone, Debug, PartialEq, Eq)]
struct Row {
    line: usize,
    text: String,
    title: String,
    words: Vec<u16>,
    /// Bytes, as a table may say.
    length: Option<usize>,
}

/// Takes such lines out of a text: the blocks, what is to be said of lines that are none, and the other lines.
pub(super) fn take(text: &str, asked: Option<SendReqForm>) -> (Vec<Found>, Vec<Remark>, String) {
    let (mut groups, mut remarks, mut rest) = (Vec::<Vec<Row>>::new(), Vec::new(), Vec::new());
    let mut depth = 0_usize;
    for (index, line) in text.lines().enumerate() {
        let is_ruler = line.contains("--") && line.chars().all(|c| "|-: ".contains(c));
        let row = if depth == 0 && !is_ruler { row(index + 1, line) } else { None };
        match row {
            Some(row) => {
                let goes_on = groups.last().and_then(|group| group.last()).is_some_and(|last| {
                    last.line + 1 == row.line && row.title.is_empty() && last.title.is_empty()
                });
                match groups.last_mut().filter(|_| goes_on) {
                    Some(group) => group.push(row),
                    None => groups.push(alloc::vec![row]),
                }
                rest.push("");
            }
            None if is_ruler => rest.push(""),
            None if line.trim_start().starts_with('|') => {
                remarks.push(Remark::note(
                    index + 1,
                    1,
                    line,
                    RemarkKind::NoEffect("a row without words".into()),
                ));
                rest.push("");
            }
            None => {
                let opened = line.matches(['[', '(']).count();
                depth = (depth + opened).saturating_sub(line.matches([']', ')']).count());
                rest.push(line);
            }
        }
    }
    let mut blocks = Vec::new();
    for group in groups {
        // Several requests, or one over several lines.
        let alone = group.iter().all(|row| !form::possible(&row.words).is_empty());
        let messages =
            if alone { group.into_iter().map(|row| alloc::vec![row]).collect() } else { alloc::vec![group] };
        for message in messages {
            blocks.extend(block(&message, asked, &mut remarks));
        }
    }
    (blocks, remarks, rest.join("\n"))
}

fn block(rows: &[Row], asked: Option<SendReqForm>, remarks: &mut Vec<Remark>) -> Option<Found> {
    let words: Vec<u16> = rows.iter().flat_map(|row| row.words.iter().copied()).collect();
    let (first, last) = (rows.first(), rows.last());
    let (line, text) = first.map_or((1, ""), |row| (row.line, row.text.as_str()));
    let title = first.map_or("", |row| row.title.as_str());
    let possible = form::possible(&words);
    let hinted = hint(title).or(asked).filter(|form| possible.contains(form));
    let Some(form) = hinted.or_else(|| possible.first().copied()) else {
        let words = "these words are no request: neither behind a message type, nor behind one and an IP address, nor at once";
        remarks.push(Remark::error(line, 1, text, RemarkKind::told(&words)));
        return None;
    };
    let name = if title.is_empty() { "words" } else { title };
    let mut config = form::block(form, name, &words);
    let mut found = Found {
        config: config.clone().into(),
        dialect: dialect(form),
        lines: lines(rows),
        remarks: Vec::new(),
    };
    let mut say = |severity, words: String| {
        found.remarks.push(Remark { severity, ..Remark::error(line, 1, text, RemarkKind::Told(words)) });
    };
    say(Severity::Note, form::why(form, &words));
    for other in possible.iter().filter(|other| **other != form) {
        say(Severity::Warning, format!("these words could be {other}, too: {form} is taken"));
    }
    let length = last.and_then(|row| row.length);
    if let Some(length) = length {
        form::set_length(&mut config, length);
    }
    say(Severity::Warning, form::no_address(form).to_string());
    found.config = config.into();
    Some(found)
}

fn lines(rows: &[Row]) -> Range<usize> {
    rows.first().map_or(1, |row| row.line)..rows.last().map_or(1, |row| row.line) + 1
}

/// The dialect of a layout.
pub(super) const fn dialect(form: SendReqForm) -> Dialect {
    match form {
        SendReqForm::Etc100 => Dialect::SendReqEtc100,
        SendReqForm::Etc101 => Dialect::SendReqEtc101,
        SendReqForm::DataExch => Dialect::DataExch,
    }
}

/// A title may name the module.
fn hint(title: &str) -> Option<SendReqForm> {
    let title = title.to_ascii_uppercase().replace([' ', '_'], "");
    let names = [
        ("ETC100", SendReqForm::Etc100),
        ("ETC101", SendReqForm::Etc101),
        ("DATAEXCH", SendReqForm::DataExch),
    ];
    names.into_iter().find(|(name, _)| title.contains(name)).map(|(_, form)| form)
}

/// A line of words: alone, with their length, or in the cells of a table.
fn row(line: usize, text: &str) -> Option<Row> {
    let cells: Vec<&str> = text.split(['|', '\t']).map(str::trim).filter(|cell| !cell.is_empty()).collect();
    let at = cells
        .iter()
        .position(|cell| words(cell).is_some_and(|(words, _)| words.len() > 1 || cells.len() == 1))?;
    let (found, length) = words(cells.get(at)?)?;
    let others = |range: Range<usize>| cells.get(range).unwrap_or_default();
    let next = others(at + 1..cells.len()).iter().find_map(|cell| cell.parse().ok());
    Some(Row {
        line,
        text: text.trim().to_string(),
        title: others(0..at).join(" "),
        words: found,
        length: length.or(next),
    })
}

/// `0000 030E 0120`, also with the length behind: a number of two or three digits. `%MW100 = 16#0000` is one word.
fn words(cell: &str) -> Option<(Vec<u16>, Option<usize>)> {
    let cell = match cell.strip_prefix("%MW") {
        Some(rest) => {
            rest.trim_start_matches(|c: char| c.is_ascii_digit()).trim_start_matches([' ', ':', '='])
        }
        None => cell,
    };
    if cell.is_empty() || cell.ends_with(';') {
        return None;
    }
    if let Ok(words) = read_words(cell) {
        return Some((words, None)).filter(|(words, _)| !words.is_empty());
    }
    let (words, length) = cell.rsplit_once([' ', ','])?;
    let length: usize = length.parse().ok()?;
    let words = read_words(words).ok().filter(|words| !words.is_empty() && length <= 2 * words.len())?;
    Some((words, Some(length)))
}
