//! What belongs to a write: what is there before and after, in words.

use cipdeck_shared::api::{ReadValue, Written};
use cipdeck_shared::config::write_hex;
use cipdeck_shared::dissect;
use cipdeck_shared::plan::MessagePlan;
use cipdeck_shared::tag::DataFields;

use crate::runner::Ended;

/// What a read has found, or why there is nothing.
pub(crate) fn found(ended: &Ended, layout: &str) -> Result<ReadValue, String> {
    let status = &ended.view.status;
    if !ended.view.q {
        let cause = ended.view.cause.as_ref().and_then(|cause| cause.detail.clone());
        let ids = format!("ErrorID {}, SubErrorID {}", status.error_id, status.sub_error_id);
        return Err(cause.map_or_else(|| ids.clone(), |cause| format!("{ids}: {cause}")));
    }
    let reply = ended.exchange.response().unwrap_or_default();
    Ok(value(&ended.exchange.request, reply, &ended.view.res_data, layout))
}

/// What a write will leave behind: its data as the read would find it.
pub(crate) fn wanted(reader: &MessagePlan, write: &MessagePlan, layout: &str) -> Option<ReadValue> {
    let data = write.written();
    let service = reader.bytes().first()? | 0x80;
    let reply = [&[service, 0, 0, 0], data].concat();
    Some(value(reader.bytes(), &reply, data, layout))
}

/// Both sides of a write that has been carried out.
pub(crate) fn written(
    old: Option<ReadValue>,
    new: Option<ReadValue>,
    read_back: Option<ReadValue>,
) -> Written {
    let is_equal = new.as_ref().zip(read_back.as_ref()).map(|(new, found)| new.data == found.data);
    Written { old, new, read_back, is_equal }
}

/// `layout` is what somebody says about the data that is written, and so about what is read.
fn value(request: &[u8], reply: &[u8], data: &[u8], layout: &str) -> ReadValue {
    let decoded = match DataFields::read(layout) {
        Ok(layout) => dissect::decode_as(&layout, reply),
        Err(_) => dissect::decode(request, reply),
    };
    let words: Vec<_> = decoded
        .iter()
        .map(|value| {
            let guess = if value.guess { " (a guess)" } else { "" };
            format!("{} {} {}{guess}", value.name, value.type_name, value.text)
        })
        .collect();
    ReadValue { data: write_hex(data), text: words.join("; ") }
}
