use alloc::format;
use alloc::string::ToString;
use alloc::vec;

use serde_json::json;

use super::*;
use crate::config::{BlockConfig, MsgCipGeneric};

const BLOCK: &str = r#"{
  "name": "drive current",
  "kind": "MSG_CIPGENERIC",
  "Channel": "controller",
  "Resume": false,
  "CtrlCfg": {
    "Cancel": false,
    "TriggerType": 0,
    "StrMode": 0
  },
  "AppCfg": {
    "Service": 14,
    "Class": 1,
    "Instance": 1,
    "Attribute": 7,
    "MemberCnt": 0,
    "MemberId": [
      0,
      0,
      0
    ],
    "Extended": true
  },
  "TargetCfg": {
    "Path": "4,192.168.1.100",
    "CipConnMode": 0,
    "UcmmTimeout": 0,
    "ConnMsgTimeout": 0,
    "ConnClose": false
  },
  "ReqData": "",
  "ResDataSize": 490,
  "Colour": {
    "of": "the field",
    "rgb": [
      1.0,
      0.5
    ]
  },
  "ärger": 18446744073709551615
}
"#;

const TARGET: &str = r#"{
  "name": "NX 1",
  "site": "",
  "path": "4,10.0.0.1",
  "profile": "auto",
  "connection": "auto",
  "timeout_ms": 3000,
  "max_requests_per_s": 100,
  "types": {
    "Motor": "STRUCT{speed: REAL}"
  },
  "rack": "7b"
}
"#;

const GROUP: &str = r#"{
  "name": "line 4",
  "period_ms": 1000,
  "on": true,
  "order": 0,
  "variables": [
    {
      "parent_address": "Line[3]",
      "name": "speed",
      "address": "speed",
      "unit": "m/s",
      "writable": false,
      "min": 0.5,
      "order": 0,
      "note": "of the belt"
    },
    {
      "name": "Line 3",
      "address": "Line[3]",
      "type": "Motor",
      "writable": false,
      "order": 0
    }
  ],
  "shift": 2
}
"#;

fn folder(files: &[(&str, &str)]) -> BTreeMap<String, String> {
    let head = ("cipdeck.json", "{\"project\": 1, \"name\": \"plant\"}");
    [head].iter().chain(files).map(|(path, text)| (path.to_string(), text.to_string())).collect()
}

fn messages(errors: &[ProjectError]) -> Vec<String> {
    errors.iter().map(ToString::to_string).collect()
}

#[test]
fn what_is_read_is_written_as_it_was_with_all_that_nobody_knows() {
    let mut files_there = folder(&[
        ("blocks/drive.json", BLOCK),
        ("targets/nx-1.json", TARGET),
        ("groups/nx-1/line-4.json", GROUP),
    ]);
    let found = read(&files_there);
    assert_eq!(messages(&found.errors), Vec::<String>::new());
    assert_eq!(
        messages(&found.warnings),
        [
            "groups/nx-1/line-4.json:15:7: this version does not know the member `note`: it is kept, and does nothing",
            "groups/nx-1/line-4.json:25:3: this version does not know the member `shift`: it is kept, and does nothing",
            "targets/nx-1.json:12:3: this version does not know the member `rack`: it is kept, and does nothing",
        ]
    );
    assert_eq!((found.version, found.project.head.name.as_str()), (1, "plant"));
    files_there.insert(PROJECT_HEAD.into(), "{\n  \"project\": 1,\n  \"name\": \"plant\"\n}\n".into());
    assert_eq!(files(&found.project), files_there);
    assert_eq!(parents(&found.project.targets["nx-1"].groups["line-4"].variables), Ok(vec![Some(1), None]));
}

#[test]
fn members_may_stand_in_any_order_and_be_left_out() {
    let text = r#"{"Colour":"red","TargetCfg":{"Path":"0,0"},"AppCfg":{"Class":1,"Service":14,"Instance":1,"Attribute":7},"name":"x"}"#;
    let found = read(&folder(&[("blocks/Hand made.json", text)]));
    assert_eq!(messages(&found.errors), Vec::<String>::new());
    let mut expected = MsgCipGeneric::product_name("0,0");
    expected.name = "x".into();
    expected.extra.insert("Colour".into(), "red".into());
    expected.req_length = None;
    assert_eq!(found.project.blocks["Hand made"], BlockConfig::from(expected));
}

#[test]
fn loose_blocks_with_ids_are_version_0() {
    let text = BLOCK.replacen("{\n", "{\n  \"id\": \"b7\",\n  \"revision\": 3,\n", 1);
    let files_there: BTreeMap<_, _> = [("drive.json".to_string(), text.clone())].into();
    let found = read(&files_there);
    assert_eq!((found.version, messages(&found.errors)), (0, Vec::new()));
    assert_eq!(found.origins["drive"], "drive.json");
    assert_eq!(messages(&found.warnings), Vec::<String>::new());
    let written = files(&found.project);
    assert_eq!(written["blocks/drive.json"], BLOCK);
    assert_eq!(read(&written).version, 1);
    assert_eq!(block("drive.json", &text).map(|block| write_block(&block)), Ok(BLOCK.into()));
    // In a project they are told of.
    let found = read(&folder(&[("blocks/drive.json", &text)]));
    assert_eq!(found.warnings.len(), 2);
    assert_eq!(
        found.warnings[0].to_string(),
        "blocks/drive.json:2:3: the member `id` is given by the relay: it is not kept in a project"
    );
}

#[test]
#[expect(clippy::too_many_lines, reason = "a table")]
fn every_error_says_where_it_is() {
    let mut failed = Vec::new();
    let replaced = |text: &str, from: &str, to: &str| text.replacen(from, to, 1);
    for (path, text, expected) in [
        (
            "blocks/x.json",
            replaced(BLOCK, "14,", "\"14\","),
            "blocks/x.json:12:16: invalid type: string \"14\", expected i64",
        ),
        (
            "blocks/x.json",
            replaced(BLOCK, "1.0,", "1.0"),
            "blocks/x.json:37:7: this is not JSON: expected `,` or `]`",
        ),
        (
            "blocks/x.json",
            replaced(BLOCK, "    \"Class\": 1,\n", ""),
            "blocks/x.json:11:13: missing field `Class`",
        ),
        (
            "blocks/x.json",
            replaced(BLOCK, "  \"name\": \"drive current\",\n", ""),
            "blocks/x.json:1:1: missing field `name`",
        ),
        (
            "blocks/x.json",
            replaced(BLOCK, "      0,\n      0,", "      0,\n      0.5,"),
            "blocks/x.json:19:7: invalid type: floating point `0.5`, expected i64",
        ),
        (
            "blocks/x.json",
            replaced(BLOCK, "\"controller\"", "\"plc\""),
            "blocks/x.json:4:14: a channel is controller, controller2 to controller8, or monitor",
        ),
        (
            "blocks/x.json",
            replaced(BLOCK, "\"ärger\"", "\"ReqData\""),
            "blocks/x.json:40:3: the member `ReqData` is there twice",
        ),
        (
            "blocks/x.json",
            replaced(BLOCK, "18446744073709551615", "18446744073709551616"),
            "blocks/x.json:40:12: the number 18446744073709551616 is too big to be kept exactly; put it into quotes",
        ),
        ("blocks/x.json", "[1]".into(), "blocks/x.json:1:1: this has to be an object: { … }"),
        ("blocks/x.json", String::new(), "blocks/x.json:1:1: this is not JSON: EOF while parsing a value"),
        ("blocks/x.json", "[".repeat(200), "blocks/x.json:1:128: this is not JSON: recursion limit exceeded"),
        (
            "targets/nx-1.json",
            replaced(TARGET, "3000", "true"),
            "targets/nx-1.json:7:17: invalid type: boolean `true`, expected i64",
        ),
        (
            "targets/nx-1.json",
            replaced(TARGET, "\"connection\": \"auto\"", "\"connection\": \"never\""),
            "targets/nx-1.json:6:17: unknown variant `never`, expected one of `auto`, `unconnected`, `connected`",
        ),
        (
            "groups/nx-1/l.json",
            replaced(GROUP, "0.5", "\"a\""),
            "groups/nx-1/l.json:13:14: invalid type: string \"a\", expected f64",
        ),
        (
            "groups/nx-1/l.json",
            replaced(GROUP, "[\n    {", "{\n    \"x\": {")
                .replacen("],\n  \"shift", "},\n  \"shift", 1)
                .replacen("    {\n      \"name\": \"Line", "    \"y\": {\n      \"name\": \"Line", 1),
            "groups/nx-1/l.json:6:16: invalid type: map, expected a sequence",
        ),
        (
            "groups/nx-1/l.json",
            replaced(GROUP, "\"Line[3]\"", "\"Line[4]\""),
            "groups/nx-1/l.json:7:5: no variable of this group has the address `Line[4]`",
        ),
        (
            "groups/nx-1/l.json",
            replaced(
                GROUP,
                "\"name\": \"Line 3\"",
                "\"parent_address\": \"Line[3].speed\", \"name\": \"Line 3\"",
            ),
            "groups/nx-1/l.json:7:5: no variable of this group has the address `Line[3]`",
        ),
        (
            "groups/nx-2/l.json",
            GROUP.into(),
            "groups/nx-2/l.json: this is a group of the target `nx-2`, and there is no targets/nx-2.json",
        ),
        (
            "groups/l.json",
            GROUP.into(),
            "groups/l.json: there is nothing like that in a project: a group is in the folder of its target, groups/TARGET/NAME.json",
        ),
        (
            "blocks/a/b.json",
            BLOCK.into(),
            "blocks/a/b.json: there is nothing like that in a project: blocks and targets have no folders, and groups those of their targets",
        ),
        (
            "blocks/../x.json",
            BLOCK.into(),
            "blocks/../x.json: this is no path inside of a project: names separated by /, without . and .., \\ and :",
        ),
        ("/etc/x.json", BLOCK.into(), "/etc/x.json: this is no path"),
        ("blocks\\x.json", BLOCK.into(), "blocks\\x.json: this is no path"),
        ("C:/x.json", BLOCK.into(), "C:/x.json: this is no path"),
        ("blocks//x.json", BLOCK.into(), "blocks//x.json: this is no path"),
    ] {
        let mut there = folder(&[("targets/nx-1.json", TARGET)]);
        there.insert(path.into(), text);
        let errors = messages(&read(&there).errors);
        let first = errors.first().map(String::as_str).unwrap_or_default();
        let is_whole = errors.len() == 1 || path.starts_with("groups/nx-1");
        if !(first.starts_with(expected) && is_whole) {
            failed.push((expected, errors));
        }
    }
    assert!(failed.is_empty(), "{failed:#?}");
}

#[test]
fn all_errors_of_all_files_are_found_at_once() {
    let wrong = BLOCK.replace("14,", "\"14\",");
    let found = read(&folder(&[("blocks/a.json", "{"), ("blocks/b.json", &wrong), ("blocks/c.json", BLOCK)]));
    let files: Vec<_> = found.errors.iter().map(|error| error.file.as_str()).collect();
    assert_eq!(files, ["blocks/a.json", "blocks/b.json"]);
    assert_eq!(found.project.blocks.len(), 1);
}

#[test]
fn a_newer_project_is_refused_in_words_and_nothing_else_is_said() {
    let mut there = folder(&[("blocks/x.json", "{ of the future }")]);
    for (head, expected) in [
        (
            "{\"project\": 2}",
            "cipdeck.json:1:13: the project has version 2, this cipdeck knows 1: use a newer cipdeck",
        ),
        (
            "{\"project\": \"1\"}",
            "cipdeck.json:1:13: the member `project`, the version of the layout, has to be",
        ),
        (
            "{\n  \"name\": \"x\"\n}",
            "cipdeck.json:1:1: the member `project`, the version of the layout, has to be",
        ),
        ("{\"project\": 0}", "cipdeck.json:1:13: the member `project`"),
    ] {
        there.insert(PROJECT_HEAD.into(), head.into());
        let errors = messages(&read(&there).errors);
        assert!(errors.len() == 1 && errors[0].starts_with(expected), "{errors:?}");
    }
}

#[test]
fn what_is_no_file_of_the_project_is_left_alone() {
    let found = read(&folder(&[
        ("README.md", "# x"),
        (".git/config.json", "x"),
        ("blocks/.gitkeep", ""),
        ("package.json", "x"),
        ("blocks/notes.txt", "x"),
        ("doc/x.json", "x"),
    ]));
    assert_eq!(messages(&found.errors), Vec::<String>::new());
    assert_eq!(found.ignored, ["README.md", "blocks/notes.txt", "doc/x.json", "package.json"]);
}

#[test]
fn an_unknown_member_of_the_head_is_kept_and_told() {
    let mut there = folder(&[]);
    let head = "{\n  \"project\": 1,\n  \"name\": \"plant\",\n  \"Owner\": \"x\"\n}\n";
    there.insert(PROJECT_HEAD.into(), head.into());
    let found = read(&there);
    assert_eq!(
        messages(&found.warnings),
        ["cipdeck.json:4:3: this version does not know the member `Owner`: it is kept, and does nothing"]
    );
    assert_eq!(files(&found.project), there);
}

#[test]
fn names_that_are_there_twice_are_told() {
    let found = read(&folder(&[("blocks/a.json", BLOCK), ("blocks/b.json", BLOCK)]));
    let expected =
        "blocks/b.json: blocks/a.json has the same name; they can be told apart by their files alone";
    assert_eq!(
        (messages(&found.errors), messages(&found.warnings)),
        (Vec::new(), vec![expected.to_string()])
    );
    let found = read(&folder(&[("blocks/a.json", BLOCK), ("blocks/A.json", BLOCK)]));
    assert_eq!(
        messages(&found.errors),
        ["blocks/a.json: many file systems cannot tell this name from blocks/A.json: rename one of them"]
    );
}

#[test]
fn a_project_has_limits() {
    let many: BTreeMap<_, _> =
        (0..=MAX_PROJECT_FILES).map(|n| (format!("blocks/{n}.json"), String::new())).collect();
    assert_eq!(read(&many).errors[0].what, ProjectErrorKind::TooManyFiles);
    let long = " ".repeat(MAX_PROJECT_FILE + 1);
    assert_eq!(read(&folder(&[("blocks/a.json", &long)])).errors[0].what, ProjectErrorKind::FileTooLong);
}

/// `"a0": 1, "a1": 1, …`
fn members(count: usize) -> String {
    let all: Vec<_> = (0..count).map(|number| format!("\"a{number}\": 1, ")).collect();
    all.concat()
}

#[test]
fn of_a_file_with_very_much_wrong_the_beginning_is_told_and_how_much_there_is() {
    let twice = format!("{{{}\"name\": \"x\"}}", "\"a\": 1,\n".repeat(100_000));
    let unknown = members(100_000);
    let unknown = format!("{{{unknown}\"name\": \"NX\", \"path\": \"0,0\"}}");
    let lines = "{\"name\": 5, \"address\": \"a\"},\n".repeat(20_000);
    let lines =
        format!("{{\"name\": \"l\", \"variables\": [{lines}{{\"name\": \"a\", \"address\": \"a\"}}]}}");
    let found = read(&folder(&[
        ("blocks/twice.json", &twice),
        ("targets/unknown.json", &unknown),
        ("groups/unknown/lines.json", &lines),
    ]));
    let (errors, warnings) = (messages(&found.errors), messages(&found.warnings));
    assert_eq!((errors.len(), warnings.len()), (202, 101));
    for (told, expected) in [
        (&errors[0], "blocks/twice.json:2:1: the member `a` is there twice"),
        (&errors[100], "blocks/twice.json:101:1: and 99899 more in this file"),
        (&errors[101], "groups/unknown/lines.json:1:38: invalid type: integer `5`, expected a string"),
        (&errors[201], "groups/unknown/lines.json:100:10: and 19900 more in this file"),
        (
            &warnings[0],
            "targets/unknown.json:1:2: this version does not know the member `a0`: it is kept, and does nothing",
        ),
    ] {
        assert_eq!(told, expected);
    }
    assert!(warnings[100].ends_with(": and 99900 more in this file"), "{}", warnings[100]);
}

#[test]
fn the_search_for_one_wrong_member_among_very_many_ends() {
    let many = members(100_000);
    let text = BLOCK.replacen('{', &format!("{{ {many}"), 1).replace("14,", "\"14\",");
    let errors = block("x.json", &text).unwrap_err();
    assert!(messages(&errors)[0].ends_with("invalid type: string \"14\", expected i64"), "{errors:?}");
}

#[test]
fn a_member_is_located_also_if_only_what_it_is_in_is_there() {
    let places = Places::of(BLOCK).unwrap();
    for (field, line, column) in [
        ("AppCfg.Service", 12, 16),
        ("AppCfg.MemberId[1]", 19, 7),
        ("AppCfg.Nothing", 11, 13),
        ("Nothing", 1, 1),
    ] {
        assert_eq!(places.locate(field), Position { line, column }, "{field}");
    }
    assert_eq!(Places::of(GROUP).unwrap().locate("variables[1].address").line, 19);
    assert!(Places::of("{").is_none());
}

#[test]
fn members_that_are_known_are_those_that_are_read() {
    let found = read(&folder(&[("targets/nx-1.json", TARGET), ("groups/nx-1/a.json", GROUP)]));
    let target = &found.project.targets["nx-1"];
    assert_eq!(target.extra.keys().collect::<Vec<_>>(), ["rack"]);
    let group = &target.groups["a"];
    assert_eq!(group.extra["shift"], json!(2));
    assert_eq!(group.variables[0].extra["note"], json!("of the belt"));
    // Each member that can be written is one that is known: nothing is told of a file that we have written.
    let mut full = ProjectVariable::default();
    let text = r#"{"name":"a","address":"a","type":"INT","scale":{"factor":0.1,"offset":-5.0},"unit":"C","digits":1,"display":"hex","choices":[{"value":3,"text":"on"}],"writable":true,"min":0.0,"max":99.5,"order":2}"#;
    full.config = serde_json::from_str(text).unwrap();
    let mut project = found.project.clone();
    let group = project.targets.get_mut("nx-1").unwrap().groups.get_mut("a").unwrap();
    group.variables.push(full);
    let again = read(&files(&project));
    assert_eq!(again.warnings.len(), found.warnings.len());
    assert_eq!(again.project, project);
}
