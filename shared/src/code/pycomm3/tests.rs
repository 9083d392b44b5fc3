//! Scripts as we and others write them.

use super::{export, import};
use crate::code::{Found, Grade, Why};
use crate::config::{BlockConfig, MsgCipGeneric};
use crate::plan::MessagePlan;
use alloc::string::{String, ToString};
use alloc::vec::Vec;

fn config(path: &str) -> MsgCipGeneric {
    let mut config = MsgCipGeneric::product_name(path);
    (config.app_cfg.service, config.app_cfg.class, config.app_cfg.attribute) = (16, 0x374, 0);
    config.app_cfg.instance = 274;
    (config.req_data, config.target_cfg.ucmm_timeout) = ("0aff".into(), 2_500);
    config
}

fn request(config: &BlockConfig) -> (Vec<u8>, String, Vec<u8>, u32, Option<u32>) {
    let plan = MessagePlan::of(config).0.unwrap();
    let route =
        config.as_msg().unwrap().target_cfg.path.parse::<crate::config::TargetPath>().unwrap().route.bytes();
    let connection = plan.connection().map(|connection| connection.timeout_ms);
    (plan.bytes().to_vec(), plan.target().to_string(), route, plan.ucmm_timeout_ms(), connection)
}

fn only(text: &str) -> Found {
    let mut read = import(text);
    assert_eq!(read.blocks.len(), 1, "{read:?}");
    read.blocks.remove(0)
}

#[test]
fn a_script_says_all_of_a_message() {
    for path in
        ["4,10.0.0.7", "4,plc-3.line:44820,1,0", "4,10.0.0.7,1,3,2,192.168.1.55", "4,10.0.0.7,18,10.0.0.20"]
    {
        let mut config = config(path);
        config.name = "set \"speed\"\n🦀".into();
        let block = BlockConfig::from(config);
        let code = export(&block, &[]);
        assert_eq!(code.changes, [], "{path}");
        let found = only(&code.text);
        assert_eq!(request(&found.config), request(&block), "{}", code.text);
        assert_eq!((found.config.name(), found.remarks.len()), (block.name(), 0));
    }
}

#[test]
fn a_connection_has_one_timeout_and_ends_with_the_script() {
    let mut config = config("4,10.0.0.7,1,0");
    let target = &mut config.target_cfg;
    (target.cip_conn_mode, target.conn_msg_timeout, target.conn_close) = (1, 2_500, true);
    let block = BlockConfig::from(config.clone());
    let code = export(&block, &[]);
    assert_eq!(code.changes, []);
    assert_eq!(request(&only(&code.text).config), request(&block));
    config.target_cfg.conn_msg_timeout = 9_000;
    config.target_cfg.conn_close = false;
    let whys: Vec<Why> = export(&config.into(), &[]).changes.into_iter().map(|change| change.why).collect();
    assert_eq!(whys, [Why::OneTimeout, Why::ConnectionStays]);
}

#[test]
fn what_the_library_would_send_otherwise_is_told_and_not_sent() {
    let told = |change: &dyn Fn(&mut MsgCipGeneric)| {
        let mut config = config("4,10.0.0.7");
        change(&mut config);
        let code = export(&config.into(), &[]);
        let why = code
            .changes
            .iter()
            .find(|change| change.grade == Grade::Request)
            .map(|change| change.why.clone());
        (why, code.text.contains("raise SystemExit(\"this script"))
    };
    assert_eq!(told(&|_| ()), (None, false));
    assert_eq!(told(&|it| it.app_cfg.member_cnt = 1), (Some(Why::NoMemberSegments), true));
    assert_eq!(told(&|it| it.app_cfg.instance = 70_000), (Some(Why::SegmentWidths), true));
    assert_eq!(told(&|it| it.target_cfg.path = "0,0".into()), (Some(Why::NoBuiltIn), true));
}

#[test]
fn scripts_of_others_are_read() {
    let text = "from pycomm3 import LogixDriver, CIPDriver, Services, ClassCode, UINT\n\
                SPEED = UINT.encode(1500)\n\
                with LogixDriver('192.168.1.10/3') as plc:\n    plc.open()\n\
                \x20   tag = plc.generic_message(service=Services.get_attribute_single, class_code=ClassCode.identity_object,\n\
                \x20                             instance=b'\\x01', attribute=7, connected=False, unconnected_send=True)\n\
                with CIPDriver('10.10.0.4') as drive:\n\
                \x20   drive.generic_message(0x10, 0x93, instance=41, attribute=9, request_data=SPEED + b'\\x00',\n\
                \x20                         connected=False, route_path=False, data_type=None)\n\
                \x20   drive.generic_message(1, 1, 1, connected=False)\n";
    let read = import(text);
    let configs: Vec<&MsgCipGeneric> =
        read.blocks.iter().map(|found| found.config.as_msg().unwrap()).collect();
    let [identity, speed, appended] = configs.as_slice() else { panic!("{read:?}") };
    let app = &identity.app_cfg;
    assert_eq!((app.service, app.class, app.instance, app.attribute), (14, 1, 1, 7));
    assert_eq!(
        (identity.target_cfg.path.as_str(), identity.target_cfg.ucmm_timeout),
        ("4,192.168.1.10,1,3", 5_000)
    );
    assert_eq!((speed.target_cfg.path.as_str(), speed.req_data.as_str()), ("4,10.10.0.4", "dc0500"));
    assert_eq!((appended.req_data.as_str(), appended.target_cfg.path.as_str()), ("0000", "4,10.10.0.4"));
    assert!(read.blocks[2].remarks[0].to_string().contains("appends the route"));
    assert_eq!(read.blocks[0].lines, 5..7);
    assert!(read.remarks[0].to_string().contains("1 other lines"), "{:?}", read.remarks);
}

#[test]
fn what_is_not_constant_is_told() {
    let read = import(
        "import sys\nplc = CIPDriver(sys.argv[1])\nplc.generic_message(service=s, class_code=1, klass=2)\n",
    );
    let said: Vec<String> = read.blocks[0].remarks.iter().map(ToString::to_string).collect();
    for part in
        ["service is not a constant", "instance is missing", "klass is not known", "the path of the driver"]
    {
        assert!(said.iter().any(|remark| remark.contains(part)), "{part}: {said:?}");
    }
    for text in ["", "print(1)", "generic_message", "x.generic_message(", "CIPDriver("] {
        assert!(!import(text).remarks.is_empty() || !import(text).blocks.is_empty(), "{text}");
    }
}

/// The data of the last message of a script, or what is wrong with it.
fn data(before: &str) -> Result<String, String> {
    let script = alloc::format!(
        "data = b'\\x01'\np = CIPDriver('10.0.0.1')\n{before}\np.generic_message(14, 1, 1, request_data=data)\n"
    );
    let read = import(&script);
    let found = read.blocks.last().unwrap();
    let error = found.remarks.iter().find(|remark| remark.severity == crate::plan::Severity::Error);
    error.map_or_else(|| Ok(found.config.as_msg().unwrap().req_data.clone()), |error| Err(error.to_string()))
}

#[test]
fn what_the_script_changes_later_is_not_what_it_was_before() {
    for same in ["", "print(data)", "n = len(data)", "p.open()", "for i in range(3):\n    print(i)"] {
        assert_eq!(data(same), Ok("01".into()), "{same}");
    }
    for changed in [
        "data = read()",
        "data += b'2'",
        "data[0] = 5",
        "data.append(2)",
        "other, data = read()",
        "other = data = read()",
        "for data in all:\n    pass",
        "with open('x') as data:\n    pass",
        "if fast: data = read()",
        "def f(data):",
        "data = f'{x}'",
        "data = b'\\xZZ'",
    ] {
        assert!(data(changed).is_err_and(|it| it.contains("request_data is not a constant")), "{changed}");
    }
    assert_eq!(data("data = b'\\x0a\\012\\a'"), Ok("0a0a07".into()));
}
