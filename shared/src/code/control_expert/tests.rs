//! The requests of the documents, in both directions.

use super::{export, import};
use crate::code::{Dialect, Found, Grade, Imported, Language};
use crate::config::{BlockConfig, SendReq, SendReqForm, read_words};
use crate::plan::{MessagePlan, Severity};
use alloc::string::{String, ToString};
use alloc::vec::Vec;

/// Requests that the documents' layouts give: the first to an identity object, the others a read of ten Modbus registers
/// of 192.168.1.102.
const GOLDEN: [(&str, &str, i64, SendReqForm, &str); 4] = [
    ("ETC 100: product name", "0000 030E 0120 0124 0730", 10, SendReqForm::Etc100, "0e03200124013007"),
    (
        "ETC 101: registers",
        "0000 C0A8 0166 024E 4420 0124 0000 000A",
        16,
        SendReqForm::Etc101,
        "4e022044240100000a00",
    ),
    ("ETC 100: registers", "0000 024E 4420 0124 0000 000A", 12, SendReqForm::Etc100, "4e022044240100000a00"),
    ("DATA_EXCH: registers", "024E 4420 0124 0000 000A", 10, SendReqForm::DataExch, "4e022044240100000a00"),
];

fn golden(index: usize) -> SendReq {
    let (name, words, length, form, _) = GOLDEN[index];
    let mut config = SendReq::new(form, name);
    config.address = match form {
        SendReqForm::Etc100 => "ADDR('0.2.0.192.168.1.102')",
        SendReqForm::Etc101 => "ADDR('0.2.0')",
        SendReqForm::DataExch => "ADDMX('0.3.0{192.168.1.102}UNC.CIP')",
    }
    .into();
    config.data_to_send = words.into();
    config.management_param = alloc::vec![0, 0, 30, length];
    config
}

fn read(text: &str) -> Imported {
    import(text, Dialect::SendReqEtc100)
}

fn only(text: &str) -> Found {
    let mut imported = read(text);
    assert_eq!(imported.blocks.len(), 1, "{text}\n{imported:?}");
    assert!(
        imported.remarks.iter().all(|remark| remark.severity == Severity::Note),
        "{:?}",
        imported.remarks
    );
    imported.blocks.remove(0)
}

fn request(config: &BlockConfig) -> (Vec<u8>, String, u32, bool) {
    let plan = MessagePlan::of(config).0.unwrap();
    (plan.bytes().to_vec(), plan.target().to_string(), plan.ucmm_timeout_ms(), plan.connection().is_some())
}

fn texts(found: &Found) -> String {
    let said: Vec<String> = found.remarks.iter().map(ToString::to_string).collect();
    said.join("\n")
}

#[test]
fn pasted_words_make_the_right_block() {
    for (title, words, length, form, message) in GOLDEN {
        let row = alloc::format!("| {title} | {words} | {length} |");
        let marked = words.replace(' ', ", 16#");
        for text in [
            words.to_string(),
            alloc::format!("{words} {length}"),
            alloc::format!("(* a comment *) 16#{marked}\n"),
            words.replace(' ', "\n"),
            row,
        ] {
            let found = only(&text);
            let config = found.config.as_send_req().unwrap();
            assert_eq!((config.form(), config.data_to_send.as_str()), (form, words), "{text}");
            assert_eq!(config.management_param, [0, 0, 30, length], "{text}");
            let plan = MessagePlan::of(&found.config).0.unwrap();
            assert_eq!(crate::config::write_hex(plan.bytes()), message);
            assert!(texts(&found).contains("recognised as"), "{}", texts(&found));
        }
    }
}

#[test]
fn several_pasted_requests_are_several_blocks() {
    let rows = GOLDEN.map(|(title, words, ..)| alloc::format!("{title}\t{words}")).join("\n");
    let imported = read(&alloc::format!("| Case | Words |\n|---|---|\n{rows}\n0000 0BAD\n"));
    assert_eq!(imported.blocks.len(), 4);
    let forms: Vec<SendReqForm> =
        imported.blocks.iter().map(|it| it.config.as_send_req().unwrap().form()).collect();
    assert_eq!(forms, GOLDEN.map(|(_, _, _, form, _)| form));
    assert_eq!(imported.blocks[2].config.name(), "ETC 100: registers");
    let told: Vec<(usize, Severity)> = imported.remarks.iter().map(|it| (it.line, it.severity)).collect();
    assert_eq!(told, [(1, Severity::Note), (7, Severity::Error)]);
}

#[test]
fn a_section_says_all_of_a_request_in_both_languages() {
    for (index, (_, words, ..)) in GOLDEN.into_iter().enumerate() {
        for language in [Language::St, Language::Il] {
            let block = BlockConfig::from(golden(index));
            let code = export(&block, language, &[]);
            assert!(code.changes.iter().all(|change| change.grade == Grade::Carried), "{:?}", code.changes);
            let words = read_words(words).unwrap();
            for word in words {
                assert!(code.text.contains(&alloc::format!("16#{word:04X}")), "{}", code.text);
            }
            let found = only(&code.text);
            let (was, is) = (block.as_send_req().unwrap(), found.config.as_send_req().unwrap());
            assert_eq!(request(&found.config), request(&block), "{}", code.text);
            let same = |config: &SendReq| {
                (config.data_to_send.clone(), config.management_param.clone(), config.address.clone())
            };
            assert_eq!(same(is), same(was));
            assert_eq!((is.form(), is.received_data_size), (was.form(), was.received_data_size));
            assert_eq!(texts(&found).lines().count(), 1, "{}", texts(&found));
        }
    }
}

#[test]
fn the_section_tests_the_activity_bit_and_reads_the_reports_when_it_falls() {
    let mut config = golden(0);
    config.name = "*) drive's (* \n current".into();
    config.management_param[2] = 0;
    let st = export(&config.clone().into(), Language::St, &[]).text;
    for part in [
        "(* * ) drive's ( *   current, SEND_REQ for TSX ETC 100 *)",
        "IF drive_s_current_Start AND NOT drive_s_current_Last AND NOT drive_s_current_Mgmt[0].0 THEN",
        "drive_s_current_Send[1] := 16#030E;  (* 782: service 16#0E = 14 Get_Attribute_Single, path of 3 words *)",
        "drive_s_current_Mgmt[2] := 0;  (* 16#0000: waits FOR EVER *)",
        "SEND_REQ(drive_s_current_Adr, 16#000E, drive_s_current_Send, drive_s_current_Mgmt, drive_s_current_Recv);",
        // Refused at once, the activity bit never rises: the reports are read all the same.
        "drive_s_current_Mgmt, drive_s_current_Recv);\n    drive_s_current_Busy := TRUE;",
        "drive_s_current_Report := drive_s_current_Mgmt[1];",
    ] {
        assert!(st.contains(part), "{part}\n{st}");
    }
    let il = export(&config.into(), Language::Il, &[]).text;
    assert!(il.contains("    LD drive_s_current_Adr\n    SEND_REQ 16#000E, drive_s_current_Send, "), "{il}");
    assert!(
        il.contains("_Recv\n    LD TRUE  (*") && il.contains("*)\n    ST drive_s_current_Busy\n"),
        "{il}"
    );
}

#[test]
fn decimals_are_those_of_an_int_and_what_is_not_sent_is_said() {
    let mut config = golden(1);
    config.data_to_send.push_str(" FFA3 0001");
    config.management_param[2] = 40_000;
    config.management_param[3] += 1;
    let st = export(&config.into(), Language::St, &[]).text;
    for part in [
        "_Send[1] := 16#C0A8;  (* -16216: IP address 192.168 *)",
        "_Send[8] := 16#FFA3;  (* -93: byte 16#A3 = 163; the high byte is not sent *)",
        "_Send[9] := 16#0001;  (* 1: not sent *)",
        "_Mgmt[2] := 16#9C40;  (* 16#9C40: 4000000 ms *)",
        "INT := [0, 0, 16#9C40, 17]",
    ] {
        assert!(st.contains(part), "{part}\n{st}");
    }
}

#[test]
fn hand_written_sections_are_read() {
    let st = "(* lecture *)\nTab_Emis : ARRAY [0..4] OF INT := [0, 16#030E, 288, 2#1_0010_0100, 16#0730];\nTab_Gest : ARRAY [0.3] OF INT;\n\
              Tab_Recp : ARRAY [0..99] OF INT;\nIF NOT Tab_Gest[1].0 THEN\n  Tab_Gest[2] := 20;\n  Tab_Gest[3] := 10;\n\
              SEND_REQ (ADDR(‘0.2.0.192.168.1.102’), 14, Tab_Emis, Tab_Gest, Tab_Recp);\nEND_IF;\n";
    let imported = read(st);
    let config = imported.blocks[0].config.as_send_req().unwrap();
    assert_eq!(config.data_to_send, GOLDEN[0].1);
    assert_eq!(
        (config.address.as_str(), config.management_param.as_slice()),
        ("ADDR('0.2.0.192.168.1.102')", &[0, 0, 20, 10][..])
    );
    assert_eq!((config.received_data_size, config.name.as_str()), (100, "Tab"));
    let told: Vec<(usize, bool)> =
        imported.remarks.iter().map(|it| (it.line, it.to_string().contains("printed manual"))).collect();
    assert!(told.contains(&(3, true)) && told.contains(&(5, true)), "{:?}", imported.remarks);

    let mw = "%MW100 := 16#024E;\n%MW101 := 16#4420;\n%MW102 := 16#0124;\n%MW103 := 0;\n%MW104 := 10;\n%MW202 := 5;\n%MW203 := 10;\n\
              DATA_EXCH(ADR := ADDMX('0.3.0{10.0.0.5}CON.CIP'), TYP := 1, EMIS := %MW100:5, GEST := %MW200:4, RECP => %MW300:60);\n";
    let found = only(mw);
    let config = found.config.as_send_req().unwrap();
    assert_eq!((config.form(), config.data_to_send.as_str()), (SendReqForm::DataExch, GOLDEN[3].1));
    assert_eq!((config.management_param.as_slice(), config.received_data_size), (&[0, 0, 5, 10][..], 60));
    assert!(MessagePlan::of(&found.config).0.unwrap().connection().is_some());
    assert_eq!(found.lines, 1..9);
}

#[test]
fn what_is_not_known_of_a_call_is_told() {
    let found = only("SEND_REQ(Adr, 14, Words, Mgmt, Recv);\n");
    for part in [
        "a constant Address is missing",
        "nothing is known of the words of Words",
        "it waits for ever",
        "size of Recv",
    ] {
        assert!(texts(&found).contains(part), "{part}: {}", texts(&found));
    }
    let made =
        only("S[0] := 0;\nS[1] := Speed;\nG[3] := 4;\nSEND_REQ(ADDR('0.2.0.10.0.0.1'), 14, S, G, R);\n");
    assert!(texts(&made).contains("S[1] is not a constant"), "{}", texts(&made));
    assert!(MessagePlan::of(&made.config).0.is_none());
}

#[test]
fn a_table_without_a_call_is_read_if_it_is_a_request() {
    let found =
        only("Data_to_Send : ARRAY [0..4] OF INT := [16#0000, 16#030E, 16#0120, 16#0124, 16#0730];\n");
    assert_eq!(found.config.as_send_req().unwrap().data_to_send, GOLDEN[0].1);
    assert!(texts(&found).contains("no call uses these words"));
    let found = only("%MW10 := 16#024E;\n%MW11 := 16#4420;\n%MW12 := 16#0124;\n%MW13 := 0;\n%MW14 := 10;\n");
    assert_eq!(found.config.as_send_req().unwrap().form(), SendReqForm::DataExch);
}

#[test]
fn any_text_ends() {
    for text in [
        "",
        "(*",
        "SEND_REQ(",
        "SEND_REQ(((((",
        "%MW",
        "%MW99999999999999999999 := 1;",
        "%MW18446744073709551615 := 1;\nSEND_REQ(a, 1, %MW18446744073709551615:2, %MW1:4, %MW2:1);",
        "LD\nST",
        "|||",
        "a := a;\nSEND_REQ(a, a, a, a, a);",
    ] {
        assert!(read(text).remarks.len() + read(text).blocks.len() > 0, "{text}");
    }
    let many = "0000 030E 0120 0124 0730\n".repeat(2_000);
    assert_eq!(read(&many).blocks.len(), 2_000);
}

#[test]
fn words_on_memory_words_have_two_names() {
    let declared = "VAR Req AT %MW100 : ARRAY[1..5] OF INT := [16#030E, 16#0120]; Mgt AT %MW200 : ARRAY[0..3] OF INT; END_VAR\n";
    for program in [
        // By name set, by word sent.
        "Req[3] := 16#0124; Req[4] := 16#0730; Mgt[2] := 50; Mgt[3] := 8;\nDATA_EXCH(ADDMX('0.0.3{10.0.0.6}UNC.CIP'), 1, %MW100:4, %MW200:4, %MW300:50);",
        // By word set, by name sent.
        "%MW102 := 16#0124; %MW103 := 16#0730; %MW202 := 50; %MW203 := 8;\nDATA_EXCH(ADDMX('0.0.3{10.0.0.6}UNC.CIP'), 1, Req, Mgt, %MW300:50);",
        // The last assignment counts, under whichever name.
        "Req[1] := 7; %MW100 := 16#030E; %MW102 := 16#0124; Req[4] := 16#0730; Mgt[2] := 50; Mgt[3] := 8;\nDATA_EXCH(ADDMX('0.0.3{10.0.0.6}UNC.CIP'), 1, Req, Mgt, %MW300:50);",
    ] {
        let read = import(&alloc::format!("{declared}{program}"), Dialect::DataExch);
        let [found] = read.blocks.as_slice() else { panic!("{program}: {:?}", read.remarks) };
        let config = found.config.as_send_req().unwrap();
        assert!(config.data_to_send.starts_with("030E 0120 0124 0730"), "{program}: {}", config.data_to_send);
        assert_eq!(config.management_param, [0, 0, 50, 8], "{program}");
        assert!(
            !read.remarks.iter().any(|it| it.to_string().contains("changes nothing")),
            "{:?}",
            read.remarks
        );
    }
}

/// As exchange files have it; names and values are ours.
fn exchange(sections: &str, variables: &str) -> String {
    alloc::format!(
        "<?xml version=\"1.0\" encoding=\"UTF-8\"?>\n<STExchangeFile>\n<fileHeader company=\"Schneider Automation\"/>\n\
         <program>\n<identProgram name=\"Read\" type=\"section\" task=\"MAST\"/>\n{sections}\n</program>\n\
         <dataBlock>{variables}</dataBlock>\n</STExchangeFile>\n"
    )
}

const WORDS: &str = "<variables name=\"Emis\" typeName=\"ARRAY[0..3] OF INT\"><instanceElementDesc name=\"[1]\"><value>16#0120</value>\
    </instanceElementDesc><instanceElementDesc name=\"[2]\"><value>292</value></instanceElementDesc>\
    <instanceElementDesc name=\"[3]\"><value>16#0730</value></instanceElementDesc></variables>\
    <variables name=\"Gest\" typeName=\"ARRAY[0..3] OF INT\" topologicalAddress=\"%MW200\"/>\
    <variables name=\"Recp\" typeName=\"ARRAY[0..99] OF INT\"/><variables name=\"Drive\" typeName=\"T_DRIVE\"/>";

#[test]
fn a_section_is_read_from_an_exchange_file() {
    let st = "<STSource>IF Go &amp; NOT Gest[0].0 THEN (* &lt;read&gt; *)\n  Emis[0] := 16#030E; %MW202 := 50; Gest[3] := 8;\n  Lamp := 1;\n\
              DATA_EXCH(ADR := ADDM('Ethernet_1{10.0.0.6}UNC.CIP'), TYP := 1, EMIS := Emis, GEST := Gest, RECP =&gt; Recp);\nEND_IF;</STSource>";
    let read = crate::code::import(&exchange(st, WORDS), None);
    let [found] = read.blocks.as_slice() else { panic!("{:?}", read.remarks) };
    let config = found.config.as_send_req().unwrap();
    assert_eq!((config.data_to_send.as_str(), config.received_data_size), ("030E 0120 0124 0730", 100));
    assert_eq!(config.management_param, [0, 0, 50, 8]);
    assert_eq!(
        (config.address.as_str(), found.dialect),
        ("ADDM('0.0.0{10.0.0.6}UNC.CIP')", Dialect::DataExch)
    );
    assert!(found.lines.contains(&9), "{:?}", found.lines);
    let said: Vec<String> = read.remarks.iter().chain(&found.remarks).map(ToString::to_string).collect();
    assert!(said[0].contains("other statements and conditions of this file are not read"), "{said:?}");
    assert!(
        said.iter().any(|it| it.starts_with("9:") && it.contains("where Ethernet_1 is connected")),
        "{said:?}"
    );
}

#[test]
fn a_drawn_block_is_a_call() {
    let pin = |name: &str, value: &str| {
        alloc::format!("<inputVariable formalParameter=\"{name}\" effectiveParameter=\"{value}\"/>")
    };
    let block = |name: &str, kind: &str, pins: &str| {
        alloc::format!(
            "<FFBBlock instanceName=\"{name}\" typeName=\"{kind}\"><descriptionFFB>{pins}</descriptionFFB></FFBBlock>"
        )
    };
    let drawn = [
        block(".1", "MOVE", &(pin("IN", "16#030E") + "<outputVariable formalParameter=\"OUT\" effectiveParameter=\"Emis[0]\"/>")),
        block(".2", "ADDMX", &(pin("IN", "'0.0.3{10.0.0.6}UNC.CIP'") + "<outputVariable formalParameter=\"OUT\"/>")),
        block(
            ".3",
            "DATA_EXCH",
            &[
                "<inputVariable formalParameter=\"EN\" effectiveParameter=\"Go\"/><inputVariable formalParameter=\"ADR\"/>",
                &pin("TYP", "1"),
                &pin("EMIS", "Emis"),
                &pin("GEST", "Gest"),
                "<outputVariable formalParameter=\"GEST\" effectiveParameter=\"Gest\"/>",
                "<outputVariable formalParameter=\"RECP\" effectiveParameter=\"Recp\"/>",
            ]
            .concat(),
        ),
        "<linkFB><linkSource parentObjectName=\".2\" pinName=\"OUT\"/><linkDestination parentObjectName=\".3\" pinName=\"ADR\"/></linkFB>"
            .into(),
    ]
    .concat();
    let read = crate::code::import(
        &exchange(&alloc::format!("<FBDSource><networkFBD>{drawn}</networkFBD></FBDSource>"), WORDS),
        None,
    );
    let [found] = read.blocks.as_slice() else { panic!("{:?}", read.remarks) };
    let config = found.config.as_send_req().unwrap();
    assert_eq!(
        (config.data_to_send.as_str(), config.address.as_str()),
        ("030E 0120 0124 0730", "ADDMX('0.0.3{10.0.0.6}UNC.CIP')")
    );
    assert!(found.remarks.iter().any(|it| it.to_string().contains("Management_Param[2] is not set")));
}

#[test]
fn a_file_without_an_exchange_is_told() {
    let read = crate::code::import(&exchange("<STSource>a := 5;</STSource>", ""), None);
    assert_eq!(read.blocks, []);
    assert!(read.remarks[0].to_string().contains("no call of SEND_REQ or DATA_EXCH"), "{:?}", read.remarks);
    let broken = crate::code::import("<STExchangeFile>\n<program></STExchangeFile>", None);
    assert!(broken.remarks[0].to_string().contains("not XML"), "{:?}", broken.remarks);
}

#[test]
fn what_would_reach_another_device_does_not_run() {
    let mut config = golden(0);
    config.address = "ADDR('0.2.0.192.168.1.102:44820')".into();
    let block = BlockConfig::from(config.clone());
    assert!(export(&block, Language::St, &[]).text.contains("IF FALSE AND "));
    let il = export(&block, Language::Il, &[]).text;
    assert!(il.contains("    LD FALSE\n    AND "), "{il}");
    config.address = "ADDR('0.2.0.192.168.1.102')".into();
    assert!(!export(&config.into(), Language::St, &[]).text.contains("FALSE AND"));
}
