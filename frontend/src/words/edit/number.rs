//! The number members of a configuration, by field.

use cipdeck_shared::{config::SendReq, plan::Field};

/// The fields that hold numbers: what a kept draft may name.
pub(super) const NUMBERS: [Field; 7] = [
    Field::RequestCode,
    Field::ExchangeType,
    Field::ManagementParam(2),
    Field::ManagementParam(3),
    Field::ReceivedDataSize,
    Field::Period,
    Field::KeepAlive,
];

/// The number of a field; `None` for fields that hold none.
pub(super) fn number(config: &SendReq, field: &Field) -> Option<i64> {
    Some(match field {
        Field::RequestCode => config.request_code,
        Field::ExchangeType => config.exchange_type,
        Field::ManagementParam(index) => return config.management_param.get(*index).copied(),
        Field::ReceivedDataSize => config.received_data_size,
        Field::Period => config.period,
        Field::KeepAlive => config.keep_alive,
        _ => return None,
    })
}

/// Changes the number of a field.
pub(super) fn set_number(config: &mut SendReq, field: &Field, value: i64) {
    let member = match field {
        Field::RequestCode => &mut config.request_code,
        Field::ExchangeType => &mut config.exchange_type,
        Field::ManagementParam(index) => {
            // A pasted block may have fewer than four.
            if config.management_param.len() <= *index && *index < 4 {
                config.management_param.resize(index + 1, 0);
            }
            let Some(member) = config.management_param.get_mut(*index) else { return };
            member
        }
        Field::ReceivedDataSize => &mut config.received_data_size,
        Field::Period => &mut config.period,
        Field::KeepAlive => &mut config.keep_alive,
        _ => return,
    };
    *member = value;
}

#[cfg(test)]
mod tests {
    use super::*;
    use cipdeck_shared::config::SendReqForm;

    #[test]
    fn every_number_field_reads_back_what_is_set() {
        let mut config = SendReq::new(SendReqForm::Etc100, "read");
        config.management_param.clear();
        for (field, value) in NUMBERS.into_iter().zip(100..) {
            set_number(&mut config, &field, value);
            assert_eq!(number(&config, &field), Some(value), "{field}");
        }
    }
}
