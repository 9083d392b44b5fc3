//! Instruction List as Structured Text, line by line: what is loaded is assigned where it is stored.

use alloc::format;
use alloc::string::{String, ToString};
use alloc::vec::Vec;

use super::super::remark::{Remark, RemarkKind};
use super::super::text::{Lexeme, tokens};

/// Operators after which the accumulator holds what the program makes.
const CALCULATE: [&str; 22] = [
    "LDN", "AND", "ANDN", "OR", "ORN", "XOR", "XORN", "NOT", "ADD", "SUB", "MUL", "DIV", "MOD", "GT", "GE",
    "EQ", "NE", "LE", "LT", "&", "SHL", "SHR",
];

/// Operators that are the program's own.
const PROGRAM: [&str; 10] = ["JMP", "JMPC", "JMPCN", "RET", "RETC", "RETCN", "S", "R", "STN", "NOP"];

/// Functions of one argument that make an address.
const ADDRESS: [&str; 3] = ["ADDR", "ADDM", "ADDMX"];

/// Lines that an operand may go on for.
const MAX_OPERAND_LINES: usize = 50;

/// The text without its comments; lines and columns stay.
pub(super) fn uncommented(text: &str) -> String {
    let mut plain = String::with_capacity(text.len());
    let mut at = 0;
    for token in tokens(text, true).0.iter().filter(|token| token.lexeme == Lexeme::Comment) {
        plain.push_str(text.get(at..token.place.at).unwrap_or_default());
        plain.extend(token.text.chars().map(|c| if c == '\n' { '\n' } else { ' ' }));
        at = token.end();
    }
    plain.push_str(text.get(at..).unwrap_or_default());
    plain
}

/// Structured Text with the same lines. A text without IL is given back as it is.
pub(super) fn as_st(text: &str) -> (String, Vec<Remark>) {
    let mut translator = Translator { accumulator: None, remarks: Vec::new() };
    let lines: Vec<String> =
        whole(text).enumerate().map(|(index, line)| translator.line(index + 1, &line)).collect();
    (lines.join("\n"), translator.remarks)
}

/// The lines of a text. An operator whose parentheses are closed on a later line, as in `ADDMX (` `IN := x` `)`, is on
/// its first line as a whole; the others are empty.
fn whole(text: &str) -> impl Iterator<Item = String> {
    let lines: Vec<&str> = text.lines().collect();
    let mut swallowed = 0;
    (0..lines.len()).map(move |index| {
        let line = lines.get(index).copied().unwrap_or_default();
        if swallowed > 0 {
            swallowed -= 1;
            return String::new();
        }
        if !is_operator(line) || open_after(line, 0) == 0 {
            return line.to_string();
        }
        let mut open = open_after(line, 0);
        for (more, next) in lines.iter().skip(index + 1).take(MAX_OPERAND_LINES).enumerate() {
            open = open_after(next, open);
            if open == 0 {
                swallowed = more + 1;
                return lines.get(index..=index + swallowed).unwrap_or_default().join(" ");
            }
        }
        line.to_string()
    })
}

/// Parentheses that are open behind a line.
fn open_after(line: &str, open: usize) -> usize {
    let mut in_text = false;
    line.chars().fold(open, |open, c| {
        in_text ^= c == '\'';
        match c {
            '(' if !in_text => open + 1,
            ')' if !in_text => open.saturating_sub(1),
            _ => open,
        }
    })
}

struct Translator {
    accumulator: Option<String>,
    remarks: Vec<Remark>,
}

impl Translator {
    fn line(&mut self, number: usize, line: &str) -> String {
        let trimmed = line.trim();
        // A label alone, or before an operator.
        let labelled =
            trimmed.split_once(':').filter(|(label, rest)| !rest.starts_with('=') && is_name(label));
        if let Some((_, rest)) = labelled.filter(|(_, rest)| rest.trim().is_empty() || is_operator(rest)) {
            self.note(number, trimmed, "a label");
            return self.line(number, rest);
        }
        if let Some(what) = of_pl7(trimmed) {
            self.note(number, trimmed, what);
            return String::new();
        }
        if !is_operator(trimmed) {
            return line.to_string();
        }
        let (operator, operand) = trimmed.split_once(char::is_whitespace).unwrap_or((trimmed, ""));
        let (upper, operand) =
            (operator.to_ascii_uppercase(), operand.trim().trim_end_matches(';').trim_end());
        match upper.as_str() {
            "LD" => self.accumulator = Some(operand.to_string()),
            "ST" => {
                if let Some(value) = &self.accumulator {
                    return format!("{operand} := {value};");
                }
                self.note(number, trimmed, "what the program calculates");
            }
            "CAL" | "CALC" | "CALCN" => return format!("{operand};"),
            "SEND_REQ" | "DATA_EXCH" => {
                let address = self.accumulator.take().unwrap_or_default();
                return format!("{upper}({address}, {operand});");
            }
            function if ADDRESS.contains(&function) => {
                let argument = if operand.is_empty() {
                    format!("({})", self.accumulator.take().unwrap_or_default())
                } else {
                    operand.to_string()
                };
                self.accumulator = Some(format!("{upper}{argument}"));
            }
            function if CALCULATE.contains(&function) => {
                self.accumulator = None;
                self.note(number, trimmed, "a condition");
            }
            _ => self.note(number, trimmed, "the program's way"),
        }
        String::new()
    }

    fn note(&mut self, line: usize, excerpt: &str, what: &str) {
        self.remarks.push(Remark::note(line, 1, excerpt, RemarkKind::NoEffect(what.to_string())));
    }
}

/// What programs that come from PL7 have besides: `!` before a sentence, `%L10:`, `RESET %M10;`.
fn of_pl7(line: &str) -> Option<&'static str> {
    let label = line.strip_prefix("%L").and_then(|label| label.strip_suffix(':'));
    if line == "!" || label.is_some_and(|label| label.bytes().all(|byte| byte.is_ascii_digit())) {
        return Some("a label");
    }
    let (word, operand) = line.split_once(char::is_whitespace)?;
    let is_bit = matches!(word.to_ascii_uppercase().as_str(), "SET" | "RESET");
    let is_operand = operand.trim_start().starts_with(|c: char| c == '%' || c.is_alphabetic());
    (is_bit && is_operand && !operand.contains(":=")).then_some("the program's way")
}

fn is_name(text: &str) -> bool {
    !text.is_empty() && text.chars().all(|c| c.is_alphanumeric() || c == '_')
}

/// Whether a line is of IL: an operator, and an operand that is none of Structured Text.
fn is_operator(line: &str) -> bool {
    let line = line.trim();
    let (word, operand) = line.split_once(char::is_whitespace).unwrap_or((line, ""));
    let (word, operand) = (word.to_ascii_uppercase(), operand.trim());
    let word = word.as_str();
    let is_st = operand.starts_with(":=") || operand.starts_with(':') || operand.starts_with('=');
    let call = operand.starts_with('(');
    if is_st {
        return false;
    }
    match word {
        "LD" | "ST" | "CAL" | "CALC" | "CALCN" => !operand.is_empty(),
        "SEND_REQ" | "DATA_EXCH" => !operand.is_empty() && !call,
        word if ADDRESS.contains(&word) => operand.is_empty() || call && !operand.ends_with(';'),
        word if CALCULATE.contains(&word) => !call || operand.len() > 1,
        word => PROGRAM.contains(&word),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn what_is_loaded_is_assigned_where_it_is_stored() {
        let il = "LD '0.2.0.10.0.0.1'\nADDR\nST Adr\nLD 16#000A\nST G[3]\nL1:\n LD a\nANDN b\nJMPC L1\nLD Adr\n\
                  SEND_REQ 14, S, G, R\nADDMX (IN := x)\nST y\nCAL t(IN := a)\nADDMX (\nIN := 'a(b'\n)\nST z";
        let (st, remarks) = as_st(il);
        let lines: Vec<&str> = st.lines().filter(|line| !line.is_empty()).collect();
        assert_eq!(
            lines,
            [
                "Adr := ADDR('0.2.0.10.0.0.1');",
                "G[3] := 16#000A;",
                "SEND_REQ(Adr, 14, S, G, R);",
                "y := ADDMX(IN := x);",
                "t(IN := a);",
                "z := ADDMX( IN := 'a(b' );",
            ]
        );
        assert_eq!(st.lines().count(), il.lines().count());
        let (pl7, told) = as_st("!\n%L10:\nRESET %M10;\nset Lamp ;\nSET := 1;\nSET (x);");
        assert_eq!((pl7.trim_start(), told.len()), ("SET := 1;\nSET (x);", 4));
        let noted: Vec<usize> = remarks.iter().map(|remark| remark.line).collect();
        assert_eq!(noted, [6, 8, 9]);
    }

    #[test]
    fn structured_text_stays_as_it_is() {
        let st = "VAR\n S : INT;\nEND_VAR\nR := 5;\nSEND_REQ(a, 14, b, c, d);\nAdr := ADDR('x');\nx: ARRAY [0..1] OF INT;";
        assert_eq!(as_st(st), (st.to_string(), Vec::new()));
        assert_eq!(uncommented("a(* b\n *)c // d\n'(* e *)'"), "a    \n   c     \n'(* e *)'");
    }
}
