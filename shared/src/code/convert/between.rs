//! `SEND_REQ` and `DATA_EXCH` among themselves: the CIP request stays, its head and the address change.

use alloc::string::ToString;
use alloc::vec::Vec;

use super::to_words::{addressed, head};
use crate::code::change::{Change, Grade, Why};
use crate::config::{Endpoint, PlcAddress, SendReq, SendReqForm, Target, bytes_of, words_of, write_words};
use crate::plan::MessagePlan;

/// Moves the request.
pub(super) fn convert(words: &SendReq, form: SendReqForm, changes: &mut Vec<Change>) -> SendReq {
    let new = SendReq::new(form, &words.name);
    let mut new = SendReq {
        kind: new.kind,
        dialect: new.dialect,
        request_code: new.request_code,
        exchange_type: new.exchange_type,
        ..words.clone()
    };
    let Some(plan) = MessagePlan::of(&words.clone().into()).0 else { return new };
    let connected = plan.connection().is_some();
    let endpoint = match plan.target() {
        Target::Network(endpoint) => endpoint.clone(),
        Target::BuiltIn => Endpoint::of_ip([0; 4]),
    };
    if let Ok(place) = words.address.parse::<PlcAddress>() {
        let device = addressed(form, endpoint.clone(), connected);
        new.address = PlcAddress { function: None, device, ..place }.to_string();
        changes.push(Change::new(&"Address", &words.address, &new.address, Grade::Carried, Why::ModulePlace));
    }
    let bytes = [bytes_of(&head(form, &endpoint, connected, changes)), plan.bytes().to_vec()].concat();
    new.data_to_send = write_words(&words_of(&bytes));
    if let Some(length) = new.management_param.get_mut(3) {
        *length = i64::try_from(bytes.len()).unwrap_or(i64::MAX);
    }
    new
}
