//! One `MESSAGE` as a block.

use alloc::format;
use alloc::string::{String, ToString};
use alloc::vec::Vec;

use roxmltree::{Node, NodeId};

use super::super::remark::{Remark, RemarkKind};
use super::project::{Project, Scope, scope};
use crate::config::{MsgCipGeneric, read_number};
use crate::plan::Severity;

/// Attributes that are read, or that say nothing about a CIP Generic message.
const KNOWN: [&str; 15] = [
    "MessageType",
    "RemoteElement",
    "RequestedLength",
    "ConnectedFlag",
    "ConnectionPath",
    "CommTypeCode",
    "ServiceCode",
    "ObjectType",
    "TargetObject",
    "AttributeNumber",
    "LocalIndex",
    "LocalElement",
    "DestinationTag",
    "CacheConnections",
    "LargePacketUsage",
];

/// `MessageParameters` being read.
pub(super) struct Parameters<'p, 'a, 'i> {
    pub(super) project: &'p Project<'a, 'i>,
    pub(super) tag: Node<'a, 'i>,
    node: Node<'a, 'i>,
    pub(super) name: String,
    /// Where its names are known.
    pub(super) scope: Scope,
    pub(super) remarks: Vec<Remark>,
    /// The tags that belong to it.
    pub(super) used: Vec<NodeId>,
}

impl<'p, 'a, 'i> Parameters<'p, 'a, 'i> {
    pub(super) fn new(project: &'p Project<'a, 'i>, tag: Node<'a, 'i>, node: Node<'a, 'i>) -> Self {
        let name = tag.attribute("Name").unwrap_or_default().to_string();
        Self { project, tag, node, name, scope: scope(tag), remarks: Vec::new(), used: Vec::new() }
    }

    pub(super) fn config(&mut self) -> MsgCipGeneric {
        let path = self.path();
        let mut config = MsgCipGeneric::product_name(&path);
        config.name.clone_from(&self.name);
        config.app_cfg.service = self.number("ServiceCode", true);
        config.app_cfg.class = self.number("ObjectType", true);
        config.app_cfg.instance = self.number("TargetObject", true);
        config.app_cfg.attribute = self.number("AttributeNumber", false);
        let target = &mut config.target_cfg;
        target.cip_conn_mode = i64::from(self.is_connected());
        target.conn_close = target.cip_conn_mode == 1 && !self.is_true("CacheConnections");
        self.timeouts(&mut config);
        self.request(&mut config);
        config.res_data_size = self.res_data_size();
        config.ctrl_cfg.trigger_type = self.trigger();
        self.others();
        config
    }

    fn is_connected(&mut self) -> bool {
        let Some(flag) = self.attribute("ConnectedFlag") else {
            self.told(Severity::Warning, "ConnectedFlag is not given: taken as 2, unconnected");
            return false;
        };
        match flag {
            "1" => true,
            "2" => false,
            other => {
                let words =
                    format!("ConnectedFlag {other:?} is neither 1 (connected) nor 2: taken as unconnected");
                self.told(Severity::Warning, &words);
                false
            }
        }
    }

    fn others(&mut self) {
        for attribute in self.node.attributes() {
            if !KNOWN.contains(&attribute.name()) {
                self.say(Severity::Warning, RemarkKind::UnknownMember(attribute.name().to_string()));
            }
        }
        if self.is_true("LargePacketUsage") {
            self.told(
                Severity::Note,
                "LargePacketUsage: cipdeck takes large connections by the profile of the device",
            );
        }
        if self.attribute("CommTypeCode").is_some_and(|code| code != "0") {
            self.told(Severity::Warning, "CommTypeCode is not 0 (CIP): the way over DH+ is not known here");
        }
    }

    pub(super) fn number(&mut self, name: &str, is_needed: bool) -> i64 {
        let Some(text) = self.attribute(name) else {
            if is_needed {
                self.say(Severity::Error, RemarkKind::Missing(name.to_string()));
            }
            return 0;
        };
        read_number(text).unwrap_or_else(|error| {
            self.told(Severity::Error, &format!("{name} {text:?}: {error}"));
            0
        })
    }

    pub(super) fn is_true(&self, name: &str) -> bool {
        self.attribute(name).is_some_and(|text| text.eq_ignore_ascii_case("true"))
    }

    pub(super) fn attribute(&self, name: &str) -> Option<&'a str> {
        self.node.attribute(name)
    }

    pub(super) fn told(&mut self, severity: Severity, words: &str) {
        self.say(severity, RemarkKind::Told(words.to_string()));
    }

    pub(super) fn say(&mut self, severity: Severity, what: RemarkKind) {
        let remark = self.project.error(self.node, what);
        self.remarks.push(Remark { severity, ..remark });
    }

    pub(super) fn remark_at(&mut self, at: usize, severity: Severity, what: RemarkKind) {
        let (line, column) = self.project.place(at);
        self.remarks.push(Remark { severity, ..Remark::error(line, column, "", what) });
    }
}
