use alloc::format;
use alloc::string::String;
use alloc::vec::Vec;

use super::*;

/// `first line: dialect: first words`
fn told(text: &str) -> Vec<String> {
    let told = pieces(text, None).into_iter().map(|piece| {
        let form = match piece.form {
            Form::Parameters => "table".into(),
            Form::Code(dialect) => format!("{dialect}"),
        };
        let lines: Vec<&str> = piece.text.lines().map(str::trim).filter(|line| !line.is_empty()).collect();
        format!("{} {form}: {}", piece.first_line, lines.join(" | "))
    });
    told.collect()
}

#[test]
fn a_text_is_cut_where_its_dialect_changes() {
    let text = r#"{"name": "a",
  "kind": "MSG_CIPGENERIC"
}
[
  {"name": "b"}
]
<?xml version="1.0"?>
<RSLogix5000Content>
  <Tag/>
0E 03 20 01
</RSLogix5000Content>
# a request
0E 03 20 01 24 01 30 07
0e 01 20 01 24 01

$ cipdeck send 4,10.0.0.1 --service 14 \
  --class 1
from pycomm3 import CIPDriver
with CIPDriver('10.0.0.1') as plc:
    reply = plc.generic_message(
        service=0x0E,
)
// of Rust
use rseip::client::ab_eip::*;
#[tokio::main]
async fn main() {
    let x = 1;
}
(* ST
0E 03 20 01 *)
m(IN := TRUE, AppCfg := a);
hello
"#;
    assert_eq!(
        told(text),
        [
            r#"1 json: {"name": "a", | "kind": "MSG_CIPGENERIC" | }"#,
            r#"4 json: [ | {"name": "b"} | ]"#,
            r#"7 l5x: <?xml version="1.0"?> | <RSLogix5000Content> | <Tag/> | 0E 03 20 01 | </RSLogix5000Content>"#,
            "12 hex: # a request | 0E 03 20 01 24 01 30 07 | 0e 01 20 01 24 01",
            "16 cli: $ cipdeck send 4,10.0.0.1 --service 14 \\ | --class 1",
            "18 pycomm3: from pycomm3 import CIPDriver | with CIPDriver('10.0.0.1') as plc: | reply = \
             plc.generic_message( | service=0x0E, | )",
            "23 rust: // of Rust | use rseip::client::ab_eip::*; | #[tokio::main] | async fn main() { | let x = 1; | }",
            "29 ccw-st: (* ST | 0E 03 20 01 *) | m(IN := TRUE, AppCfg := a); | hello",
        ]
    );
}

#[test]
fn structured_text_of_three_vendors_is_told_apart_by_its_calls() {
    let text = "VAR
  m1 : MSG_CIPGENERIC; app : CIPAPPCFG;
  words : ARRAY[0..4] OF INT := [16#0000,
    16#030E, 16#0120];
  u1 : CIPUCMMSend;
END_VAR
app.Class := 1;
m1(start, c, app, t, q, 0, r);
tab[3] := 10;
SEND_REQ(ADDR('0.2.0.10.0.0.1'), 16#0E, words, tab, answer);
path.ClassID := 1;
u1(Execute := start, RqPath := path);
done := u1.Done;
";
    assert_eq!(
        told(text),
        [
            "1 ccw-st: m1 : MSG_CIPGENERIC; app : CIPAPPCFG; | app.Class := 1; | m1(start, c, app, t, q, 0, r);",
            "1 send-req-etc100: words : ARRAY[0..4] OF INT := [16#0000, | 16#030E, 16#0120]; | tab[3] := 10; | \
             SEND_REQ(ADDR('0.2.0.10.0.0.1'), 16#0E, words, tab, answer);",
            "1 sysmac-st: u1 : CIPUCMMSend; | path.ClassID := 1; | u1(Execute := start, RqPath := path); | done := \
             u1.Done;",
        ]
    );
}

#[test]
fn comments_and_assignments_with_a_comment_are_no_rows_of_a_table() {
    let text = "(* status: service 14 *)\napp.MemberCnt := 1;\napp.MemberId[0] := 1; (* 16#01 *)\nm(IN := start, AppCfg := app);\n";
    let lines = "(* status: service 14 *) | app.MemberCnt := 1; | app.MemberId[0] := 1; (* 16#01 *) | m(IN := start, AppCfg := app);";
    assert_eq!(told(text), [format!("1 ccw-st: {lines}")]);
}

#[test]
fn instruction_list_is_control_experts() {
    let text = "words : ARRAY[0..4] OF INT;\nLD ADDR('0.2.0.10.0.0.1')\nSEND_REQ 16#0E, words, tab, answer\n";
    assert_eq!(told(text).len(), 1);
    assert!(told(text)[0].starts_with("1 send-req-etc100: words"), "{:?}", told(text));
}

#[test]
fn a_bracket_that_nobody_closes_does_not_take_everything() {
    let text = "m(IN := start,\n{\"name\": 1}\n<a>\n{\n";
    let forms: Vec<String> = told(text).into_iter().map(|it| it.split(':').next().unwrap().into()).collect();
    assert_eq!(forms, ["1 ccw-st", "2 json", "3 l5x"]);
}
