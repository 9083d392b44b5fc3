//! Codes and bytes as text.

use alloc::format;
use alloc::string::String;
use core::fmt::{Display, Write};

use crate::table::{Confidence, Entry};

/// `0x05 Path destination unknown. Class, instance …` A name that is not confirmed says how well it is known.
pub(super) fn coded(code: impl Display, entry: Option<Entry>) -> String {
    let Some(entry) = entry else { return format!("{code}, not in the tables") };
    let mut text = format!("{code} {}", entry.name);
    if entry.confidence != Confidence::Confirmed {
        let _ = write!(text, " ({})", entry.confidence.word());
    }
    for sentence in [entry.meaning, entry.hint] {
        if !sentence.is_empty() {
            text.push_str(if text.ends_with('.') { " " } else { ". " });
            text.push_str(sentence);
        }
    }
    text
}

/// `1 (0x01) Identity`
pub(super) fn numbered(number: u32, width: usize, entry: Option<Entry>) -> String {
    let name = entry.map_or("", |entry| entry.name);
    let space = if name.is_empty() { "" } else { " " };
    format!("{number} ({number:#0width$x}){space}{name}")
}

/// `de ad be ef`
pub(super) fn hex(bytes: &[u8]) -> String {
    let mut text = String::new();
    for byte in bytes {
        let space = if text.is_empty() { "" } else { " " };
        let _ = write!(text, "{space}{byte:02x}");
    }
    text
}

/// The bytes as text, if all of them are printable ASCII.
pub(super) fn ascii(bytes: &[u8]) -> Option<&str> {
    let printable = bytes.iter().all(|byte| byte.is_ascii_graphic() || *byte == b' ');
    if printable { core::str::from_utf8(bytes).ok() } else { None }
}
