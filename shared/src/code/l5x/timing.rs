//! What the logic says about a `MESSAGE`: its timeouts, and when it is sent.

use alloc::format;

use super::super::remark::RemarkKind;
use super::parameters::Parameters;
use super::{DEFAULT_CONNECTED_MS, DEFAULT_UNCONNECTED_MS};
use crate::config::{MsgCipGeneric, read_number};
use crate::plan::Severity;
use crate::plan::limits::{CONN_MSG_TIMEOUT, UCMM_TIMEOUT};

/// `.TimeoutMultiplier` counts the powers of two from 4 on; CIP has eight of them.
const MAX_MULTIPLIER: i64 = 7;

/// The members that say how long, in µs.
#[derive(Default)]
struct Members {
    unconnected: Option<i64>,
    rate: Option<i64>,
    multiplier: Option<i64>,
}

impl Parameters<'_, '_, '_> {
    pub(super) fn timeouts(&mut self, config: &mut MsgCipGeneric) {
        let members = self.moved();
        let name = self.name.clone();
        let target = &mut config.target_cfg;
        target.ucmm_timeout = members.unconnected.map_or(DEFAULT_UNCONNECTED_MS, whole_ms);
        if target.cip_conn_mode == 1 || members.rate.is_some() {
            let multiplier = members.multiplier.unwrap_or(0).clamp(0, MAX_MULTIPLIER);
            let connected = |rate: i64| whole_ms(rate.saturating_mul(4 << multiplier));
            target.conn_msg_timeout = members.rate.map_or(DEFAULT_CONNECTED_MS, connected);
        }
        let longest = i64::from(UCMM_TIMEOUT.max);
        if members.unconnected.is_none() {
            let words = format!(
                "no rung sets {name}.UnconnectedTimeout: it is 30 s in the controller; MSG_CIPGENERIC waits {longest} ms \
                 at most"
            );
            self.told(Severity::Note, &words);
        }
        let too_long = [
            ("UnconnectedTimeout", members.unconnected.is_some(), target.ucmm_timeout, longest),
            ("ConnectionRate", members.rate.is_some(), target.conn_msg_timeout, CONN_MSG_TIMEOUT.max.into()),
        ];
        for (member, _, ms, longest) in too_long.into_iter().filter(|it| it.1 && it.2 > it.3) {
            let words =
                format!("{name}.{member} makes it {ms} ms: MSG_CIPGENERIC waits {longest} ms at most");
            self.told(Severity::Warning, &words);
        }
    }

    /// What constants the logic moves into the members of the message.
    fn moved(&mut self) -> Members {
        let (project, name) = (self.project, self.name.clone());
        let mut members = Members::default();
        for rung in project.rungs_about(self.tag) {
            for (member, value) in rung.moves_to(&name) {
                let (place, high) = match member.to_ascii_uppercase().as_str() {
                    "UNCONNECTEDTIMEOUT" => (&mut members.unconnected, i64::MAX),
                    "CONNECTIONRATE" => (&mut members.rate, i64::MAX),
                    "TIMEOUTMULTIPLIER" => (&mut members.multiplier, MAX_MULTIPLIER),
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
                if value > high {
                    let what = RemarkKind::OutOfRange { member: format!("{name}.{member}"), low: 0, high };
                    self.remark_at(rung.at, Severity::Warning, what);
                }
                if place.replace(value).is_some_and(|before| before != value) {
                    let what = RemarkKind::Twice(format!("{name}.{member}"));
                    self.remark_at(rung.at, Severity::Warning, what);
                }
            }
        }
        members
    }

    /// The rung that sends: once, as fast as possible, or by a timer that it starts again and again.
    pub(super) fn trigger(&mut self) -> i64 {
        let project = self.project;
        let Some(rung) = project.rungs_about(self.tag).find(|rung| rung.sends(&self.name)) else {
            let given = project.rungs_about(self.tag).find_map(|rung| rung.gives(&self.name));
            let words = match given {
                Some(to) => format!("{} is given to {to}: what that does with it is not read", self.name),
                None => format!("no rung sends {}", self.name),
            };
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
        let timer = done.find_map(|timer| project.tag(&self.scope, timer));
        let preset = timer.filter(|timer| timer.attribute("DataType") == Some("TIMER")).and_then(|timer| {
            let mut members = timer.descendants().filter(|node| node.has_tag_name("DataValueMember"));
            members.find(|member| member.attribute("Name") == Some("PRE"))?.attribute("Value")
        });
        let Some(preset) = preset.and_then(|preset| read_number(preset).ok()) else { return 0 };
        self.used.extend(timer.map(|timer| timer.id()));
        preset
    }
}

/// µs, rounded up.
const fn whole_ms(micros: i64) -> i64 {
    micros / 1_000 + (micros % 1_000 != 0) as i64
}
