//! Where a `ConnectionPath` goes, also by way of the modules of the project.

use alloc::format;
use alloc::string::{String, ToString};

use roxmltree::Node;

use super::super::remark::RemarkKind;
use super::parameters::Parameters;
use super::path::{Meant, is_path, meant};
use super::project::Project;
use crate::plan::Severity;

/// Modules behind modules. A project has a handful; one that is its own parent has no end.
const MAX_DEPTH: usize = 16;

impl Parameters<'_, '_, '_> {
    /// As `TargetCfg.Path`.
    pub(super) fn path(&mut self) -> String {
        let Some(text) = self.attribute("ConnectionPath") else {
            self.say(Severity::Error, RemarkKind::Missing("ConnectionPath".into()));
            return String::new();
        };
        let (severity, words, path) = match meant(text) {
            Meant::Path(path) => return path,
            Meant::This => (
                Severity::Note,
                "THIS is the controller itself: 0,0, the built-in simulated device".to_string(),
                "0,0".to_string(),
            ),
            Meant::Behind(front, path) => (Severity::Warning, behind(&front), path),
            Meant::Named { name, rest, path } => match (self.project.route(name, &rest), path) {
                (Some(path), _) => {
                    let words = format!("{name} is a module of this project: its Ethernet address is taken");
                    (Severity::Warning, words, path)
                }
                (None, Some(path)) => (Severity::Warning, behind(name), path),
                (None, None) => {
                    let words =
                        format!("{name} is a module whose address is not in this file: write where it goes");
                    (Severity::Error, words, String::new())
                }
            },
            Meant::Elsewhere => {
                let words = format!("the path {text:?} does not lead over Ethernet: write where it goes");
                (Severity::Error, words, String::new())
            }
        };
        self.told(severity, &words);
        path
    }
}

fn behind(front: &str) -> String {
    format!("the way through the controller's own chassis ({front}) is not needed from here")
}

impl Project<'_, '_> {
    /// The way to a module over Ethernet, and on from there.
    fn route(&self, name: &str, rest: &str) -> Option<String> {
        let way = self.way(self.module(name)?, 0)?;
        let path = format!("4,{way}{rest}");
        is_path(&path).then_some(path)
    }

    /// To a module: by the port that leads to the controller, through the modules before it. `None`: it is in the
    /// controller's own chassis.
    fn way(&self, module: Node<'_, '_>, depth: usize) -> Option<String> {
        let ports = || module.descendants().filter(|node| node.has_tag_name("Port"));
        let is_ethernet = |port: &Node<'_, '_>| port.attribute("Type") == Some("Ethernet");
        let upstream = ports().find(|port| port.attribute("Upstream") == Some("true"));
        let port = upstream.or_else(|| ports().find(is_ethernet))?;
        let address = port.attribute("Address").filter(|address| !address.is_empty())?;
        let parent = module.attribute("ParentModule").and_then(|parent| self.module(parent));
        let parent = parent.filter(|parent| *parent != module && depth < MAX_DEPTH);
        match parent.and_then(|parent| self.way(parent, depth + 1)) {
            Some(before) => {
                let out = module.attribute("ParentModPortId")?;
                Some(format!("{before},{out},{address}"))
            }
            None => is_ethernet(&port).then(|| address.to_string()),
        }
    }
}
