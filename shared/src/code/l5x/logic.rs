//! What the logic of an export does with a `MESSAGE`: rungs as neutral text, and lines of Structured Text.

use alloc::string::{String, ToString};
use alloc::vec::Vec;

use roxmltree::{Document, Node};

/// An instruction of a rung with its operands, or an assignment of Structured Text as `MOV`.
#[derive(Clone, Debug, PartialEq, Eq)]
pub(super) struct Instruction {
    pub(super) name: String,
    pub(super) operands: Vec<String>,
}

/// A rung, or a line of Structured Text.
#[derive(Clone, Debug)]
pub(super) struct Rung {
    /// Its first byte in the document.
    pub(super) at: usize,
    pub(super) instructions: Vec<Instruction>,
}

/// All logic of a document, in its order.
pub(super) fn rungs(document: &Document<'_>) -> Vec<Rung> {
    let text = |node: &Node<'_, '_>| -> String { node.children().filter_map(|child| child.text()).collect() };
    let nodes = document.descendants();
    nodes
        .filter_map(|node| {
            let instructions = if node.has_tag_name("Text") && is_in(node, "Rung") {
                instructions(&text(&node))
            } else if node.has_tag_name("Line") && is_in(node, "STContent") {
                statements(&text(&node))
            } else {
                return None;
            };
            Some(Rung { at: node.range().start, instructions })
        })
        .collect()
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
}

impl Instruction {
    /// Whether it is this one, and its first operand that one.
    pub(super) fn is(&self, name: &str, operand: &str) -> bool {
        self.name == name && self.operands.first().is_some_and(|first| first.eq_ignore_ascii_case(operand))
    }
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

/// `b.c := 1; MSG(b);`
fn statements(text: &str) -> Vec<Instruction> {
    let code = text.split_once("//").map_or(text, |(code, _)| code);
    let statement = |statement: &str| match statement.split_once(":=") {
        Some((to, value)) => {
            let operands = [value, to].map(|text| text.trim().to_string()).to_vec();
            alloc::vec![Instruction { name: "MOV".into(), operands }]
        }
        None => instructions(statement),
    };
    code.split(';').flat_map(statement).collect()
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
    fn an_assignment_is_a_move() {
        let found = statements("b.UnconnectedTimeout := 3000000; MSG(b); // c.d := 1;");
        assert_eq!(found.len(), 2);
        let rung = Rung { at: 0, instructions: found };
        assert!(rung.sends("B"));
        assert_eq!(rung.moves_to("B").collect::<Vec<_>>(), [("UnconnectedTimeout", "3000000")]);
    }
}
