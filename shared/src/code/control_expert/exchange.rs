//! Exchange files of Control Expert (`.XST`, `.XIL`, `.XLD`, `.XBD`, `.XEF`): sections and variables in XML, as one text
//! with the same lines.
//!
//! As public projects have them: `STSource` and `ILSource` hold text; in sections that are drawn an `FFBBlock` names its
//! function in `typeName` and its pins in `formalParameter` and `effectiveParameter`; `dataBlock` has `variables` with
//! `typeName`, `topologicalAddress`, `variableInit` and, for elements, `instanceElementDesc`.

use alloc::boxed::Box;
use alloc::collections::BTreeMap;
use alloc::format;
use alloc::string::{String, ToString};
use alloc::vec;
use alloc::vec::Vec;

use roxmltree::Node;

use super::super::document::{self, Lines};
use super::super::remark::Remark;

/// Elements of an array whose initial values are read.
const MAX_ELEMENTS: i64 = 4096;

/// Functions that make an address.
const ADDRESS: [&str; 3] = ["ADDR", "ADDM", "ADDMX"];

/// Whether a text is such a file.
pub(in super::super) fn is_exchange(text: &str) -> bool {
    text.trim_start_matches('\u{feff}').trim_start().starts_with('<') && text.contains("ExchangeFile")
}

/// Declarations and statements, each on the line where the file has it.
pub(super) fn as_text(text: &str) -> Result<String, Box<Remark>> {
    let document = document::parse(text)?;
    let lines = Lines::new(text);
    let mut page = Page { lines: vec![String::new(); lines.count()], places: &lines };
    for node in document.descendants() {
        match node.tag_name().name() {
            "STSource" | "ILSource" => page.source(node),
            "variables" => page.declare(node),
            "FFBBlock" => page.block(node),
            _ => {}
        }
    }
    Ok(page.lines.join("\n"))
}

struct Page<'a> {
    lines: Vec<String>,
    places: &'a Lines<'a>,
}

impl Page<'_> {
    /// From the line on that a byte is on.
    fn write(&mut self, at: usize, text: &str) {
        let first = self.places.place(at).0.saturating_sub(1);
        for (line, text) in self.lines.iter_mut().skip(first).zip(text.lines()) {
            line.push_str(text);
            line.push(' ');
        }
    }

    fn source(&mut self, section: Node<'_, '_>) {
        for text in section.children().filter(Node::is_text) {
            self.write(text.range().start, text.text().unwrap_or_default());
        }
    }

    /// A variable that can be words or an address.
    fn declare(&mut self, variable: Node<'_, '_>) {
        let (Some(name), Some(kind)) = (variable.attribute("name"), variable.attribute("typeName")) else {
            return;
        };
        let element = kind.rsplit(' ').next().unwrap_or_default().to_ascii_uppercase();
        let is_word = matches!(element.as_str(), "INT" | "UINT" | "WORD") || element.starts_with("STRING");
        if !is_word || !name.chars().all(|c| c.is_alphanumeric() || c == '_') {
            return;
        }
        let at = variable.attribute("topologicalAddress").map(|at| format!(" AT {at}")).unwrap_or_default();
        let initial = initial(variable, kind).map(|value| format!(" := {value}")).unwrap_or_default();
        self.write(variable.range().start, &format!("VAR {name}{at} : {kind}{initial}; END_VAR"));
    }

    /// A drawn block as a statement.
    fn block(&mut self, block: Node<'_, '_>) {
        let function = block.attribute("typeName").unwrap_or_default().to_ascii_uppercase();
        let statement = match function.as_str() {
            "SEND_REQ" | "DATA_EXCH" => Some(format!("{function}({});", arguments(block))),
            "MOVE" => pin(block, "OUT").zip(pin(block, "IN")).map(|(to, from)| format!("{to} := {from};")),
            name if ADDRESS.contains(&name) => {
                pin(block, "OUT").zip(pin(block, "IN")).map(|(to, text)| format!("{to} := {name}({text});"))
            }
            _ => None,
        };
        if let Some(statement) = statement {
            self.write(block.range().start, &statement);
        }
    }
}

/// `ADR := x, GEST := y`. A pin that a line leads to has what the block at its other end makes.
fn arguments(block: Node<'_, '_>) -> String {
    let mut arguments: Vec<String> = Vec::new();
    let mut names = Vec::new();
    for node in pins(block) {
        let name = node.attribute("formalParameter").unwrap_or_default();
        let is_output = node.has_tag_name("outputVariable");
        if matches!(name, "" | "EN" | "ENO") || names.contains(&name) {
            continue;
        }
        let linked = || if is_output { None } else { linked(block, name) };
        let Some(value) = node.attribute("effectiveParameter").map(ToString::to_string).or_else(linked)
        else {
            continue;
        };
        names.push(name);
        arguments.push(format!("{name} {} {value}", if is_output { "=>" } else { ":=" }));
    }
    arguments.join(", ")
}

/// The address that a line brings to a pin.
fn linked(block: Node<'_, '_>, name: &str) -> Option<String> {
    let instance = block.attribute("instanceName")?;
    let is_end = |node: &Node<'_, '_>, object: &str, pin: &str| {
        node.attribute("parentObjectName") == Some(object) && node.attribute("pinName") == Some(pin)
    };
    // A line stays in its section.
    let inside = |tag: &'static str| {
        let network = block.parent();
        network.into_iter().flat_map(|it| it.children()).filter(move |node| node.has_tag_name(tag))
    };
    let leads_here = |link: &Node<'_, '_>| {
        link.children().any(|end| end.has_tag_name("linkDestination") && is_end(&end, instance, name))
    };
    let source = inside("linkFB").find(leads_here)?.children().find(|end| end.has_tag_name("linkSource"))?;
    let object = source.attribute("parentObjectName")?;
    let before = inside("FFBBlock").find(|block| block.attribute("instanceName") == Some(object))?;
    let function = before.attribute("typeName")?.to_ascii_uppercase();
    let text = pin(before, "IN").filter(|_| ADDRESS.contains(&function.as_str()))?;
    Some(format!("{function}({text})"))
}

fn pins<'a, 'i>(block: Node<'a, 'i>) -> impl Iterator<Item = Node<'a, 'i>> {
    let is_pin =
        |node: &Node<'_, '_>| node.has_tag_name("inputVariable") || node.has_tag_name("outputVariable");
    block.descendants().filter(is_pin)
}

/// What a pin is bound to.
fn pin<'a>(block: Node<'a, '_>, name: &str) -> Option<&'a str> {
    pins(block).find(|pin| pin.attribute("formalParameter") == Some(name))?.attribute("effectiveParameter")
}

/// The value at the start: that of a variable, or the elements of an array. Those that are not told are 0.
fn initial(variable: Node<'_, '_>, kind: &str) -> Option<String> {
    if let Some(init) = variable.children().find(|node| node.has_tag_name("variableInit")) {
        return init.attribute("value").map(ToString::to_string);
    }
    let low: i64 = kind.split_once('[')?.1.split_once("..")?.0.trim().parse().ok()?;
    let mut elements = BTreeMap::new();
    for element in variable.children().filter(|node| node.has_tag_name("instanceElementDesc")) {
        let name = element.attribute("name").unwrap_or_default();
        let index = name.strip_prefix('[').and_then(|name| name.strip_suffix(']')?.trim().parse().ok());
        let value = element.children().find(|node| node.has_tag_name("value")).and_then(|value| value.text());
        if let (Some(index), Some(value)) = (index, value) {
            elements.insert(index, value.trim());
        }
    }
    let last: i64 = *elements.keys().next_back()?;
    if last.saturating_sub(low) >= MAX_ELEMENTS {
        return None;
    }
    let values: Vec<&str> = (low..=last).map(|at| elements.get(&at).copied().unwrap_or("0")).collect();
    Some(format!("[{}]", values.join(", ")))
}
