//! What a line looks like.

use crate::code::{hex, parameters};

/// What a line looks like.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Look {
    /// Blank: it belongs to what is around it.
    Nothing,
    /// A comment with `#` or `//`: it belongs to what comes after it.
    Remark,
    /// L5X.
    Xml,
    /// A block.
    Json,
    /// pycomm3.
    Python,
    /// rseip.
    Rust,
    /// `cipdeck send`.
    Shell,
    /// Bytes.
    Hex,
    /// Words of a SEND_REQ, alone or in a row of a table.
    Words,
    /// A row of a table of parameters.
    Table,
    /// Structured Text or Instruction List, and whatever looks like nothing else.
    Iec,
}

/// What a line looks like, after one that looks like `before`.
pub(super) fn look(line: &str, before: Option<Look>) -> Look {
    let indented = line.starts_with([' ', '\t']);
    let line = line.trim();
    let starts = |words: &[&str]| words.iter().any(|word| line.starts_with(word));
    let has = |words: &[&str]| words.iter().any(|word| line.contains(word));
    if line.is_empty() {
        return Look::Nothing;
    }
    if starts(&["#!/", "# ", "//"]) || line == "#" {
        return if indented && matches!(before, Some(Look::Python | Look::Rust)) {
            Look::Nothing
        } else {
            Look::Remark
        };
    }
    if starts(&["<"]) {
        return Look::Xml;
    }
    if is_json(line) {
        return Look::Json;
    }
    if is_shell(line) {
        return Look::Shell;
    }
    if starts(&["import ", "from ", "with ", "def ", "class ", "if __name__", "async def ", "print("])
        && !has(&[":="])
        || has(&["generic_message(", "CIPDriver(", "LogixDriver("])
    {
        return Look::Python;
    }
    if starts(&["use ", "let ", "fn ", "async fn ", "pub ", "#[", "impl ", "mod ", "const "]) && !has(&[":="])
        || has(&[".await", "EPath::", "EPath::default(", "MessageRequest::new("])
    {
        return Look::Rust;
    }
    match before {
        // Inside of a block, and statements beside it.
        Some(Look::Python) if indented || is_python_statement(line) => return Look::Python,
        Some(Look::Rust) if indented || starts(&["}", ")"]) => return Look::Rust,
        _ => {}
    }
    if is_words(line) && !hex::is_request(line) {
        return Look::Words;
    }
    if hex::is_hex(line) {
        return Look::Hex;
    }
    if parameters::is_rule(line) {
        return Look::Nothing;
    }
    if parameters::is_row(line) {
        return Look::Table;
    }
    // The head of a table: what it is of is seen in the next line.
    if line.starts_with('|') {
        return if matches!(before, Some(Look::Words | Look::Table)) { Look::Nothing } else { Look::Remark };
    }
    if is_python_assignment(line) && has(&["pycomm3", "bytes.fromhex(", "b'", "b\"", "bytes("]) {
        return Look::Python;
    }
    Look::Iec
}

/// `{"name": …`, `[{`, or an opening bracket alone.
fn is_json(line: &str) -> bool {
    let Some(rest) = line.strip_prefix(['{', '[']) else { return false };
    let rest = rest.trim_start();
    rest.is_empty() || rest.starts_with(['"', '{', '}', ']'])
}

/// Groups of four hexadecimal digits: `0000 030E 0120`, `16#0000, 16#030E`; one alone in its line, or several in a cell.
fn is_words(line: &str) -> bool {
    let word = |group: &str| {
        let digits = group.strip_prefix("16#").unwrap_or(group);
        digits.len() == 4 && digits.chars().all(|c| c.is_ascii_hexdigit())
    };
    let cells = line.split(['|', '\t']).map(str::trim).filter(|cell| !cell.is_empty());
    let alone = cells.clone().count() == 1;
    cells.into_iter().any(|cell| {
        let groups = cell.split([' ', ',', ';']).filter(|group| !group.is_empty());
        let words = groups.clone().filter(|group| word(group)).count();
        // The length may stand behind.
        let length =
            groups.clone().next_back().is_some_and(|last| last.parse::<u16>().is_ok() && last.len() < 4);
        let all = words + usize::from(length) == groups.count();
        all && (words > 1 || words == 1 && alone && !length)
    })
}

/// `cipdeck send …`, however it is called.
fn is_shell(line: &str) -> bool {
    let line = line.strip_prefix("$ ").unwrap_or(line);
    let mut words = line.split_whitespace().skip_while(|word| word.contains('=') && !word.starts_with('-'));
    let command = words.next().unwrap_or_default();
    let program = command.rsplit(['/', '\\']).next().unwrap_or_default();
    matches!(program, "cipdeck" | "cipdeck.exe")
}

/// What may follow in a program that is Python so far.
fn is_python_statement(line: &str) -> bool {
    const WORDS: [&str; 14] = [
        "if ", "elif ", "else:", "for ", "while ", "try:", "except", "finally:", "raise ", "return",
        "assert ", "@", ")", "]",
    ];
    let begins = WORDS.iter().any(|word| line.starts_with(word)) || line.starts_with('}');
    is_python_assignment(line) || begins && !line.contains(":=") && !line.ends_with(';')
}

/// `reply = …`, but neither `:=` nor `==`.
fn is_python_assignment(line: &str) -> bool {
    let Some((name, value)) = line.split_once('=') else { return false };
    let name = name.trim_end();
    let is_name = |c: char| c.is_alphanumeric() || "_.,[] ".contains(c);
    !name.is_empty()
        && name.chars().all(is_name)
        && !value.starts_with(['=', '>'])
        && !value.trim_end().ends_with(';')
}

/// Instruction List: an operator, white space, operands, and no semicolon.
pub(super) fn is_instruction(line: &str) -> bool {
    const OPERATORS: [&str; 12] =
        ["LD", "LDN", "ST", "STN", "CAL", "CALC", "CALCN", "JMP", "JMPC", "RET", "SEND_REQ", "DATA_EXCH"];
    let line = line.trim();
    let line = line
        .rsplit_once("*)")
        .filter(|(_, rest)| rest.trim().is_empty())
        .map_or(line, |_| line.split_once("(*").map_or(line, |(code, _)| code.trim_end()));
    let end = line.find(char::is_whitespace).unwrap_or(line.len());
    let Some((word, rest)) = line.split_at_checked(end) else { return false };
    let operator = OPERATORS.iter().any(|operator| word.eq_ignore_ascii_case(operator));
    operator
        && !line.ends_with(';')
        && !rest.trim_start().starts_with([':', '.', '[', '(']) | word.eq_ignore_ascii_case("CAL")
}
