//! A document by its names: tags, modules and logic.

use alloc::borrow::ToOwned;
use alloc::collections::BTreeMap;
use alloc::string::String;
use alloc::vec::Vec;

use roxmltree::{Document, Node};

use super::super::document::Lines;
use super::super::remark::{Remark, RemarkKind};
use super::logic::{self, Rung};

/// Where a name is known.
#[derive(Clone, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub(super) enum Scope {
    /// Everywhere.
    Controller,
    /// In one program.
    Program(String),
    /// Inside of an Add-On Instruction, where all names are its own.
    Instruction,
}

/// A document, its logic and its names.
pub(super) struct Project<'a, 'i> {
    pub(super) document: &'a Document<'i>,
    pub(super) rungs: Vec<Rung>,
    text: &'a str,
    lines: Lines<'a>,
    tags: BTreeMap<(Scope, String), Node<'a, 'i>>,
    modules: BTreeMap<String, Node<'a, 'i>>,
}

impl<'a, 'i> Project<'a, 'i> {
    pub(super) fn new(document: &'a Document<'i>, text: &'a str) -> Self {
        let (mut tags, mut modules) = (BTreeMap::new(), BTreeMap::new());
        for node in document.descendants() {
            let Some(name) = node.attribute("Name").map(str::to_ascii_lowercase) else { continue };
            if node.has_tag_name("Tag") {
                tags.entry((scope(node), name)).or_insert(node);
            } else if node.has_tag_name("Module") {
                modules.entry(name).or_insert(node);
            }
        }
        Self { rungs: logic::rungs(document), document, text, lines: Lines::new(text), tags, modules }
    }

    pub(super) fn tags(&self) -> impl Iterator<Item = Node<'a, 'i>> + use<'a, 'i> {
        self.document.descendants().filter(|node| node.has_tag_name("Tag"))
    }

    /// A tag by its name: of the same program, otherwise of the controller. Logix ignores case.
    pub(super) fn tag(&self, scope: &Scope, name: &str) -> Option<Node<'a, 'i>> {
        let name = name.to_ascii_lowercase();
        let near = self.tags.get(&(scope.clone(), name.clone()));
        near.or_else(|| self.tags.get(&(Scope::Controller, name))).copied()
    }

    /// The logic in which the name of a tag is that tag.
    pub(super) fn rungs_about(&self, tag: Node<'a, 'i>) -> impl Iterator<Item = &Rung> {
        let name = tag.attribute("Name").map(str::to_ascii_lowercase).unwrap_or_default();
        let home = scope(tag);
        self.rungs.iter().filter(move |rung| {
            rung.scope == home
                || home == Scope::Controller
                    && matches!(rung.scope, Scope::Program(_))
                    && !self.tags.contains_key(&(rung.scope.clone(), name.clone()))
        })
    }

    /// A module of the project.
    pub(super) fn module(&self, name: &str) -> Option<Node<'a, 'i>> {
        self.modules.get(&name.to_ascii_lowercase()).copied()
    }

    /// An error at a node.
    pub(super) fn error(&self, node: Node<'_, '_>, what: RemarkKind) -> Remark {
        let (line, column) = self.place(node.range().start);
        let excerpt = self.text.get(node.range()).unwrap_or_default();
        Remark::error(line, column, excerpt, what)
    }

    /// Line and column of a byte, both from 1.
    pub(super) fn place(&self, at: usize) -> (usize, usize) {
        self.lines.place(at)
    }
}

/// Where the names at a node are known.
pub(super) fn scope(node: Node<'_, '_>) -> Scope {
    let named =
        |node: Node<'_, '_>| node.attribute("Name").unwrap_or_default().to_owned().to_ascii_lowercase();
    node.ancestors()
        .find_map(|node| match node.tag_name().name() {
            "Program" => Some(Scope::Program(named(node))),
            "AddOnInstructionDefinition" => Some(Scope::Instruction),
            _ => None,
        })
        .unwrap_or(Scope::Controller)
}
