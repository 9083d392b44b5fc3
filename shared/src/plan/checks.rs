//! The rules, member by member. Every rule adds its finding and goes on.

use alloc::string::ToString;
use alloc::vec::Vec;

use crate::config::{
    CONTROLLER_HOPS, CipAppCfg, CipControlCfg, CipTargetCfg, Extra, Host, MSG_CIPGENERIC, MsgCipGeneric,
    Profile, Target, TargetPath, read_hex,
};
use crate::table::Access;
use crate::tag::DataFields;
use crate::wire::{Epath, MessageRouterRequest, ServiceCode};

use super::finding::{Field, Finding, Severity};
use super::limits::{
    CONN_MSG_TIMEOUT, KEEP_ALIVE, MAX_NAME, MAX_REQUEST_DATA, MAX_RESPONSE_DATA, TimeoutRange, UCMM_TIMEOUT,
    USUAL_MESSAGE,
};
use super::routed::ends_at_own_slot;
use super::rule::Rule;
use super::{App, ConnectionPlan, TargetPlan, TriggerType};

#[derive(Default)]
pub(super) struct Checks {
    pub(super) findings: Vec<Finding>,
}

impl Checks {
    pub(super) fn block(&mut self, config: &MsgCipGeneric) {
        self.name(&config.name);
        if config.kind != MSG_CIPGENERIC {
            self.error(Field::Kind, Rule::UnknownKind);
        }
        self.unknown("", &config.extra);
    }

    pub(super) fn name(&mut self, name: &str) {
        if name.trim().is_empty() {
            self.error(Field::Name, Rule::Missing);
        }
        if name.chars().count() > MAX_NAME {
            self.error(Field::Name, Rule::TextTooLong { max: MAX_NAME });
        }
    }

    pub(super) fn ctrl_cfg(&mut self, cfg: &CipControlCfg) -> Option<TriggerType> {
        if cfg.cancel {
            self.warning(Field::Cancel, Rule::CancelIsAnInput);
        }
        if cfg.str_mode != 0 {
            self.number::<u8>(Field::StrMode, cfg.str_mode, 0, 255);
            self.note(Field::StrMode, Rule::Reserved);
        }
        self.unknown("CtrlCfg.", &cfg.extra);
        let period = self.number::<u16>(Field::TriggerType, cfg.trigger_type, 0, 65_535)?;
        if period > 255 {
            self.note(Field::TriggerType, Rule::OverUsint);
        }
        Some(TriggerType::of(period))
    }

    pub(super) fn app_cfg(&mut self, cfg: &CipAppCfg) -> Option<App> {
        let service = self.number::<u8>(Field::Service, cfg.service, 1, 127);
        let class = self.number::<u16>(Field::Class, cfg.class, 1, 65_535);
        let instance = self.number::<u32>(Field::Instance, cfg.instance, 0, u32::MAX.into());
        let attribute = self.number::<u16>(Field::Attribute, cfg.attribute, 0, 65_535);
        let members = self.members(cfg);
        self.unknown("AppCfg.", &cfg.extra);
        Some(App {
            service: ServiceCode(service?),
            class: class?,
            instance: instance?,
            attribute: attribute?,
            members: members?,
        })
    }

    fn members(&mut self, cfg: &CipAppCfg) -> Option<Vec<u16>> {
        let ids: Vec<Option<u16>> = cfg
            .member_id
            .iter()
            .take(3)
            .enumerate()
            .map(|(index, id)| self.number(Field::MemberId(index), *id, 0, 65_535))
            .collect();
        let three = cfg.member_id.len() == 3;
        if !three {
            self.error(Field::MemberIds, Rule::MemberIdCount { found: cfg.member_id.len() });
        }
        let count = self.number::<u8>(Field::MemberCnt, cfg.member_cnt, 0, 3)?;
        let mut ids = ids.into_iter().collect::<Option<Vec<u16>>>().filter(|_| three)?;
        ids.truncate(count.into());
        Some(ids)
    }

    pub(super) fn target_cfg(&mut self, cfg: &CipTargetCfg, profile: Profile) -> Option<TargetPlan> {
        let path = self.path(&cfg.path, profile);
        let mode = self.number::<u8>(Field::CipConnMode, cfg.cip_conn_mode, 0, 1);
        if mode == Some(0) && cfg.conn_close {
            self.note(Field::ConnClose, Rule::ConnCloseUnconnected);
        }
        let ucmm = self.timeout(Field::UcmmTimeout, cfg.ucmm_timeout, UCMM_TIMEOUT);
        let connected = self.timeout(Field::ConnMsgTimeout, cfg.conn_msg_timeout, CONN_MSG_TIMEOUT);
        self.unknown("TargetCfg.", &cfg.extra);
        let connection = ConnectionPlan { timeout_ms: connected?, close: cfg.conn_close };
        Some(TargetPlan {
            path: path?,
            ucmm_timeout_ms: ucmm?,
            connection: (mode? == 1).then_some(connection),
        })
    }

    pub(super) fn keep_alive(&mut self, ms: i64) -> Option<u32> {
        self.timeout(Field::KeepAlive, ms, KEEP_ALIVE)
    }

    fn path(&mut self, text: &str, profile: Profile) -> Option<TargetPath> {
        let path: TargetPath = match text.parse() {
            Ok(path) => path,
            Err(error) => {
                self.error(Field::Path, Rule::Path(error));
                return None;
            }
        };
        if let Target::Network(endpoint) = &path.target {
            if endpoint.has_unusual_port() {
                self.warning(Field::Path, Rule::TcpPort { port: endpoint.port });
            }
            if matches!(endpoint.host, Host::Name(_)) {
                self.warning(Field::Path, Rule::HostName);
            }
        }
        if path.hops() > CONTROLLER_HOPS {
            self.warning(Field::Path, Rule::ThreeHops);
        }
        if profile == Profile::Micro800 && ends_at_own_slot(&path.route) {
            self.note(Field::Path, Rule::OwnSlot);
        }
        Some(path)
    }

    fn timeout(&mut self, field: Field, value: i64, range: TimeoutRange) -> Option<u32> {
        // A negative number cannot be meant: a UDINT cannot hold it.
        let given = self.number::<u32>(field.clone(), value, 0, u32::MAX.into())?;
        if given == 0 {
            return Some(range.default);
        }
        let used = given.clamp(range.min, range.max);
        if used != given {
            self.note(field, Rule::Clamped { value, used });
        }
        Some(used)
    }

    pub(super) fn request_data(&mut self, config: &MsgCipGeneric) -> Option<Vec<u8>> {
        let data = match read_hex(&config.req_data) {
            Ok(data) => Some(data),
            Err(error) => {
                self.error(Field::ReqData, Rule::Hex { position: error.position, kind: error.kind });
                None
            }
        };
        let length = config.req_length.map(|length| self.number::<u16>(Field::ReqLength, length, 0, 490));
        let mut data = data?;
        if data.len() > MAX_REQUEST_DATA {
            self.error(Field::ReqData, Rule::TooMuchData { length: data.len(), max: MAX_REQUEST_DATA });
            return None;
        }
        let Some(sent) = length else { return Some(data) };
        let sent = usize::from(sent?);
        if sent > data.len() {
            self.error(Field::ReqLength, Rule::LengthOverData { length: data.len() });
            return None;
        }
        if sent < data.len() {
            self.note(Field::ReqLength, Rule::LengthUnderData { sent, length: data.len() });
            data.truncate(sent);
        }
        Some(data)
    }

    pub(super) fn res_data_size(&mut self, config: &MsgCipGeneric) -> Option<u16> {
        self.number(Field::ResDataSize, config.res_data_size, 1, MAX_RESPONSE_DATA)
    }

    pub(super) fn layouts(&mut self, config: &MsgCipGeneric) {
        self.layout(Field::ResLayout, &config.res_layout);
        let size = self.layout(Field::ReqLayout, &config.req_layout).and_then(|fields| fields.size());
        // What is wrong with the data itself is said elsewhere.
        if let (Some(layout), Ok(data)) = (size, read_hex(&config.req_data))
            && layout != data.len()
        {
            let length = data.len();
            self.warning(Field::ReqLayout, Rule::LayoutLength { layout, length });
        }
    }

    pub(super) fn layout(&mut self, field: Field, text: &str) -> Option<DataFields> {
        if text.trim().is_empty() {
            return None;
        }
        DataFields::read(text).map_err(|error| self.error(field, Rule::Layout(error))).ok()
    }

    pub(super) fn resume(&mut self, resume: bool, access: Option<Access>) {
        if resume && access.is_some_and(|access| access != Access::Read) {
            self.error(Field::Resume, Rule::ResumeNeedsRead);
        }
    }

    pub(super) fn request(
        &mut self,
        service: ServiceCode,
        path: Epath,
        data: Vec<u8>,
    ) -> Option<MessageRouterRequest> {
        match MessageRouterRequest::new(service, path, data) {
            Ok(request) => {
                let length = request.bytes().len();
                if length > USUAL_MESSAGE {
                    self.warning(Field::ReqData, Rule::LongMessage { length, max: USUAL_MESSAGE });
                }
                Some(request)
            }
            Err(error) => {
                self.error(Field::ReqData, Rule::TooMuchData { length: error.length, max: error.max });
                None
            }
        }
    }

    pub(super) fn number<T: TryFrom<i64>>(
        &mut self,
        field: Field,
        value: i64,
        min: i64,
        max: i64,
    ) -> Option<T> {
        let number = (min..=max).contains(&value).then_some(value).and_then(|value| T::try_from(value).ok());
        if number.is_none() {
            self.error(field, Rule::OutOfRange { value, min, max });
        }
        number
    }

    pub(super) fn unknown(&mut self, prefix: &str, extra: &Extra) {
        for name in extra.keys() {
            self.warning(Field::Unknown(prefix.to_string() + name), Rule::UnknownMember);
        }
    }

    pub(super) fn error(&mut self, field: Field, rule: Rule) {
        self.findings.push(Finding { field, severity: Severity::Error, rule });
    }

    pub(super) fn warning(&mut self, field: Field, rule: Rule) {
        self.findings.push(Finding { field, severity: Severity::Warning, rule });
    }

    pub(super) fn note(&mut self, field: Field, rule: Rule) {
        self.findings.push(Finding { field, severity: Severity::Note, rule });
    }
}
