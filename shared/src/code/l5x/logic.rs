//! What the logic of an export does with a `MESSAGE`: rungs as neutral text, and statements of Structured Text.

use alloc::string::{String, ToString};
use alloc::vec::Vec;

use roxmltree::{Document, Node};

use super::project::{Scope, scope};
use super::structured::Statements;

/// An instruction of a rung with its operands, or an assignment of Structured Text as `MOV`.
#[derive(Clone, Debug, PartialEq, Eq)]
pub(super) struct Instruction {
    pub(super) name: String,
    pub(super) operands: Vec<String>,
}

/// A rung, or a statement of Structured Text.
#[derive(Clone, Debug)]
pub(super) struct Rung {
    /// Its first byte in the document.
    pub(super) at: usize,
    /// Whose tags its names are.
    pub(super) scope: Scope,
    pub(super) instructions: Vec<Instruction>,
}

/// All logic of a document, in its order.
pub(super) fn rungs(document: &Document<'_>) -> Vec<Rung> {
    let mut rungs = Vec::new();
    for node in document.descendants() {
        if node.has_tag_name("Text") && is_in(node, "Rung") {
            let instructions = instructions(&text_of(node));
            rungs.push(Rung { at: node.range().start, scope: scope(node), instructions });
        } else if node.has_tag_name("STContent") {
            let mut statements = Statements::default();
            for line in node.children().filter(|line| line.has_tag_name("Line")) {
                statements.line(line.range().start, &text_of(line));
            }
            let home = scope(node);
            let rung = |(at, statement): (usize, String)| {
                let instructions = of_statement(&statement);
                // `END_IF` is none.
                (!instructions.is_empty()).then(|| Rung { at, scope: home.clone(), instructions })
            };
            rungs.extend(statements.finish().into_iter().filter_map(rung));
        }
    }
    rungs
}

impl Rung {
    /// The `MSG` of a message.
    pub(super) fn sends(&self, message: &str) -> bool {
        self.instructions.iter().any(|instruction| instruction.is("MSG", message))
    }

    /// `MOV(value, message.member)`: the members and their values.
    pub(super) fn moves_to<'a>(&'a self, message: &str) -> impl Iterator<Item = (&'a str, &'a str)> {
        self.instructions.iter().filter_map(move |instruction| match instruction.operands.as_slice() {
            [value, to] if matches!(instruction.name.as_str(), "MOV" | "MOVE") => {
                let member = to.split_once('.').filter(|(tag, _)| tag.eq_ignore_ascii_case(message))?.1;
                Some((member, value.as_str()))
            }
            _ => None,
        })
    }

    /// The Add-On Instruction that a message is given to, which then sends it.
    pub(super) fn gives(&self, message: &str) -> Option<&str> {
        let given = |instruction: &&Instruction| {
            instruction.name != "MSG"
                && instruction.operands.iter().any(|operand| operand.eq_ignore_ascii_case(message))
        };
        self.instructions.iter().find(given).map(|instruction| instruction.name.as_str())
    }
}

impl Instruction {
    /// Whether it is this one, and its first operand that one.
    pub(super) fn is(&self, name: &str, operand: &str) -> bool {
        self.name == name && self.operands.first().is_some_and(|first| first.eq_ignore_ascii_case(operand))
    }
}

fn text_of(node: Node<'_, '_>) -> String {
    node.children().filter_map(|child| child.text()).collect()
}

fn is_in(node: Node<'_, '_>, name: &str) -> bool {
    node.parent().is_some_and(|parent| parent.has_tag_name(name))
}

/// `XIC(a)MOV(1,b.c)MSG(b);`. Branches do not matter here.
fn instructions(text: &str) -> Vec<Instruction> {
    let mut found = Vec::new();
    let mut rest = text;
    while let Some((before, after)) = rest.split_once('(') {
        let name = before.rsplit(|c: char| !(c.is_alphanumeric() || c == '_')).next().unwrap_or_default();
        let (operands, end) = operands(after);
        found.push(Instruction { name: name.to_ascii_uppercase(), operands });
        rest = after.get(end..).unwrap_or_default();
    }
    found
}

/// What stands between the parentheses, and where it ends.
fn operands(text: &str) -> (Vec<String>, usize) {
    let mut operands = Vec::new();
    let (mut depth, mut from) = (0_usize, 0);
    for (at, c) in text.char_indices() {
        match c {
            '(' | '[' => depth += 1,
            ')' if depth == 0 => {
                operands.push(text.get(from..at).unwrap_or_default().trim().to_string());
                return (operands, at + 1);
            }
            ')' | ']' => depth = depth.saturating_sub(1),
            ',' if depth == 0 => {
                operands.push(text.get(from..at).unwrap_or_default().trim().to_string());
                from = at + 1;
            }
            _ => {}
        }
    }
    operands.push(text.get(from..).unwrap_or_default().trim().to_string());
    (operands, text.len())
}

/// `b.c := 1` or `MSG(b)`, also behind `IF … THEN`.
fn of_statement(statement: &str) -> Vec<Instruction> {
    let Some((to, value)) = statement.split_once(":=") else { return instructions(statement) };
    // What stands before the variable is a keyword or the label of a CASE.
    let to = to.trim().rsplit(|c: char| c.is_whitespace() || c == ':').next().unwrap_or_default();
    let operands = [value.trim(), to].map(ToString::to_string).to_vec();
    alloc::vec![Instruction { name: "MOV".into(), operands }]
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_rung_is_its_instructions() {
        let found = instructions("XIC(a)[XIO(b.EN) ,XIC(c[1,2]) ]CPT(d,(e+1)*2)MSG( b );");
        let found: Vec<(&str, Vec<&str>)> = found
            .iter()
            .map(|it| (it.name.as_str(), it.operands.iter().map(String::as_str).collect()))
            .collect();
        let expected = [
            ("XIC", alloc::vec!["a"]),
            ("XIO", alloc::vec!["b.EN"]),
            ("XIC", alloc::vec!["c[1,2]"]),
            ("CPT", alloc::vec!["d", "(e+1)*2"]),
            ("MSG", alloc::vec!["b"]),
        ];
        assert_eq!(found, expected);
        assert_eq!(instructions("XIC(a").len(), 1);
        assert_eq!(instructions("").len(), 0);
    }

    #[test]
    fn an_assignment_is_a_move_wherever_it_stands() {
        for statement in ["b.c := 3", "IF a THEN b.c := 3", "1: b.c:=3", "2:b.c := 3", "ELSE\n b.c := 3"] {
            let rung = Rung { at: 0, scope: Scope::Controller, instructions: of_statement(statement) };
            assert_eq!(rung.moves_to("B").collect::<Vec<_>>(), [("c", "3")], "{statement}");
        }
        let rung = Rung { at: 0, scope: Scope::Controller, instructions: of_statement("IF a THEN MSG(b)") };
        assert!(rung.sends("B") && rung.gives("b").is_none());
    }
}
