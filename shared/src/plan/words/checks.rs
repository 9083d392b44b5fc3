//! The rules, member by member. Every rule adds its finding and goes on.

use alloc::vec::Vec;

use crate::config::{
    AddressDevice, AddressFunction, AddressMode, DATA_EXCH, Endpoint, PlcAddress, SEND_REQ, SendReq,
    SendReqForm, Target, device_target, read_words,
};
use crate::plan::TriggerType;
use crate::plan::checks::Checks;
use crate::plan::finding::Field;
use crate::plan::limits::{RECEIVED_WORDS, USUAL_MESSAGE};
use crate::plan::rule::Rule;
use crate::wire::{DecodeErrorKind, Epath, MAX_MESSAGE, ServiceCode};

use super::fields::{FieldsError, WordsFields};
use super::rule::WordsRule;
use super::split::{Split, SplitError};

/// Request codes of SEND_REQ. Control Expert help D-NA-0014148, D-SE-0006431.
const CIP_REQUEST: i64 = 0x0E;
const MODBUS_TCP: i64 = 0x50;

/// `Type` of DATA_EXCH: transmission, then reception.
const SEND_AND_RECEIVE: i64 = 1;

/// Name, kind, and the members that only one of the forms has.
pub(super) fn block(checks: &mut Checks, config: &SendReq) {
    let form = config.form();
    checks.name(&config.name);
    if !matches!(config.kind.as_str(), SEND_REQ | DATA_EXCH) {
        checks.error(Field::Kind, Rule::UnknownKind);
    }
    checks.unknown("", &config.extra);
    if form == SendReqForm::DataExch {
        if config.dialect.is_some() {
            checks.warning(Field::Dialect, WordsRule::NotOfForm(form).into());
        }
        if config.request_code != CIP_REQUEST {
            checks.warning(Field::RequestCode, WordsRule::NotOfForm(form).into());
        }
        if config.exchange_type != SEND_AND_RECEIVE {
            checks.error(Field::ExchangeType, WordsRule::ExchangeType(config.exchange_type).into());
        }
        return;
    }
    if config.exchange_type != SEND_AND_RECEIVE {
        checks.warning(Field::ExchangeType, WordsRule::NotOfForm(form).into());
    }
    match config.request_code {
        CIP_REQUEST => {}
        MODBUS_TCP => checks.error(Field::RequestCode, WordsRule::ModbusTcp.into()),
        code => checks.error(Field::RequestCode, WordsRule::RequestCode(code).into()),
    }
}

pub(super) fn period(checks: &mut Checks, period: i64) -> Option<TriggerType> {
    checks.number::<u16>(Field::Period, period, 0, 65_535).map(TriggerType::of)
}

/// What an address says of the way; the rest is in the words.
pub(super) enum Addressed {
    /// TSX ETC 100: the message type is in the words.
    Device(Target),
    /// TSX ETC 101: everything is in the words.
    Nobody,
    /// `DATA_EXCH`: everything is here.
    Way(Target, AddressMode),
}

pub(super) fn address(checks: &mut Checks, text: &str, form: SendReqForm) -> Option<Addressed> {
    let address: PlcAddress = match text.parse() {
        Ok(address) => address,
        Err(error) => {
            checks.error(Field::Address, WordsRule::Address(error).into());
            return None;
        }
    };
    remarks(checks, &address, form);
    let rule = match (form, address.device) {
        (SendReqForm::Etc100, Some(AddressDevice::Dotted(device))) => {
            return Some(Addressed::Device(device_target(device)));
        }
        (SendReqForm::Etc101, None) => return Some(Addressed::Nobody),
        (SendReqForm::DataExch, Some(AddressDevice::Braced(device, mode))) => {
            return Some(Addressed::Way(device_target(device), mode));
        }
        (SendReqForm::Etc101, Some(AddressDevice::Dotted(_))) => WordsRule::AddressWithIp,
        (form, _) => WordsRule::AddressShape(form),
    };
    checks.error(Field::Address, rule.into());
    None
}

fn remarks(checks: &mut Checks, address: &PlcAddress, form: SendReqForm) {
    if address.xway.is_some() {
        checks.warning(Field::Address, WordsRule::Xway.into());
    }
    match address.channel {
        0 => {}
        3 => checks.note(Field::Address, WordsRule::Channel(3).into()),
        channel => checks.warning(Field::Address, WordsRule::Channel(channel).into()),
    }
    if let Some(device) = address.endpoint().filter(|device| device.has_unusual_port()) {
        checks.warning(Field::Address, Rule::TcpPort { port: device.port });
    }
    let usual = match (form, address.function) {
        (SendReqForm::DataExch, Some(AddressFunction::Addr)) => "ADDM (M340) or ADDMX (M580)",
        (SendReqForm::Etc100 | SendReqForm::Etc101, Some(AddressFunction::Addm | AddressFunction::Addmx)) => {
            "ADDR"
        }
        _ => return,
    };
    checks.warning(Field::Address, WordsRule::AddressFunction { usual }.into());
}

/// `Management_Param`: what its words say, each if it can be used.
pub(super) struct Management {
    /// x 100 ms; 0 = for ever.
    pub(super) timeout: Option<u16>,
    pub(super) length: Option<u16>,
}

pub(super) fn management(checks: &mut Checks, config: &SendReq) -> Option<Management> {
    let given = config.management_param.as_slice();
    let mut word = |index: usize| {
        let value = *given.get(index)?;
        checks.number::<u16>(Field::ManagementParam(index), value, 0, 65_535)
    };
    let [first, second, timeout, length] = [word(0), word(1), word(2), word(3)];
    for (index, word) in [first, second].into_iter().enumerate() {
        if word.is_some_and(|word| word != 0) {
            checks.note(Field::ManagementParam(index), WordsRule::SystemWord.into());
        }
    }
    if timeout == Some(0) {
        checks.warning(Field::ManagementParam(2), WordsRule::WaitsForEver.into());
    }
    if length == Some(0) {
        checks.error(Field::ManagementParam(3), WordsRule::LengthZero.into());
    }
    if given.len() != 4 {
        checks.error(Field::ManagementParams, WordsRule::ManagementCount(given.len()).into());
        return None;
    }
    Some(Management { timeout, length: length.filter(|length| *length != 0) })
}

pub(super) fn received(checks: &mut Checks, config: &SendReq) -> Option<u16> {
    let (min, max) = RECEIVED_WORDS.into_inner();
    checks.number(Field::ReceivedDataSize, config.received_data_size, min, max)
}

/// The words with a request in them.
pub(super) struct Message {
    pub(super) words: Vec<u16>,
    /// The CIP request.
    pub(super) bytes: Vec<u8>,
    connected: Option<bool>,
    ip: Option<[u8; 4]>,
}

impl Message {
    /// Where it goes, and whether over a connection.
    pub(super) fn way(&self, address: Addressed) -> Option<(Target, bool)> {
        Some(match address {
            Addressed::Device(target) => (target, self.connected?),
            Addressed::Nobody => (device_target(Endpoint::of_ip(self.ip?)), self.connected?),
            Addressed::Way(target, mode) => (target, mode == AddressMode::Connected),
        })
    }
}

/// `length`: bytes that are sent; everything while it cannot be read.
pub(super) fn message(checks: &mut Checks, config: &SendReq, length: Option<u16>) -> Option<Message> {
    let form = config.form();
    let words = match read_words(&config.data_to_send) {
        Ok(words) if words.is_empty() => {
            checks.error(Field::DataToSend, Rule::Missing);
            return None;
        }
        Ok(words) => words,
        Err(error) => {
            checks.error(Field::DataToSend, WordsRule::Words(error).into());
            return None;
        }
    };
    let bytes = 2 * words.len();
    let sent = length.map_or(bytes, usize::from);
    let filling = words.last().is_some_and(|last| *last <= 0xFF) && sent + 1 == bytes;
    if sent < bytes && !filling {
        checks.note(Field::ManagementParam(3), WordsRule::LengthUnder { sent, bytes }.into());
    }
    let connected = message_type(checks, form, &words);
    let split = match Split::new(form, &words, sent) {
        Ok(split) => split,
        Err(error) => {
            let (field, rule) = match error {
                SplitError::TooLong { length, bytes } => {
                    (Field::ManagementParam(3), WordsRule::LengthOver { length, bytes })
                }
                // The words have it, the length cuts it.
                SplitError::TooShort { at, .. } if bytes >= at + 2 => {
                    (Field::ManagementParam(3), WordsRule::Request(FieldsError::Split(error)))
                }
                SplitError::TooShort { .. } => {
                    (Field::DataToSend, WordsRule::Request(FieldsError::Split(error)))
                }
            };
            checks.error(field, rule.into());
            return None;
        }
    };
    let sound = request(checks, form, &words, sent, &split);
    sound.then_some(Message { words, bytes: split.message, connected, ip: split.ip })
}

fn message_type(checks: &mut Checks, form: SendReqForm, words: &[u16]) -> Option<bool> {
    match words.first() {
        _ if form == SendReqForm::DataExch => None,
        Some(0) => Some(false),
        Some(1) => Some(true),
        Some(word) => {
            checks.error(Field::DataToSend, WordsRule::MessageType(*word).into());
            None
        }
        None => None,
    }
}

/// Service, path and length of the CIP request.
fn request(checks: &mut Checks, form: SendReqForm, words: &[u16], sent: usize, split: &Split) -> bool {
    let length = split.message.len();
    if length > MAX_MESSAGE {
        checks.error(Field::DataToSend, Rule::TooMuchData { length, max: MAX_MESSAGE });
        return false;
    }
    if length > USUAL_MESSAGE {
        checks.warning(Field::DataToSend, Rule::LongMessage { length, max: USUAL_MESSAGE });
    }
    let fields = match WordsFields::read(form, words, sent) {
        Ok(fields) => fields,
        Err(error) => {
            // Is it the words that are too short, or the length?
            let cut = WordsFields::of_words(form, words).is_ok();
            let field = if cut { Field::ManagementParam(3) } else { Field::DataToSend };
            checks.error(field, WordsRule::Request(error).into());
            return false;
        }
    };
    let mut sound = true;
    if fields.service == 0 || fields.service >= ServiceCode::REPLY {
        checks.error(Field::DataToSend, WordsRule::Service(fields.service).into());
        sound = false;
    }
    let path = fields.path.bytes();
    if path.is_empty() {
        checks.error(Field::DataToSend, WordsRule::NoPath.into());
        sound = false;
    }
    if let Err(error) = Epath::decode(&path) {
        let found = match error.kind {
            DecodeErrorKind::Unexpected { .. } => path.get(error.at).copied(),
            _ => None,
        };
        // Behind the service and the path size.
        let byte = split.at + 2 + error.at;
        checks.error(Field::DataToSend, WordsRule::Path { byte, found }.into());
        sound = false;
    }
    sound
}

/// Layouts are about the data of the CIP request and reply.
pub(super) fn layouts(checks: &mut Checks, config: &SendReq) {
    checks.layout(Field::ResLayout, &config.res_layout);
    let size = checks.layout(Field::ReqLayout, &config.req_layout).and_then(|fields| fields.size());
    let Ok(words) = read_words(&config.data_to_send) else { return };
    let length = config.management_param.get(3).and_then(|length| usize::try_from(*length).ok());
    // What is wrong with the words themselves is said elsewhere.
    let fields = WordsFields::read(config.form(), &words, length.unwrap_or(2 * words.len()));
    if let (Some(layout), Ok(fields)) = (size, fields)
        && layout != fields.data.len()
    {
        let rule = WordsRule::LayoutLength { layout, length: fields.data.len() };
        checks.warning(Field::ReqLayout, rule.into());
    }
}
