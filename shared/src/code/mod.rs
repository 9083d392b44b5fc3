//! A block as the code of a controller or a program, and the way back.
//!
//! | module | job |
//! | --- | --- |
//! | [`Dialect`] | which languages there are, and which kind of block each tells |
//! | [`decode()`] | the bytes of a file → text |
//! | [`convert()`] | a block of one kind → a block of another, with all that changed |
//! | [`export()`] | a block → text |
//! | [`import()`] | text → blocks, and what of it is not understood, line by line |
//! | [`tell_apart()`] | names for several blocks in one program |
//! | [`highlight()`] | text → where its keywords, comments, numbers, texts and names are |
//!
//! Everything is told: what a dialect cannot say is a [`Change`] and stands as a comment in the text; what an import
//! does not understand is a [`Remark`] with its line. Comments carry nothing that an import would read.

mod ccw_st;
mod change;
mod cli;
mod control_expert;
mod convert;
mod decode;
mod dialect;
mod document;
mod header;
mod hex;
mod ink;
mod json;
mod l5x;
mod message;
mod name;
mod parameters;
mod program;
mod pycomm3;
mod recognise;
mod remark;
mod rust;
mod sysmac_st;
mod text;

use alloc::string::String;
use alloc::vec::Vec;
use core::ops::Range;

use crate::config::BlockConfig;

pub use self::change::{Change, Grade, Why};
pub use self::convert::{Converted, convert};
pub use self::decode::{Decoded, Encoding, NoText, decode, with_line_feeds};
pub use self::dialect::{Dialect, Kind, Language, UnknownDialect};
pub use self::ink::{Ink, highlight};
pub use self::name::tell_apart;
pub use self::remark::{Remark, RemarkKind};

/// Bytes of text that are imported at once.
pub const MAX_TEXT: usize = 1024 * 1024;

/// Messages that are imported at once.
pub const MAX_BLOCKS: usize = 1000;

/// Remarks about one text; a text with more is something else.
const MAX_REMARKS: usize = 1000;

/// How an export is written.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Options {
    /// Structured Text or Instruction List; for Control Expert only.
    pub language: Language,
}

/// An exported block.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Code {
    /// What is copied into the editor. Empty: the block has errors, and what it would send is not known.
    pub text: String,
    /// Everything that the text does not say as the block does. Empty: it says all of it.
    pub changes: Vec<Change>,
}

impl Code {
    /// What is adjusted, lost, or sent otherwise.
    pub fn losses(&self) -> impl Iterator<Item = &Change> {
        self.changes.iter().filter(|change| change.is_loss())
    }
}

/// What was found in a text.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Imported {
    /// The messages, in the order of the text.
    pub blocks: Vec<Found>,
    /// What belongs to no message.
    pub remarks: Vec<Remark>,
}

impl Imported {
    /// Whether there are more messages than are taken: the rest of a text need not be read.
    const fn is_full(&self) -> bool {
        self.blocks.len() > MAX_BLOCKS
    }
}

/// A message in a text.
#[derive(Clone, Debug, PartialEq)]
pub struct Found {
    /// The block. It may have findings: what the text says is kept, also if it is wrong.
    pub config: BlockConfig,
    /// How it was written. A table of parameters is `ccw-st`, whose names it uses.
    pub dialect: Dialect,
    /// Its lines, counted from 1; the end is not one of them.
    pub lines: Range<usize>,
    /// What is to be said about it.
    pub remarks: Vec<Remark>,
}

/// Writes a block as code. It is converted to the kind of the dialect first.
pub fn export(block: &BlockConfig, to: Dialect, options: &Options) -> Code {
    let Converted { config, mut changes } = convert(block, to.kind_for(block));
    let Code { text, changes: further } = match to {
        Dialect::Json => json::export(&config),
        Dialect::CcwSt => ccw_st::export(&config, &changes),
        Dialect::L5x => l5x::export(&config, &changes),
        Dialect::SendReqEtc100 | Dialect::SendReqEtc101 | Dialect::DataExch => {
            control_expert::export(&config, options.language, &changes)
        }
        Dialect::SysmacSt => sysmac_st::export(&config, &changes),
        Dialect::Pycomm3 => pycomm3::export(&config, &changes),
        Dialect::Rust => rust::export(&config, &changes),
        Dialect::Cli => cli::export(&config, &changes),
        Dialect::Hex => hex::export(&config),
    };
    // An error of the block is told once, as it was before the conversion.
    let is_told = changes.iter().any(|change| change.why == Why::NotSendable);
    changes.extend(further.into_iter().filter(|change| !is_told || change.why != Why::NotSendable));
    Code { text: header::with_losses(to, text, &changes), changes }
}

/// Reads blocks from a text. Without a dialect each part of the text is recognised by itself.
pub fn import(text: &str, dialect: Option<Dialect>) -> Imported {
    let mut imported = Imported::default();
    if text.len() > MAX_TEXT {
        imported.remarks.push(Remark::error(1, 1, "", RemarkKind::TextTooLong { limit: MAX_TEXT }));
        return imported;
    }
    for piece in recognise::pieces(text, dialect) {
        let Imported { mut blocks, mut remarks } = read(piece.form, &piece.text);
        let down = piece.first_line - 1;
        for found in &mut blocks {
            found.lines = found.lines.start + down..found.lines.end + down;
            remark::move_down(&mut found.remarks, down);
        }
        remark::move_down(&mut remarks, down);
        imported.blocks.append(&mut blocks);
        imported.remarks.append(&mut remarks);
        if imported.is_full() {
            break;
        }
    }
    if imported.blocks.is_empty() && imported.remarks.is_empty() && !text.trim().is_empty() {
        let what = RemarkKind::told(&"there is no message in this text");
        imported.remarks.push(Remark::error(1, 1, text, what));
    }
    imported.blocks.sort_by_key(|found| found.lines.start);
    if let Some(first) = imported.blocks.get(MAX_BLOCKS) {
        let (line, limit) = (first.lines.start, MAX_BLOCKS);
        imported.blocks.truncate(MAX_BLOCKS);
        imported.remarks.push(Remark::error(line, 1, "", RemarkKind::TooManyBlocks { limit }));
    }
    imported.remarks.sort_by_key(|remark| (remark.line, remark.column));
    if let Some(first) = imported.remarks.get(MAX_REMARKS) {
        let (line, more) = (first.line, imported.remarks.len() - MAX_REMARKS);
        imported.remarks.truncate(MAX_REMARKS);
        imported.remarks.push(Remark::error(line, 1, "", RemarkKind::TooManyRemarks { more }));
    }
    imported
}

/// One piece, its lines counted from 1.
fn read(form: recognise::Form, text: &str) -> Imported {
    match form {
        recognise::Form::Parameters => parameters::import(text),
        recognise::Form::Code(dialect) => match dialect {
            Dialect::Json => json::import(text),
            Dialect::CcwSt => ccw_st::import(text),
            Dialect::L5x => l5x::import(text),
            Dialect::SendReqEtc100 | Dialect::SendReqEtc101 | Dialect::DataExch => {
                control_expert::import(text, dialect)
            }
            Dialect::SysmacSt => sysmac_st::import(text),
            Dialect::Pycomm3 => pycomm3::import(text),
            Dialect::Rust => rust::import(text),
            Dialect::Cli => cli::import(text),
            Dialect::Hex => hex::import(text),
        },
    }
}

#[cfg(test)]
mod tests;
