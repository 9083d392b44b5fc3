//! `cipdeck convert`.

use std::io::{Read, Write};
use std::path::{Path, PathBuf};

use cipdeck_shared::code::{
    Change, Decoded, Dialect, Encoding, Found, Language, MAX_TEXT, Options, Remark, RemarkKind, decode,
    export, import, tell_apart,
};
use cipdeck_shared::plan::Severity;
use clap::Args;
use serde_json::{Value, json};

use super::{Exit, say};

/// Messages from one language of controllers and programs to another.
#[derive(Debug, Args)]
pub(super) struct Convert {
    /// Code with one or more messages; - = stdin
    #[arg(value_name = "FILE")]
    file: PathBuf,
    /// What it is written in; not given: each part of the text is recognised
    #[arg(long, value_name = "DIALECT")]
    from: Option<Dialect>,
    /// What is written: json, ccw-st, l5x, send-req-etc100, send-req-etc101, data-exch, sysmac-st, pycomm3, rust,
    /// cli or hex
    #[arg(long, value_name = "DIALECT")]
    to: Dialect,
    /// Instruction List instead of Structured Text; for Control Expert only
    #[arg(long)]
    il: bool,
    /// Fail (exit 2) where anything is lost, adjusted or not understood
    #[arg(long)]
    strict: bool,
    /// For machines: {"blocks":[{"name":…,"from":…,"lines":[1,9],"code":…,"changes":[…],"remarks":[…]}],"remarks":[…]}
    #[arg(long)]
    json: bool,
}

impl Convert {
    /// Reads, converts and prints: code on stdout, everything else on stderr.
    pub(super) fn execute(self) -> Exit {
        if self.il && !self.to.has_il() {
            return Exit::usage(&format!(
                "--il goes with Control Expert: there is no Instruction List of {}",
                self.to
            ));
        }
        let Decoded { text, encoding } = match read(&self.file) {
            Ok(decoded) => decoded,
            Err(error) => return Exit::usage(&format!("{}: {error}", self.file.display())),
        };
        if encoding == Encoding::Latin1 {
            let file = self.file.display();
            tell(&format!(
                "{file}: warning: it is not UTF-8: each byte is read as a character of Western Europe (Latin-1)"
            ));
        }
        let options = Options { language: if self.il { Language::Il } else { Language::St } };
        let mut imported = import(&text, self.from);
        if self.to.has_variables() {
            for (old, new) in tell_apart(imported.blocks.iter_mut().map(|found| &mut found.config)) {
                tell(&format!("{old}: called {new} here: another block has variables of that name"));
            }
        }
        let converted: Vec<Converted<'_>> =
            imported.blocks.iter().map(|found| Converted::new(found, self.to, options)).collect();
        if self.json {
            say(&machine(&converted, &imported.remarks).to_string());
        } else {
            self.print(&converted, &imported.remarks);
        }
        let remarks = imported.remarks.iter().chain(imported.blocks.iter().flat_map(|found| &found.remarks));
        let unread = remarks.clone().any(|remark| remark.severity == Severity::Error);
        let lost = converted.iter().any(|it| it.changes.iter().any(Change::is_loss))
            || remarks.clone().any(|it| matches!(&it.what, RemarkKind::Change(change) if change.is_loss()));
        // What has no code cannot be sent: there is nothing to take home.
        let missing = converted.iter().any(|it| it.code.trim().is_empty());
        if imported.blocks.is_empty() && !self.json {
            tell(&format!("{}: no message was found", self.file.display()));
        }
        if imported.blocks.is_empty() || missing || self.strict && (unread || lost) {
            Exit::FINDINGS
        } else {
            Exit::SUCCESS
        }
    }

    fn print(&self, converted: &[Converted<'_>], remarks: &[Remark]) {
        let file = self.file.display();
        for remark in remarks.iter().chain(converted.iter().flat_map(|it| &it.found.remarks)) {
            tell(&format!("{file}:{remark}"));
        }
        for it in converted {
            for change in it.changes.iter().filter(|change| change.is_loss()) {
                tell(&format!("{}: {change}", it.found.config.name()));
            }
        }
        if converted.len() > 1 && self.to.is_whole_file() {
            tell(&format!(
                "{file}: {} files of {}, one after the other: keep each by itself",
                converted.len(),
                self.to
            ));
        }
        let text = joined(self.to, converted);
        if !text.trim().is_empty() {
            say(text.trim_end());
        }
    }
}

/// One object of JSON, or an array of several; everything else one after the other.
fn joined(to: Dialect, converted: &[Converted<'_>]) -> String {
    let codes: Vec<&str> = converted.iter().map(|it| it.code.trim_end()).collect();
    if to == Dialect::Json && codes.len() > 1 {
        return format!("[\n{}\n]", codes.join(",\n"));
    }
    codes.join("\n\n")
}

/// A message, and what became of it.
struct Converted<'a> {
    found: &'a Found,
    code: String,
    changes: Vec<Change>,
}

impl<'a> Converted<'a> {
    fn new(found: &'a Found, to: Dialect, options: Options) -> Self {
        let code = export(&found.config, to, &options);
        Self { found, code: code.text, changes: code.changes }
    }
}

/// A file, or stdin, and how its characters are written.
fn read(file: &Path) -> std::io::Result<Decoded> {
    // One more than is read: then it is known to be too long.
    let limit = MAX_TEXT as u64 + 1;
    let mut bytes = Vec::new();
    if file.as_os_str() == "-" {
        std::io::stdin().lock().take(limit).read_to_end(&mut bytes)?;
    } else {
        std::fs::File::open(file)?.take(limit).read_to_end(&mut bytes)?;
    }
    decode(&bytes).map_err(std::io::Error::other)
}

/// One line on stderr. Nobody may be reading it.
fn tell(line: &str) {
    let _ = writeln!(std::io::stderr(), "{line}");
}

fn machine(converted: &[Converted<'_>], remarks: &[Remark]) -> Value {
    let blocks: Vec<Value> = converted
        .iter()
        .map(|it| {
            json!({
                "name": it.found.config.name(),
                "from": it.found.dialect.name(),
                "lines": [it.found.lines.start, it.found.lines.end - 1],
                "code": it.code,
                "changes": it.changes.iter().map(change).collect::<Vec<_>>(),
                "remarks": it.found.remarks.iter().map(remark).collect::<Vec<_>>(),
            })
        })
        .collect();
    json!({ "blocks": blocks, "remarks": remarks.iter().map(remark).collect::<Vec<_>>() })
}

fn change(change: &Change) -> Value {
    json!({
        "member": change.member,
        "from": change.from,
        "to": change.to,
        "grade": change.grade.name(),
        "why": change.why.name(),
        "text": change.why.to_string(),
    })
}

fn remark(remark: &Remark) -> Value {
    json!({
        "line": remark.line,
        "column": remark.column,
        "severity": remark.severity,
        "excerpt": remark.excerpt,
        "text": remark.what.to_string(),
    })
}

#[cfg(test)]
mod tests {
    use super::super::act;
    use super::{Dialect, MAX_TEXT};

    const NAME: &str = "0E 03 20 01 24 01 30 07\n";

    async fn convert(text: &str, arguments: &[&str]) -> u8 {
        let folder = tempfile::tempdir().unwrap();
        let file = folder.path().join("code.txt");
        std::fs::write(&file, text).unwrap();
        act(&[&["convert", file.to_str().unwrap()], arguments].concat()).await
    }

    #[tokio::test]
    async fn what_is_understood_is_converted() {
        assert_eq!(convert(NAME, &["--to", "json"]).await, 0);
        assert_eq!(convert(NAME, &["--to", "hex", "--strict"]).await, 0);
        assert_eq!(convert(NAME, &["--from", "hex", "--to", "json", "--json"]).await, 0);
        assert_eq!(convert(NAME, &["--to", "data-exch", "--il"]).await, 0);
    }

    #[tokio::test]
    async fn nothing_found_and_with_strict_anything_lost_is_an_error() {
        assert_eq!(convert("hello", &["--to", "json"]).await, 2);
        assert_eq!(convert(NAME, &["--from", "json", "--to", "json"]).await, 2);
        let with_more = format!("{NAME}hello\n");
        assert_eq!(convert(&with_more, &["--to", "json"]).await, 0);
        assert_eq!(convert(&with_more, &["--to", "json", "--strict"]).await, 2);
        let wide = "0E 04 21 00 01 00 24 01 30 07";
        assert_eq!(convert(wide, &["--to", "json"]).await, 0);
        assert_eq!(convert(wide, &["--to", "json", "--strict"]).await, 2);
    }

    #[tokio::test]
    async fn a_block_with_errors_has_no_code_and_json_keeps_it() {
        let wrong =
            r#"{"name":"x","AppCfg":{"Service":300,"Class":1,"Instance":1},"TargetCfg":{"Path":"0,0"}}"#;
        for dialect in Dialect::ALL {
            let expected = if dialect == Dialect::Json { 0 } else { 2 };
            assert_eq!(convert(wrong, &["--to", dialect.name()]).await, expected, "{dialect}");
        }
    }

    #[tokio::test]
    async fn il_of_another_vendor_is_usage() {
        assert_eq!(convert(NAME, &["--to", "ccw-st", "--il"]).await, 2);
    }

    async fn convert_bytes(bytes: &[u8]) -> u8 {
        let folder = tempfile::tempdir().unwrap();
        let file = folder.path().join("code.txt");
        std::fs::write(&file, bytes).unwrap();
        act(&["convert", file.to_str().unwrap(), "--to", "json", "--strict"]).await
    }

    #[tokio::test]
    async fn a_file_is_read_however_its_characters_are_written() {
        let utf16: Vec<u8> = format!("\u{FEFF}{NAME}").encode_utf16().flat_map(u16::to_le_bytes).collect();
        assert_eq!(convert_bytes(&utf16).await, 0);
        assert_eq!(convert_bytes(format!("\u{FEFF}{NAME}").as_bytes()).await, 0);
        assert_eq!(convert_bytes(b"# d\xE9bit\r\n0E 03 20 01 24 01 30 07\r\n").await, 0);
    }

    #[tokio::test]
    async fn what_is_no_text_is_usage() {
        assert_eq!(act(&["convert", "/nowhere/at/all", "--to", "json"]).await, 2);
        let long = b" ".repeat(MAX_TEXT + 1);
        for bytes in [&b""[..], b"\n", b"PK\x03\x04", b"\xFF\xFEa", &long] {
            assert_eq!(convert_bytes(bytes).await, 2);
        }
    }
}
