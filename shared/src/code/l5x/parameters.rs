//! One `MESSAGE` as a block.

use alloc::format;
use alloc::string::{String, ToString};
use alloc::vec::Vec;

use roxmltree::{Node, NodeId};

use super::super::remark::{Remark, RemarkKind};
use super::data;
use super::path::{Meant, meant};
use super::read::Project;
use super::{DEFAULT_CONNECTED_MS, DEFAULT_UNCONNECTED_MS};
use crate::config::{MsgCipGeneric, read_number, write_hex};
use crate::plan::Severity;
use crate::plan::limits::MAX_RESPONSE_DATA;

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
    project: &'p Project<'a, 'i>,
    tag: Node<'a, 'i>,
    node: Node<'a, 'i>,
    name: String,
    pub(super) remarks: Vec<Remark>,
    /// The tags that belong to it.
    pub(super) used: Vec<NodeId>,
}

impl<'p, 'a, 'i> Parameters<'p, 'a, 'i> {
    pub(super) fn new(project: &'p Project<'a, 'i>, tag: Node<'a, 'i>, node: Node<'a, 'i>) -> Self {
        let name = tag.attribute("Name").unwrap_or_default().to_string();
        Self { project, tag, node, name, remarks: Vec::new(), used: Vec::new() }
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

    fn path(&mut self) -> String {
        let Some(text) = self.attribute("ConnectionPath") else {
            self.say(Severity::Error, RemarkKind::Missing("ConnectionPath".into()));
            return String::new();
        };
        match meant(text) {
            Meant::Path(path) => path,
            Meant::This => {
                self.told(
                    Severity::Note,
                    "THIS is the controller itself: 0,0, the built-in simulated device",
                );
                "0,0".to_string()
            }
            Meant::Behind(front, path) => {
                let words =
                    format!("the way through the controller's own chassis ({front}) is not needed from here");
                self.told(Severity::Warning, &words);
                path
            }
            Meant::Module(name) => self.module(&name),
            Meant::Elsewhere => {
                let words = format!("the path {text:?} does not lead over Ethernet: write where it goes");
                self.told(Severity::Error, &words);
                String::new()
            }
        }
    }

    /// The address of a module that the project knows.
    fn module(&mut self, name: &str) -> String {
        let module = self.project.module(name);
        let address = module.and_then(|module| {
            let mut ports = module.descendants().filter(|node| node.has_tag_name("Port"));
            let port = ports.find(|port| port.attribute("Type") == Some("Ethernet"))?;
            port.attribute("Address")
        });
        let path = address.and_then(|address| match meant(&format!("2,{address}")) {
            Meant::Path(path) => Some(path),
            _ => None,
        });
        let Some(path) = path else {
            let words = format!("{name} is a module whose address is not in this file: write where it goes");
            self.told(Severity::Error, &words);
            return String::new();
        };
        let words = format!("{name} is a module of this project: its Ethernet address is taken");
        self.told(Severity::Warning, &words);
        path
    }

    fn is_connected(&mut self) -> bool {
        match self.attribute("ConnectedFlag").unwrap_or("2") {
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

    fn timeouts(&mut self, config: &mut MsgCipGeneric) {
        let mut unconnected = None;
        let mut rate = None;
        let mut multiplier = None;
        let (project, name) = (self.project, self.name.clone());
        for rung in &project.rungs {
            for (member, value) in rung.moves_to(&name) {
                let place = match member.to_ascii_uppercase().as_str() {
                    "UNCONNECTEDTIMEOUT" => &mut unconnected,
                    "CONNECTIONRATE" => &mut rate,
                    "TIMEOUTMULTIPLIER" => &mut multiplier,
                    _ => {
                        let words = format!("the program changes {name}.{member} to {value}");
                        self.remark_at(rung.at, Severity::Warning, RemarkKind::Told(words));
                        continue;
                    }
                };
                let Some(value) = read_number(value).ok().filter(|value| *value >= 0) else {
                    let what = RemarkKind::NotConstant(format!("{name}.{member}"));
                    self.remark_at(rung.at, Severity::Warning, what);
                    continue;
                };
                if place.replace(value).is_some_and(|before| before != value) {
                    let what = RemarkKind::Twice(format!("{name}.{member}"));
                    self.remark_at(rung.at, Severity::Warning, what);
                }
            }
        }
        let target = &mut config.target_cfg;
        target.ucmm_timeout = unconnected.map_or(DEFAULT_UNCONNECTED_MS, whole_ms);
        if target.cip_conn_mode == 1 || rate.is_some() {
            let times = 4_i64.saturating_mul(1 << multiplier.unwrap_or(0).clamp(0, 2));
            target.conn_msg_timeout =
                rate.map_or(DEFAULT_CONNECTED_MS, |rate| whole_ms(rate.saturating_mul(times)));
        }
        if unconnected.is_none() {
            let words = format!("no rung sets {name}.UnconnectedTimeout: it is 30 s, as in the controller");
            self.told(Severity::Note, &words);
        }
    }

    fn request(&mut self, config: &mut MsgCipGeneric) {
        let length = self.number("RequestedLength", true);
        let Some(source) = self.attribute("LocalElement").filter(|_| length != 0) else {
            if length != 0 {
                self.say(Severity::Error, RemarkKind::Missing("LocalElement".into()));
                // Not sendable like this, and said so by its findings.
                config.req_length = Some(length);
            }
            return;
        };
        match self.source(source, length) {
            Ok(bytes) => config.req_data = write_hex(&bytes),
            Err(what) => {
                let words = format!("the data of LocalElement {source} is not known ({what}): write ReqData");
                self.told(Severity::Error, &words);
                config.req_length = Some(length);
            }
        }
    }

    /// So many bytes from an element on.
    fn source(&mut self, text: &str, length: i64) -> Result<Vec<u8>, String> {
        let (name, index) = data::element(text).ok_or("not an element of a tag")?;
        let tag = self.project.tag(self.tag, name).ok_or("no such tag in this file")?;
        self.used.push(tag.id());
        let size = data::element_size(tag.attribute("DataType").unwrap_or_default()).unwrap_or(1);
        let bytes = data::bytes(tag)?;
        let from = index.saturating_mul(size);
        let to = from.saturating_add(usize::try_from(length).map_err(|_| "a negative length")?);
        let found = bytes.len().saturating_sub(from);
        bytes.get(from..to).map(<[u8]>::to_vec).ok_or_else(|| format!("{found} bytes of {length}"))
    }

    fn res_data_size(&mut self) -> i64 {
        let Some(text) = self.attribute("DestinationTag").filter(|text| !text.is_empty()) else {
            return MAX_RESPONSE_DATA;
        };
        let size = data::element(text).and_then(|(name, index)| {
            let tag = self.project.tag(self.tag, name)?;
            self.used.push(tag.id());
            let element = data::element_size(tag.attribute("DataType")?)?;
            i64::try_from(data::size(tag)?.checked_sub(index.checked_mul(element)?)?).ok()
        });
        match size {
            Some(size @ 1..=MAX_RESPONSE_DATA) => size,
            Some(size) => {
                let words =
                    format!("DestinationTag {text} has {size} bytes: ResDataSize is {MAX_RESPONSE_DATA}");
                self.told(Severity::Note, &words);
                MAX_RESPONSE_DATA
            }
            None => {
                let words = format!(
                    "the size of DestinationTag {text} is not known: ResDataSize is {MAX_RESPONSE_DATA}"
                );
                self.told(Severity::Note, &words);
                MAX_RESPONSE_DATA
            }
        }
    }

    /// The rung that sends: once, as fast as possible, or by a timer that it starts again and again.
    fn trigger(&mut self) -> i64 {
        let project = self.project;
        let mut sending = project.rungs.iter().filter(|rung| rung.sends(&self.name));
        let Some(rung) = sending.next() else {
            let words = format!("no rung sends {}", self.name);
            self.told(Severity::Note, &words);
            return 0;
        };
        let again = format!("{}.EN", self.name);
        if rung.instructions.iter().any(|it| it.is("XIO", &again)) {
            return 1;
        }
        let mut done = rung.instructions.iter().filter(|it| it.name == "XIC").filter_map(|it| {
            let (timer, member) = it.operands.first()?.split_once('.')?;
            member.eq_ignore_ascii_case("DN").then_some(timer)
        });
        let timer = done.find_map(|timer| project.tag(self.tag, timer));
        let preset = timer.filter(|timer| timer.attribute("DataType") == Some("TIMER")).and_then(|timer| {
            let mut members = timer.descendants().filter(|node| node.has_tag_name("DataValueMember"));
            members.find(|member| member.attribute("Name") == Some("PRE"))?.attribute("Value")
        });
        let Some(preset) = preset.and_then(|preset| read_number(preset).ok()) else { return 0 };
        self.used.extend(timer.map(|timer| timer.id()));
        preset
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

    fn number(&mut self, name: &str, is_needed: bool) -> i64 {
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

    fn is_true(&self, name: &str) -> bool {
        self.attribute(name).is_some_and(|text| text.eq_ignore_ascii_case("true"))
    }

    fn attribute(&self, name: &str) -> Option<&'a str> {
        self.node.attribute(name)
    }

    fn told(&mut self, severity: Severity, words: &str) {
        self.say(severity, RemarkKind::Told(words.to_string()));
    }

    fn say(&mut self, severity: Severity, what: RemarkKind) {
        let remark = self.project.error(self.node, what);
        self.remarks.push(Remark { severity, ..remark });
    }

    fn remark_at(&mut self, at: usize, severity: Severity, what: RemarkKind) {
        let (line, column) = self.project.place(at);
        self.remarks.push(Remark { severity, ..Remark::error(line, column, "", what) });
    }
}

/// µs, rounded up.
const fn whole_ms(micros: i64) -> i64 {
    micros / 1_000 + (micros % 1_000 != 0) as i64
}
