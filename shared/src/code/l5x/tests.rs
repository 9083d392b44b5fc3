//! Exports as Studio 5000 would get them, and imports of what it writes.

use super::{export, import};
use crate::code::{Found, Grade, RemarkKind, Why};
use crate::config::{BlockConfig, MsgCipGeneric};
use crate::plan::{MessagePlan, Severity};
use alloc::string::{String, ToString};
use alloc::vec::Vec;

fn write_speed() -> MsgCipGeneric {
    let mut config = MsgCipGeneric::product_name("4,192.168.1.100,1,0");
    config.name = "set-speed".into();
    config.app_cfg.service = 16;
    config.app_cfg.class = 0x374;
    config.app_cfg.instance = 274;
    config.app_cfg.attribute = 0;
    config.req_data = "0affd2".into();
    config.res_data_size = 12;
    config.target_cfg.ucmm_timeout = 2_500;
    config
}

fn only(text: &str) -> Found {
    let mut read = import(text);
    assert_eq!((read.blocks.len(), read.remarks.len()), (1, 0), "{:?}", read.remarks);
    read.blocks.remove(0)
}

fn request(config: &BlockConfig) -> (Vec<u8>, String, u32, Option<u32>) {
    let plan = MessagePlan::parse(config.as_msg().unwrap()).0.unwrap();
    let connection = plan.connection().map(|connection| connection.timeout_ms);
    (plan.bytes().to_vec(), plan.target().to_string(), plan.ucmm_timeout_ms(), connection)
}

#[test]
fn an_export_says_all_of_a_message() {
    let block = BlockConfig::from(write_speed());
    let code = export(&block, &[]);
    assert_eq!(code.losses().count(), 0, "{:?}", code.changes);
    for part in [
        r#"ServiceCode="16#0010" ObjectType="16#0374" TargetObject="274" AttributeNumber="16#0000""#,
        r#"RequestedLength="3" ConnectedFlag="2" ConnectionPath="2, 192.168.1.100, 1, 0""#,
        r#"LocalElement="set_speed_Req[0]" DestinationTag="set_speed_Res[0]" LargePacketUsage="false"/>"#,
        "<![CDATA[[10,-1,-46]]]>",
        r#"<Element Index="[1]" Value="16#ff"/>"#,
        "XIC(set_speed_Start)MOV(2500000,set_speed.UnconnectedTimeout)MSG(set_speed);",
    ] {
        assert!(code.text.contains(part), "{part}\n{}", code.text);
    }
    let found = only(&code.text);
    assert_eq!(found.remarks, []);
    assert_eq!(request(&found.config), request(&block));
    let config = found.config.as_msg().unwrap();
    assert_eq!((config.name.as_str(), config.res_data_size), ("set_speed", 12));
    assert!(found.lines.start > 3 && found.lines.end > found.lines.start + 3, "{:?}", found.lines);
}

#[test]
fn a_connection_and_a_period_come_back() {
    for (close, period, connected_ms) in [(false, 0, 800), (true, 1, 10_000), (false, 250, 1_234)] {
        let mut config = write_speed();
        let target = &mut config.target_cfg;
        (target.cip_conn_mode, target.conn_msg_timeout, target.conn_close) = (1, connected_ms, close);
        config.ctrl_cfg.trigger_type = period;
        let block = BlockConfig::from(config.clone());
        let code = export(&block, &[]);
        assert_eq!(code.losses().count(), 0, "{:?}", code.changes);
        let found = only(&code.text);
        assert_eq!(found.remarks, []);
        assert_eq!(request(&found.config), request(&block));
        let read = found.config.as_msg().unwrap();
        assert_eq!((read.target_cfg.conn_close, read.ctrl_cfg.trigger_type), (close, period));
    }
}

#[test]
fn what_a_message_tag_cannot_say_is_told_and_does_not_run() {
    let grade = |change: &dyn Fn(&mut MsgCipGeneric)| {
        let mut config = write_speed();
        change(&mut config);
        let code = export(&config.into(), &[]);
        let held = code.text.contains("AFI()XIC(");
        let found: Vec<(Grade, Why)> = code.losses().map(|it| (it.grade, it.why.clone())).collect();
        (held, found)
    };
    let members = grade(&|config| (config.app_cfg.member_cnt, config.app_cfg.member_id[0]) = (1, 3));
    assert_eq!(members, (true, alloc::vec![(Grade::Request, Why::NoMemberSegments)]));
    let port = grade(&|config| config.target_cfg.path = "4,10.0.0.1:44820".into());
    assert_eq!(port, (true, alloc::vec![(Grade::Request, Why::NoTcpPort)]));
    let instance = grade(&|config| config.app_cfg.instance = 70_000);
    assert_eq!(instance, (true, alloc::vec![(Grade::Request, Why::NumberLimit(65_535))]));
    let resume = grade(&|config| config.keep_alive = 1_000);
    assert_eq!(resume, (false, alloc::vec![(Grade::Lost, Why::OursAlone)]));
    let invalid = grade(&|config| config.app_cfg.service = 300);
    assert_eq!(invalid, (false, alloc::vec![(Grade::Request, Why::NotSendable)]));
}

/// Attributes and layout as in public exports; names and values are ours.
const PROJECT: &str = r#"<?xml version="1.0" encoding="UTF-8" standalone="yes"?>
<RSLogix5000Content SchemaRevision="1.0" SoftwareRevision="32.00" TargetName="Line4" TargetType="Controller" ContainsContext="false">
<Controller Use="Target" Name="Line4" ProcessorType="1756-L83E">
<Modules>
<Module Name="Drive7" ParentModule="EN2T" ParentModPortId="2"><Ports><Port Id="2" Address="10.0.0.7" Type="Ethernet" Upstream="true"/></Ports></Module>
</Modules>
<Tags>
<Tag Name="ReadCurrent" TagType="Base" DataType="MESSAGE" ExternalAccess="Read/Write">
<Data Format="Message">
<MessageParameters MessageType="CIP Generic" RequestedLength="0" ConnectedFlag="1" ConnectionPath="EN2T, 2, 10.0.0.5" CommTypeCode="0" ServiceCode="16#000e" ObjectType="16#0093" TargetObject="3" AttributeNumber="16#0009" LocalIndex="0" DestinationTag="Current[1]" CacheConnections="TRUE" LargePacketUsage="false"/>
</Data>
</Tag>
<Tag Name="Current" TagType="Base" DataType="DINT" Dimensions="4" Radix="Decimal"/>
<Tag Name="WriteRamp" TagType="Base" DataType="MESSAGE">
<Data Format="Message">
<MessageParameters MessageType="CIP Generic" RequestedLength="4" ConnectedFlag="2" ConnectionPath="Drive7" CommTypeCode="0" ServiceCode="16#0010" ObjectType="16#0093" TargetObject="41" AttributeNumber="16#0009" LocalIndex="0" LocalElement="Ramp[1]" DestinationTag="Nowhere" LargePacketUsage="false"/>
</Data>
</Tag>
<Tag Name="Ramp" TagType="Base" DataType="DINT" Dimensions="2" Radix="Decimal">
<Data Format="L5K"><![CDATA[[7,-2]]]></Data>
</Tag>
<Tag Name="Table" TagType="Base" DataType="MESSAGE">
<Data Format="Message"><MessageParameters MessageType="CIP Data Table Read" RemoteElement="Peer" ConnectionPath="EN2T, 2, 10.0.0.6"/></Data>
</Tag>
</Tags>
<Programs><Program Name="Main"><Routines>
<Routine Name="Send" Type="RLL"><RLLContent>
<Rung Number="0" Type="N"><Text><![CDATA[XIC(go)MOV(5000000,readcurrent.UnconnectedTimeout)MOV(2500000,ReadCurrent.ConnectionRate)MSG(ReadCurrent);]]></Text></Rung>
<Rung Number="1" Type="N"><Text><![CDATA[XIC(go)MOV(Speed,WriteRamp.UnconnectedTimeout)MOV(9,WriteRamp.Instance)MSG(WriteRamp);]]></Text></Rung>
<Rung Number="2" Type="N"><Text><![CDATA[XIC(a)OTE(b);]]></Text></Rung>
</RLLContent></Routine>
</Routines></Program></Programs>
</Controller>
</RSLogix5000Content>
"#;

#[test]
fn the_generic_messages_of_a_whole_project_are_read() {
    let read = import(PROJECT);
    let messages: Vec<&MsgCipGeneric> =
        read.blocks.iter().map(|found| found.config.as_msg().unwrap()).collect();
    let [current, ramp] = messages.as_slice() else { panic!("{read:?}") };
    let app = &current.app_cfg;
    assert_eq!((app.service, app.class, app.instance, app.attribute), (14, 147, 3, 9));
    let target = &current.target_cfg;
    assert_eq!((target.path.as_str(), target.cip_conn_mode, target.conn_close), ("4,10.0.0.5", 1, false));
    assert_eq!((target.ucmm_timeout, target.conn_msg_timeout, current.res_data_size), (5_000, 10_000, 12));
    assert_eq!((ramp.target_cfg.path.as_str(), ramp.req_data.as_str()), ("4,10.0.0.7", "feffffff"));
    assert_eq!(ramp.target_cfg.ucmm_timeout, 30_000);
    let said: Vec<String> = read.blocks[1].remarks.iter().map(ToString::to_string).collect();
    for part in [
        "Drive7 is a module",
        "UnconnectedTimeout is not a constant",
        "changes WriteRamp.Instance to 9",
        "Nowhere",
    ] {
        assert!(said.iter().any(|remark| remark.contains(part)), "{part}: {said:?}");
    }
    let told: Vec<(usize, Severity)> =
        read.remarks.iter().map(|remark| (remark.line, remark.severity)).collect();
    assert_eq!(told, [(23, Severity::Error), (2, Severity::Note)], "{:?}", read.remarks);
}

#[test]
fn names_do_not_break_out() {
    for name in [
        "]]></Comment></Rung>",
        "</Tag><Tag Name=\"x\"/>",
        "\" a=\"",
        "'; DROP",
        "--><!--",
        "a\nb\u{0}🦀",
        "*)",
    ] {
        let mut config = write_speed();
        config.name = name.into();
        let code = export(&config.clone().into(), &[]);
        let found = only(&code.text);
        assert_eq!(request(&found.config), request(&config.into()), "{name}");
    }
}

#[test]
fn what_is_no_document_is_told_with_its_place() {
    for (text, line, part) in [
        ("<a>\n<b></a>", 2, "not XML"),
        ("<?xml version=\"1.0\"?>\n<!DOCTYPE a [<!ENTITY x \"y\">]>\n<a>&x;</a>", 2, "DTD"),
        ("<a/>", 1, "no tag of type MESSAGE"),
    ] {
        let read = import(text);
        assert_eq!((read.blocks.len(), read.remarks[0].line), (0, line), "{text}: {:?}", read.remarks);
        assert!(read.remarks[0].to_string().contains(part), "{}", read.remarks[0]);
    }
    let many = alloc::format!("<a>{}</a>", "<b/>".repeat(120_000));
    assert!(
        matches!(&import(&many).remarks[0].what, RemarkKind::Told(words) if words.contains("100000 nodes"))
    );
    let deep = alloc::format!("{}{}", "<a>".repeat(90_000), "</a>".repeat(90_000));
    assert_eq!(import(&deep).blocks, []);
}

/// A document around tags, programs and modules.
fn document(modules: &str, tags: &str, programs: &str) -> String {
    alloc::format!(
        "<RSLogix5000Content><Controller Name=\"Line4\"><Modules>{modules}</Modules><Tags>{tags}</Tags>\
         <Programs>{programs}</Programs></Controller></RSLogix5000Content>"
    )
}

fn generic(name: &str, attributes: &str) -> String {
    alloc::format!(
        "<Tag Name=\"{name}\" DataType=\"MESSAGE\"><Data Format=\"Message\"><MessageParameters MessageType=\"CIP Generic\" \
         ServiceCode=\"16#000e\" ObjectType=\"16#0001\" TargetObject=\"1\" AttributeNumber=\"16#0007\" {attributes}/></Data></Tag>"
    )
}

fn said(found: &Found) -> Vec<String> {
    found.remarks.iter().map(ToString::to_string).collect()
}

#[test]
fn a_name_belongs_to_its_program() {
    let direct =
        |name| generic(name, "RequestedLength=\"0\" ConnectedFlag=\"2\" ConnectionPath=\"2, 10.0.0.1\"");
    let program = |name: &str, tags: &str, routine: &str| {
        alloc::format!("<Program Name=\"{name}\"><Tags>{tags}</Tags><Routines>{routine}</Routines></Program>")
    };
    let rung = |text: &str| {
        alloc::format!(
            "<Routine Type=\"RLL\"><RLLContent><Rung><Text>{text}</Text></Rung></RLLContent></Routine>"
        )
    };
    let st = "<Routine Type=\"ST\"><STContent><Line>(* M.UnconnectedTimeout := 9000000;</Line>\
              <Line>M.UnconnectedTimeout := 8000000; *) // M.UnconnectedTimeout := 7000000;</Line>\
              <Line>IF go THEN M.UnconnectedTimeout :=</Line><Line> 2000000; MSG(M); END_IF;</Line></STContent></Routine>";
    let text = document(
        "",
        &direct("M"),
        &[
            program("P1", &direct("M"), &rung("MOV(1000000,M.UnconnectedTimeout)XIO(M.EN)MSG(M);")),
            program("P2", &direct("M"), st),
            program("P3", "", &rung("MOV(3000000,M.UnconnectedTimeout)Drive(Instance,M,Other);")),
        ]
        .concat(),
    );
    let aoi = "<AddOnInstructionDefinition Name=\"Drive\"><Routines><Routine Type=\"RLL\"><RLLContent><Rung><Text>\
               MOV(6000000,M.UnconnectedTimeout)MSG(M);</Text></Rung></RLLContent></Routine></Routines></AddOnInstructionDefinition>";
    let read = import(&text.replace("<Programs>", &alloc::format!("{aoi}<Programs>")));
    let timing: Vec<(i64, i64)> = read
        .blocks
        .iter()
        .map(|found| found.config.as_msg().unwrap())
        .map(|config| (config.target_cfg.ucmm_timeout, config.ctrl_cfg.trigger_type))
        .collect();
    assert_eq!(timing, [(3_000, 0), (1_000, 1), (2_000, 0)]);
    let said: Vec<Vec<String>> = read.blocks.iter().map(said).collect();
    assert!(said[0].len() == 1 && said[0][0].contains("M is given to DRIVE"), "{said:?}");
    assert_eq!((&said[1], &said[2]), (&Vec::new(), &Vec::new()));
}

#[test]
fn a_path_goes_by_way_of_the_projects_modules() {
    let module = |name: &str, parent: &str, port: &str, ports: &str| {
        alloc::format!(
            "<Module Name=\"{name}\" ParentModule=\"{parent}\" ParentModPortId=\"{port}\"><Ports>{ports}</Ports></Module>"
        )
    };
    let up = |kind: &str, address: &str| {
        alloc::format!("<Port Id=\"1\" Type=\"{kind}\" Address=\"{address}\" Upstream=\"true\"/>")
    };
    let modules = [
        module("Local", "Local", "1", "<Port Id=\"1\" Type=\"ICP\" Address=\"0\" Upstream=\"false\"/>"),
        module("EN2T", "Local", "1", &up("ICP", "3")),
        module("Remote", "EN2T", "2", &up("Ethernet", "10.0.0.9")),
        module("Analog", "Remote", "1", &up("ICP", "4")),
        module("Second", "Remote", "1", &up("ICP", "5")),
        module("Drive", "Second", "2", &up("Ethernet", "10.1.0.7")),
    ]
    .concat();
    for (path, expected) in [
        ("Remote", "4,10.0.0.9"),
        ("remote, 1, 2", "4,10.0.0.9,1,2"),
        ("Analog", "4,10.0.0.9,1,4"),
        ("Drive", "4,10.0.0.9,1,5,2,10.1.0.7"),
        ("EN2T, 2, 10.0.0.5", "4,10.0.0.5"),
        ("Unknown, 2, 10.0.0.5", "4,10.0.0.5"),
        ("EN2T", ""),
        ("EN2T, 1, 0", ""),
    ] {
        let attributes = alloc::format!("RequestedLength=\"0\" ConnectionPath=\"{path}\"");
        let read = import(&document(&modules, &generic("M", &attributes), ""));
        let found = &read.blocks[0];
        assert_eq!(found.config.as_msg().unwrap().target_cfg.path, expected, "{path}");
        let severity = if expected.is_empty() { Severity::Error } else { Severity::Warning };
        assert_eq!(found.remarks[0].severity, severity, "{path}: {:?}", found.remarks);
    }
    let ring = module("A", "B", "1", &up("ICP", "1")) + &module("B", "A", "1", &up("ICP", "2"));
    let read = import(&document(&ring, &generic("M", "RequestedLength=\"0\" ConnectionPath=\"A\""), ""));
    assert_eq!(read.blocks[0].config.as_msg().unwrap().target_cfg.path, "");
}

#[test]
fn data_of_aliases_and_members_is_read() {
    let tags = "<Tag Name=\"Cmd\" DataType=\"Command\"><Data Format=\"Decorated\"><Structure DataType=\"Command\">\
                <DataValueMember Name=\"Speed\" DataType=\"INT\" Value=\"-2\"/><ArrayMember Name=\"Bytes\" DataType=\"SINT\" \
                Dimensions=\"3\"><Element Index=\"[0]\" Value=\"16#0a\"/><Element Index=\"[1]\" Value=\"16#ff\"/>\
                <Element Index=\"[2]\" Value=\"7\"/></ArrayMember></Structure></Data></Tag>\
                <Tag Name=\"Short\" TagType=\"Alias\" AliasFor=\"Cmd.Bytes\"/>\
                <Tag Name=\"Round\" TagType=\"Alias\" AliasFor=\"Round\"/>";
    for (source, length, data) in [
        ("Cmd.Bytes[1]", 2, Some("ff07")),
        ("cmd.speed", 2, Some("feff")),
        ("Short[0]", 3, Some("0aff07")),
        ("Short[2]", 2, None),
        ("Cmd", 5, None),
        ("Cmd.Colour", 1, None),
        ("Round", 1, None),
    ] {
        let attributes = alloc::format!(
            "RequestedLength=\"{length}\" ConnectedFlag=\"2\" ConnectionPath=\"2, 10.0.0.1\" LocalElement=\"{source}\" \
             DestinationTag=\"Short[1]\""
        );
        let read = import(&document("", &(generic("M", &attributes) + tags), ""));
        let config = read.blocks[0].config.as_msg().unwrap();
        assert_eq!(config.req_data, data.unwrap_or_default(), "{source}");
        assert_eq!(config.res_data_size, 2);
        let told = said(&read.blocks[0]).iter().any(|remark| remark.contains("is not known"));
        assert_eq!(told, data.is_none(), "{source}: {:?}", read.blocks[0].remarks);
    }
}

#[test]
fn a_description_shows_what_the_export_sends() {
    let mut config = write_speed();
    (config.app_cfg.member_cnt, config.app_cfg.member_id[0]) = (1, 3);
    let text = export(&config.clone().into(), &[]).text;
    assert!(text.contains("; request 10 04 21 00 74 03 25 00 12 01 0A FF D2]]>"), "{text}");
    config.app_cfg.instance = 70_000;
    assert!(export(&config.into(), &[]).text.contains("; request is not the block's]]>"));
}

#[test]
fn what_is_protected_is_told() {
    let message = generic("M", "RequestedLength=\"0\" ConnectedFlag=\"2\" ConnectionPath=\"2, 10.0.0.1\"");
    let read =
        import(&document("", &message, "<EncodedData EncodedType=\"Routine\" Name=\"R\">0aBc</EncodedData>"));
    assert!(read.remarks.iter().any(|remark| remark.to_string().contains("1 protected parts")));
}
