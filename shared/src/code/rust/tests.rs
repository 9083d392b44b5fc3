//! Programs as we and others write them.

use super::{export, import};
use crate::code::{Found, Grade, Why};
use crate::config::{BlockConfig, MsgCipGeneric, TargetPath};
use crate::plan::MessagePlan;
use alloc::string::{String, ToString};
use alloc::vec::Vec;

fn config(path: &str) -> MsgCipGeneric {
    let mut config = MsgCipGeneric::product_name(path);
    (config.app_cfg.service, config.app_cfg.class, config.app_cfg.instance) = (16, 0x374, 274);
    (config.req_data, config.target_cfg.ucmm_timeout) = ("0aff".into(), 2_500);
    config
}

fn request(config: &BlockConfig) -> (Vec<u8>, TargetPath, u32, Option<u32>) {
    let (plan, findings) = MessagePlan::of(config);
    let plan = plan.unwrap_or_else(|| panic!("{findings:?}"));
    let path = config.as_msg().unwrap().target_cfg.path.parse().unwrap();
    let connection = plan.connection().map(|connection| connection.timeout_ms);
    (plan.bytes().to_vec(), path, plan.ucmm_timeout_ms(), connection)
}

fn only(text: &str) -> Found {
    let mut read = import(text);
    assert_eq!((read.blocks.len(), read.remarks.len()), (1, 0), "{read:?}\n{text}");
    read.blocks.remove(0)
}

#[test]
fn a_program_says_all_of_a_message() {
    for (path, instance, members, connected) in [
        ("4,10.0.0.7", 274, 0, false),
        ("4,10.0.0.7", 0x12345, 2, false),
        ("4,plc-3.line:44820,1,0", 1, 3, false),
        ("4,10.0.0.7,1,3,2,192.168.1.55", 1, 0, false),
        ("4,10.0.0.7,1,3,2,192.168.1.55", 1, 0, true),
        ("4,10.0.0.7", 1, 1, true),
    ] {
        let mut config = config(path);
        config.name = "set \"speed\"\n🦀 */ //".into();
        config.app_cfg.instance = instance;
        (config.app_cfg.member_cnt, config.app_cfg.member_id) = (members, alloc::vec![1, 300, 7]);
        let target = &mut config.target_cfg;
        (target.cip_conn_mode, target.conn_close) = (connected.into(), connected);
        let block = BlockConfig::from(config);
        let code = export(&block, &[]);
        assert_eq!(code.changes, [], "{path}");
        let found = only(&code.text);
        assert_eq!(request(&found.config), request(&block), "{}", code.text);
        assert_eq!((found.config.name(), found.remarks.len()), (block.name(), 0));
    }
}

#[test]
fn what_the_library_cannot_send_is_told_and_not_sent() {
    for (path, why) in [("0,0", Why::NoBuiltIn), ("4,10.0.0.7,18,10.0.0.20", Why::NoRoute)] {
        let code = export(&config(path).into(), &[]);
        let whys: Vec<(Grade, Why)> = code.changes.iter().map(|it| (it.grade, it.why.clone())).collect();
        assert_eq!(whys, [(Grade::Request, why)]);
        assert!(code.text.contains("return Err("), "{}", code.text);
    }
}

#[test]
fn programs_of_others_are_read() {
    let text = "use rseip::client::ab_eip::*;\nlet mut client = AbEipClient::new_host_lookup(\"192.168.0.83\").await?\n    \
                .with_connection_path(PortSegment::default());\nlet path = EPath::new().with_class(1).with_instance(1).with_attribute(7);\n\
                let name: String = client.get_attribute_single(path).await?;\n\
                let reply = client.send(MessageRequest::new(0x10, EPath::new().with_class(0x93).with_instance(41).with_attribute(9), 1500_u16)).await?;\n\
                loop {}\n";
    let read = import(text);
    let configs: Vec<&MsgCipGeneric> =
        read.blocks.iter().map(|found| found.config.as_msg().unwrap()).collect();
    let [name, speed] = configs.as_slice() else { panic!("{read:?}") };
    let app = &name.app_cfg;
    assert_eq!((app.service, app.class, app.instance, app.attribute), (14, 1, 1, 7));
    assert_eq!(
        (name.target_cfg.path.as_str(), speed.target_cfg.path.as_str()),
        ("4,192.168.0.83,1,0", "4,192.168.0.83,1,0")
    );
    assert!(
        read.blocks[1].remarks.iter().any(|it| it.to_string().contains("data is not a constant")),
        "{read:?}"
    );
    assert_eq!(read.remarks.len(), 1, "{:?}", read.remarks);
    for text in ["", "fn main() {}", "MessageRequest::new(", "let", "let x = MessageRequest"] {
        assert!(!import(text).remarks.is_empty() || !import(text).blocks.is_empty(), "{text}");
    }
}

#[test]
fn what_is_mutable_or_bound_again_is_not_what_it_was_before() {
    let told = |binding: &str| {
        let text = alloc::format!(
            "let host = \"10.0.0.1\"; let data = [1_u8, 2]; {binding}\n\
             let stream = connect(host);\nMessageRequest::new(14, EPath::new().with_class(1).with_instance(1), &data[..])"
        );
        let read = import(&text);
        let app = read.blocks[0].config.as_msg().unwrap().req_data.clone();
        (
            app,
            read.blocks[0].remarks.iter().any(|remark| remark.to_string().contains("data is not a constant")),
        )
    };
    assert_eq!(told(""), ("0102".into(), false));
    assert_eq!(told("let data = [3];"), ("03".into(), false));
    for changed in ["let data = read();", "let mut data = vec![3];", "let (n, data) = read();"] {
        assert_eq!(told(changed), (String::new(), true), "{changed}");
    }
}
