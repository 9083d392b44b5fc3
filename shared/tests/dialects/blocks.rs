//! Blocks of all kinds, most of them valid.

use cipdeck_shared::config::{BlockConfig, MsgCipGeneric, SendReq, SendReqForm, write_hex, write_words};
use proptest::collection::vec;
use proptest::prelude::*;

pub(crate) fn block() -> impl Strategy<Value = BlockConfig> {
    prop_oneof![3 => message().prop_map(BlockConfig::from), 2 => words().prop_map(BlockConfig::from)]
}

fn message() -> impl Strategy<Value = MsgCipGeneric> {
    let app = (
        1_i64..=127,
        prop_oneof![1_i64..=255, 256_i64..=65_535],
        prop_oneof![0_i64..=255, 256_i64..=65_535, 65_536_i64..=0xFFFF_FFFF],
        prop_oneof![Just(0_i64), 1_i64..=255, 256_i64..=65_535],
        prop_oneof![3 => Just(0_i64), 1 => 1_i64..=3],
        vec(0_i64..=65_535, 3),
    );
    let target = (
        path(),
        any::<bool>(),
        prop_oneof![Just(0_i64), 250_i64..=10_000, Just(50_000_i64)],
        prop_oneof![Just(0_i64), 800_i64..=10_000],
        any::<bool>(),
    );
    let rest = (
        vec(any::<u8>(), 0..40),
        prop_oneof![Just(490_i64), 1_i64..=490],
        prop_oneof![3 => Just(0_i64), 1 => 1_i64..=65_535],
        name(),
        prop_oneof![9 => Just(false), 1 => Just(true)],
    );
    (app, target, rest).prop_map(|(app, target, (data, size, trigger, name, invalid))| {
        let mut config = MsgCipGeneric::product_name(target.0);
        config.name = name;
        let it = &mut config.app_cfg;
        (it.service, it.class, it.instance, it.attribute, it.member_cnt, it.member_id) = app;
        let it = &mut config.target_cfg;
        it.cip_conn_mode = target.1.into();
        (it.ucmm_timeout, it.conn_msg_timeout, it.conn_close) = (target.2, target.3, target.4);
        config.req_data = write_hex(&data);
        config.res_data_size = size;
        config.ctrl_cfg.trigger_type = trigger;
        if invalid {
            config.app_cfg.service = 300;
        }
        config
    })
}

fn path() -> impl Strategy<Value = &'static str> {
    prop_oneof![
        4 => Just("4,192.168.1.100"),
        1 => Just("4,192.168.1.100,1,0"),
        1 => Just("4,10.0.0.1,1,3,2,192.168.1.55"),
        1 => Just("4,10.0.0.1,18,10.0.0.20"),
        1 => Just("4,10.0.0.1:44820"),
        1 => Just("4,plc-3.line"),
        1 => Just("0,0"),
    ]
}

fn name() -> impl Strategy<Value = String> {
    prop_oneof![3 => "[a-z][a-z0-9-]{0,20}", 1 => "[ -~]{1,40}", 1 => "\\PC{1,30}".prop_filter("not blank", |name| !name.trim().is_empty())]
}

fn words() -> impl Strategy<Value = SendReq> {
    let form = prop_oneof![Just(SendReqForm::Etc100), Just(SendReqForm::Etc101), Just(SendReqForm::DataExch)];
    let request = (1_u8..=127, 1_u8..=255, 0_u8..=255, vec(any::<u8>(), 0..20));
    let device = (any::<[u8; 4]>(), any::<bool>());
    (form, request, device, 0_i64..=600, name(), 2_i64..=512).prop_map(
        |(form, request, device, timeout, name, size)| {
            let (service, class, instance, data) = request;
            let ([a, b, c, d], connected) = device;
            let mut bytes = match form {
                SendReqForm::Etc100 => vec![connected.into(), 0],
                SendReqForm::Etc101 => vec![connected.into(), 0, b, a, d, c],
                SendReqForm::DataExch => Vec::new(),
            };
            bytes.extend([service, 2, 0x20, class, 0x24, instance]);
            bytes.extend(data);
            let mut config = SendReq::new(form, &name);
            config.address = match form {
                SendReqForm::Etc100 => format!("ADDR('0.2.0.{a}.{b}.{c}.{d}')"),
                SendReqForm::Etc101 => "ADDR('0.2.0')".to_owned(),
                SendReqForm::DataExch => {
                    format!("ADDMX('0.3.0{{{a}.{b}.{c}.{d}}}{}.CIP')", if connected { "CON" } else { "UNC" })
                }
            };
            let length = i64::try_from(bytes.len()).unwrap_or(i64::MAX);
            config.data_to_send = write_words(&cipdeck_shared::config::words_of(&bytes));
            config.management_param = vec![0, 0, timeout, length];
            config.received_data_size = size;
            config
        },
    )
}
