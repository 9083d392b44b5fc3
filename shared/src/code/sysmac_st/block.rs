//! One call as a block.

use alloc::collections::BTreeMap;
use alloc::format;
use alloc::string::{String, ToString};

use super::instruction::{Instruction, Site};
use super::route;
use crate::code::change::{Change, Grade, Why};
use crate::code::remark::RemarkKind;
use crate::code::text::{Declared, Expression, Literal, Reading, Script};
use crate::config::MsgCipGeneric;
use crate::plan::Severity;
use crate::plan::limits::{CONN_MSG_TIMEOUT, TimeoutRange, UCMM_TIMEOUT};

/// Tenths of a second, where `TimeOut` is not given.
const USUAL_TIMEOUT: i64 = 20;

/// The types of all variables, by their names in lower case.
pub(super) type Types<'s, 'a> = BTreeMap<String, &'s Declared<'a>>;

/// A message being read.
pub(super) struct Block<'b, 's, 'a> {
    pub(super) site: &'b Site<'s, 'a>,
    pub(super) types: &'b Types<'s, 'a>,
    pub(super) reading: Reading<'b, 's, 'a>,
}

impl<'b, 's, 'a> Block<'b, 's, 'a> {
    pub(super) fn config(
        &mut self,
        sites: &'b [Site<'s, 'a>],
        script: &'s Script<'a>,
        number: usize,
    ) -> MsgCipGeneric {
        self.arguments(self.site);
        let mut config = MsgCipGeneric::product_name("");
        let root = self.site.call.name.root;
        // A call by the name of the instruction itself has no name of its own.
        let is_nameless = Instruction::of_type(root).is_some();
        config.name = if is_nameless { format!("message-{number}") } else { root.to_string() };
        let service = self.integer("ServiceCode", 255);
        config.app_cfg.service = self.needed("ServiceCode", service);
        if self.site.instruction == Instruction::Send {
            self.connected(sites, script, &mut config);
        } else {
            self.route(self.site, &mut config);
            let ms = self.timeout(self.site);
            config.target_cfg.ucmm_timeout = self.moved("TargetCfg.UcmmTimeout", ms, UCMM_TIMEOUT);
        }
        self.data(&mut config);
        self.reply(&mut config);
        let widths = self.path(&mut config);
        self.compare(&config, widths);
        config
    }

    /// A whole number that is given to the call.
    pub(super) fn integer(&mut self, name: &str, high: i64) -> Option<i64> {
        self.reading.integer_of(self.site.call, self.site.position(name), name, 0, high)
    }

    pub(super) fn needed(&mut self, name: &str, value: Option<i64>) -> i64 {
        if value.is_none() && !self.site.gives(name) {
            self.reading.say(Severity::Error, RemarkKind::Missing(name.into()));
        }
        value.unwrap_or_default()
    }

    /// Inputs that the instruction does not have, and those that stand at their place alone.
    fn arguments(&mut self, site: &Site<'_, '_>) {
        let mut by_place = false;
        for argument in &site.call.arguments {
            match argument.name {
                Some(name) if site.instruction.has(name) => {}
                Some(name) => self.reading.say(Severity::Error, RemarkKind::UnknownMember(name.into())),
                None => by_place = true,
            }
        }
        if by_place {
            let words = format!(
                "arguments without names are read in this order: {}",
                site.instruction.inputs().join(", ")
            );
            self.reading.say(Severity::Note, RemarkKind::Told(words));
        }
    }

    /// `CIPSend` goes where the `CIPOpen` with the same handle has opened a connection to, and waits as long as that.
    fn connected(&mut self, sites: &'b [Site<'s, 'a>], script: &'s Script<'a>, config: &mut MsgCipGeneric) {
        config.target_cfg.cip_conn_mode = 1;
        let handle = self.site.key("Handle");
        let same = |other: &&Site<'s, 'a>| {
            // `Handle := open.Handle` names the instance.
            let of_instance = other.call.name.key().map(|name| format!("{name}.handle"));
            handle.is_some() && (other.key("Handle") == handle || of_instance == handle)
        };
        let of = |instruction: Instruction| {
            let mut those = sites.iter().filter(move |it| it.instruction == instruction && !it.only_resets());
            those.find(same)
        };
        config.target_cfg.conn_close = of(Instruction::Close).is_some();
        let Some(open) = of(Instruction::Open) else {
            self.reading.say(Severity::Error, RemarkKind::Missing("the CIPOpen of this handle".into()));
            return;
        };
        if let Some(item) = script.items.get(open.item) {
            self.reading.begins(item);
        }
        self.arguments(open);
        if open.gives("DataSize") {
            self.reading.say(Severity::Note, RemarkKind::NoEffect("DataSize".into()));
        }
        self.route(open, config);
        let ms = self.timeout(open);
        config.target_cfg.ucmm_timeout = self.moved("TargetCfg.UcmmTimeout", ms, UCMM_TIMEOUT);
        config.target_cfg.conn_msg_timeout = self.moved("TargetCfg.ConnMsgTimeout", ms, CONN_MSG_TIMEOUT);
    }

    fn route(&mut self, site: &Site<'s, 'a>, config: &mut MsgCipGeneric) {
        let text = match site.value("RoutePath") {
            Some(Expression::Literal(Literal::Text(text), _)) => Some(text.as_str()),
            Some(Expression::Reference(reference)) => {
                reference.key().and_then(|key| self.reading.text_or_told(&key, "RoutePath"))
            }
            Some(_) => {
                self.reading.say(Severity::Error, RemarkKind::NotConstant("RoutePath".into()));
                None
            }
            None => {
                self.reading.say(Severity::Error, RemarkKind::Missing("RoutePath".into()));
                None
            }
        };
        let Some(text) = text else { return };
        if let Some(path) = route::read(text) {
            config.target_cfg.path = path;
        } else {
            let words = format!("a route path such as 02\\192.168.250.2\\01\\#00 instead of {text}");
            self.reading.say(Severity::Error, RemarkKind::Expected(words));
        }
    }

    /// ms.
    fn timeout(&mut self, site: &Site<'s, 'a>) -> i64 {
        let given = site.gives("TimeOut");
        let steps = self.reading.integer_of(site.call, site.position("TimeOut"), "TimeOut", 0, 65_535);
        let steps = steps.filter(|steps| *steps != 0).unwrap_or_else(|| {
            let words = format!(
                "TimeOut is {}: {USUAL_TIMEOUT} tenths of a second are taken",
                if given { "0 or not known" } else { "not given" }
            );
            self.reading.say(Severity::Warning, RemarkKind::Told(words));
            USUAL_TIMEOUT
        });
        steps.saturating_mul(100)
    }

    /// Into what a block can wait, which is told.
    fn moved(&mut self, member: &str, ms: i64, range: TimeoutRange) -> i64 {
        let moved = ms.clamp(range.min.into(), range.max.into());
        if moved != ms {
            let why = Why::TimeoutBounds(range.min, range.max);
            let change =
                Change::new(&member, &format!("{ms} ms"), &format!("{moved} ms"), Grade::Adjusted, why);
            self.reading.say(Severity::Warning, RemarkKind::Change(change));
        }
        moved
    }
}
