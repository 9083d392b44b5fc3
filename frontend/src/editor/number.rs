//! The number members of a configuration, by field.

use cipdeck_shared::{config::MsgCipGeneric, plan::Field};

/// The number of a field; `None` for an absent `ReqLength` and for fields that hold no number.
pub fn number(config: &MsgCipGeneric, field: &Field) -> Option<i64> {
    Some(match field {
        Field::TriggerType => config.ctrl_cfg.trigger_type,
        Field::StrMode => config.ctrl_cfg.str_mode,
        Field::Service => config.app_cfg.service,
        Field::Class => config.app_cfg.class,
        Field::Instance => config.app_cfg.instance,
        Field::Attribute => config.app_cfg.attribute,
        Field::MemberCnt => config.app_cfg.member_cnt,
        Field::MemberId(index) => return config.app_cfg.member_id.get(*index).copied(),
        Field::KeepAlive => config.keep_alive,
        Field::CipConnMode => config.target_cfg.cip_conn_mode,
        Field::UcmmTimeout => config.target_cfg.ucmm_timeout,
        Field::ConnMsgTimeout => config.target_cfg.conn_msg_timeout,
        Field::ReqLength => return config.req_length,
        Field::ResDataSize => config.res_data_size,
        _ => return None,
    })
}

/// Changes the number of a field. Only `ReqLength` can be absent.
pub(super) fn set_number(config: &mut MsgCipGeneric, field: &Field, value: Option<i64>) {
    if *field == Field::ReqLength {
        config.req_length = value;
        return;
    }
    let Some(value) = value else { return };
    let member = match field {
        Field::TriggerType => &mut config.ctrl_cfg.trigger_type,
        Field::StrMode => &mut config.ctrl_cfg.str_mode,
        Field::Service => &mut config.app_cfg.service,
        Field::Class => &mut config.app_cfg.class,
        Field::Instance => &mut config.app_cfg.instance,
        Field::Attribute => &mut config.app_cfg.attribute,
        Field::MemberCnt => &mut config.app_cfg.member_cnt,
        Field::MemberId(index) => {
            // A pasted block may have fewer than three.
            if config.app_cfg.member_id.len() <= *index && *index < 3 {
                config.app_cfg.member_id.resize(index + 1, 0);
            }
            let Some(member) = config.app_cfg.member_id.get_mut(*index) else { return };
            member
        }
        Field::KeepAlive => &mut config.keep_alive,
        Field::CipConnMode => &mut config.target_cfg.cip_conn_mode,
        Field::UcmmTimeout => &mut config.target_cfg.ucmm_timeout,
        Field::ConnMsgTimeout => &mut config.target_cfg.conn_msg_timeout,
        Field::ResDataSize => &mut config.res_data_size,
        _ => return,
    };
    *member = value;
}

/// The fields that hold numbers: what a kept draft may name.
pub(super) fn number_fields() -> Vec<Field> {
    vec![
        Field::TriggerType,
        Field::StrMode,
        Field::Service,
        Field::Class,
        Field::Instance,
        Field::Attribute,
        Field::MemberCnt,
        Field::MemberId(0),
        Field::MemberId(1),
        Field::MemberId(2),
        Field::CipConnMode,
        Field::UcmmTimeout,
        Field::ConnMsgTimeout,
        Field::KeepAlive,
        Field::ReqLength,
        Field::ResDataSize,
    ]
}

/// A number in the other radix: `0x0E` for `14`, `14` for `0x0E`, with at least two hexadecimal digits.
pub fn other_radix(text: &str, value: i64) -> String {
    let decimal = text.trim().trim_start_matches('-').replace('_', "").bytes().all(|b| b.is_ascii_digit());
    if decimal { hexadecimal(value) } else { value.to_string() }
}

/// `0x0E`; `-0x01` for a negative number.
pub fn hexadecimal(value: i64) -> String {
    let sign = if value < 0 { "-" } else { "" };
    format!("{sign}0x{:02X}", value.unsigned_abs())
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn every_number_field_reads_back_what_is_set() {
        let mut config = MsgCipGeneric::product_name("0,0");
        config.app_cfg.member_id.clear();
        for (field, value) in number_fields().into_iter().zip(100..) {
            set_number(&mut config, &field, Some(value));
            assert_eq!(number(&config, &field), Some(value), "{field}");
        }
    }

    #[test]
    fn a_number_is_shown_in_the_radix_that_was_not_typed() {
        for (text, value, other) in [
            ("14", 14, "0x0E"),
            ("0x0E", 14, "14"),
            ("93h", 147, "147"),
            ("65_535", 65_535, "0xFFFF"),
            ("-1", -1, "-0x01"),
        ] {
            assert_eq!(other_radix(text, value), other, "{text}");
        }
    }
}
