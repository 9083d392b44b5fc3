//! One result of validation: where, how bad, and which rule.

use alloc::string::String;
use core::fmt;

use serde::{Deserialize, Serialize};

use crate::config::PathError;

use super::rule::Rule;

/// One result of validation.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Finding {
    /// Which member it is about.
    pub field: Field,
    /// Whether it stops the block.
    pub severity: Severity,
    /// What is wrong.
    pub rule: Rule,
}

/// How bad a finding is. Only errors stop a block.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Serialize, Deserialize)]
#[cfg_attr(feature = "openapi", derive(utoipa::ToSchema))]
#[serde(rename_all = "lowercase")]
pub enum Severity {
    /// Nothing is stored and nothing is sent.
    Error,
    /// Works here, but probably not as meant.
    Warning,
    /// Good to know.
    Note,
}

/// A member of the configuration.
#[derive(Clone, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub enum Field {
    /// `name`
    Name,
    /// `kind`
    Kind,
    /// `Resume`
    Resume,
    /// `KeepAlive`
    KeepAlive,
    /// `CtrlCfg.Cancel`
    Cancel,
    /// `CtrlCfg.TriggerType`
    TriggerType,
    /// `CtrlCfg.StrMode`
    StrMode,
    /// `AppCfg.Service`
    Service,
    /// `AppCfg.Class`
    Class,
    /// `AppCfg.Instance`
    Instance,
    /// `AppCfg.Attribute`
    Attribute,
    /// `AppCfg.MemberCnt`
    MemberCnt,
    /// `AppCfg.MemberId`, the whole array
    MemberIds,
    /// `AppCfg.MemberId[n]`
    MemberId(usize),
    /// `TargetCfg.Path`
    Path,
    /// `TargetCfg.CipConnMode`
    CipConnMode,
    /// `TargetCfg.UcmmTimeout`
    UcmmTimeout,
    /// `TargetCfg.ConnMsgTimeout`
    ConnMsgTimeout,
    /// `TargetCfg.ConnClose`
    ConnClose,
    /// `ReqData`
    ReqData,
    /// `ReqLength`
    ReqLength,
    /// `ResDataSize`
    ResDataSize,
    /// `ReqLayout`
    ReqLayout,
    /// `ResLayout`
    ResLayout,
    /// `Dialect` of a SEND_REQ
    Dialect,
    /// `Period`
    Period,
    /// `Address`
    Address,
    /// `Request_Code`
    RequestCode,
    /// `Type` of a DATA_EXCH
    ExchangeType,
    /// `Data_to_Send`
    DataToSend,
    /// `Management_Param`, the whole table
    ManagementParams,
    /// `Management_Param[n]`
    ManagementParam(usize),
    /// `Received_Data_Size`
    ReceivedDataSize,
    /// A member that this version does not know.
    Unknown(String),
}

impl fmt::Display for Field {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(match self {
            Self::Name => "name",
            Self::Kind => "kind",
            Self::Resume => "Resume",
            Self::KeepAlive => "KeepAlive",
            Self::Cancel => "CtrlCfg.Cancel",
            Self::TriggerType => "CtrlCfg.TriggerType",
            Self::StrMode => "CtrlCfg.StrMode",
            Self::Service => "AppCfg.Service",
            Self::Class => "AppCfg.Class",
            Self::Instance => "AppCfg.Instance",
            Self::Attribute => "AppCfg.Attribute",
            Self::MemberCnt => "AppCfg.MemberCnt",
            Self::MemberIds => "AppCfg.MemberId",
            Self::MemberId(index) => return write!(f, "AppCfg.MemberId[{index}]"),
            Self::Path => "TargetCfg.Path",
            Self::CipConnMode => "TargetCfg.CipConnMode",
            Self::UcmmTimeout => "TargetCfg.UcmmTimeout",
            Self::ConnMsgTimeout => "TargetCfg.ConnMsgTimeout",
            Self::ConnClose => "TargetCfg.ConnClose",
            Self::ReqData => "ReqData",
            Self::ReqLength => "ReqLength",
            Self::ResDataSize => "ResDataSize",
            Self::ReqLayout => "ReqLayout",
            Self::ResLayout => "ResLayout",
            Self::Dialect => "Dialect",
            Self::Period => "Period",
            Self::Address => "Address",
            Self::RequestCode => "Request_Code",
            Self::ExchangeType => "Type",
            Self::DataToSend => "Data_to_Send",
            Self::ManagementParams => "Management_Param",
            Self::ManagementParam(index) => return write!(f, "Management_Param[{index}]"),
            Self::ReceivedDataSize => "Received_Data_Size",
            Self::Unknown(name) => name,
        })
    }
}

impl Finding {
    /// The `ErrorID` and `SubErrorID` that the controller would give. Confirmed sub-codes of 33 only
    /// (2080-RM001D p. 179); 33 alone where the manual has none.
    pub const fn error_ids(&self) -> Option<(u16, Option<u16>)> {
        if !matches!(self.severity, Severity::Error) {
            return None;
        }
        let sub = match (&self.field, &self.rule) {
            (Field::Path, Rule::Path(PathError::SerialPort | PathError::BadPort)) => 32,
            (Field::CipConnMode, _) => 36,
            (Field::Class | Field::MemberCnt, _) => 43,
            (_, Rule::LengthOverData { .. }) | (Field::ResDataSize, _) => 48,
            (Field::Path, _) => 49,
            (Field::Service, _) => 50,
            (Field::ReqData | Field::ReqLength, Rule::TooMuchData { .. } | Rule::OutOfRange { .. }) => 51,
            (
                Field::Name
                | Field::Kind
                | Field::Resume
                | Field::KeepAlive
                | Field::ReqLayout
                | Field::ResLayout
                | Field::Dialect
                | Field::Period
                | Field::Address
                | Field::RequestCode
                | Field::ExchangeType
                | Field::DataToSend
                | Field::ManagementParams
                | Field::ManagementParam(_)
                | Field::ReceivedDataSize
                | Field::Unknown(_),
                _,
            ) => return None,
            _ => return Some((33, None)),
        };
        Some((33, Some(sub)))
    }

    /// The communication report that a SEND_REQ or DATA_EXCH would give, as far as that is known. Control Expert help
    /// D-NA-0014195; which check gives which code is inferred.
    pub const fn communication_report(&self) -> Option<u8> {
        if !matches!(self.severity, Severity::Error) {
            return None;
        }
        match (&self.field, &self.rule) {
            (_, Rule::Words(said)) => said.report,
            (Field::Address, _) => Some(0x03),
            (Field::ManagementParam(3), _) | (Field::DataToSend, Rule::TooMuchData { .. }) => Some(0x0E),
            (Field::ManagementParam(_) | Field::ManagementParams, _) => Some(0x05),
            (Field::DataToSend, _) => Some(0x06),
            _ => None,
        }
    }
}
