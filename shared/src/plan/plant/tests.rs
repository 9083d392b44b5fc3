use alloc::string::ToString;
use alloc::vec;

use super::*;
use crate::config::{Choice, GroupId, NewVariable, Variable, VariableId};
use crate::tag::{Display, Scale};

fn variable_of(id: u32, parent: Option<u32>, name: &str, address: &str, kind: &str) -> Variable {
    let config = VariableConfig {
        parent: parent.map(VariableId),
        kind: kind.into(),
        ..VariableConfig::new(name, address)
    };
    Variable { id: VariableId(id), revision: 1, group: GroupId(1), config }
}

fn fields(findings: &[PlantFinding]) -> Vec<(&str, &str)> {
    findings.iter().map(|finding| (finding.field.as_str(), finding.rule.key())).collect()
}

#[test]
fn a_device_has_everything_that_asking_it_needs() {
    let mut config = DeviceConfig::new("NX 1", "4,10.0.0.1,1,0");
    // Each is made of the other, and stands before it.
    config.types.insert("Line".into(), "STRUCT{first: Motor; second: Motor}".into());
    config.types.insert("Motor".into(), "STRUCT{speed: REAL; run: BOOL}".into());
    let plan = device(&config).unwrap();
    assert_eq!((plan.timeout_ms, plan.max_requests_per_s, plan.path.hops()), (3_000, 100, 2));
    assert!(plan.types.read("Line").is_ok());
}

#[test]
fn structures_that_grow_with_every_line_are_refused() {
    let mut config = DeviceConfig::new("x", "0,0");
    config.types.insert("T00".into(), "STRUCT{a: REAL; b: REAL}".into());
    for number in 1..40 {
        let below = alloc::format!("STRUCT{{a: T{0:02}; b: T{0:02}}}", number - 1);
        config.types.insert(alloc::format!("T{number:02}"), below);
    }
    assert_eq!(device(&config).unwrap_err()[0].rule.key(), "too_many_entries");
}

#[test]
fn all_that_is_wrong_with_a_device_is_said_at_once() {
    let mut config = DeviceConfig::new(" ", "4,x y");
    (config.timeout_ms, config.max_requests_per_s) = (5, 100_000);
    config.site = "s".repeat(65);
    config.types.insert("A".into(), "STRUCT{b: B}".into());
    let findings = device(&config).unwrap_err();
    let expected = [
        ("name", "missing"),
        ("site", "text_too_long"),
        ("path", "path"),
        ("timeout_ms", "out_of_range"),
        ("max_requests_per_s", "out_of_range"),
        ("types.A", "type"),
    ];
    assert_eq!(fields(&findings), expected);
}

#[test]
fn a_part_has_the_name_and_the_type_of_its_place_in_its_parent() {
    let all = [
        variable_of(2, Some(1), "speed", "speed", ""),
        variable_of(1, None, "motor", "stMotor", "STRUCT{speed: REAL; hist: INT[4]}"),
        variable_of(3, Some(1), "second", "hist[1]", ""),
        variable_of(4, Some(1), "gone", "torque", ""),
        variable_of(5, Some(9), "lost", "x", ""),
        variable_of(6, Some(6), "self", "x", ""),
    ];
    let plans = variables(&all, &Types::default());
    let found = |id| {
        plans[&VariableId(id)]
            .as_ref()
            .map(|plan| (plan.name.to_string(), plan.kind.as_ref().map(ToString::to_string)))
    };
    assert_eq!(found(2), Ok(("stMotor.speed".into(), Some("REAL".into()))));
    assert_eq!(found(3), Ok(("stMotor.hist[1]".into(), Some("INT".into()))));
    assert_eq!(fields(plans[&VariableId(4)].as_ref().unwrap_err()), [("address", "not_in_parent")]);
    assert_eq!(fields(plans[&VariableId(5)].as_ref().unwrap_err()), [("parent", "no_parent")]);
    assert!(plans[&VariableId(6)].is_err());
}

#[test]
fn all_that_is_wrong_with_a_variable_is_said_at_once() {
    let config = VariableConfig {
        name: String::new(),
        address: "a..b".into(),
        kind: "REALLY".into(),
        scale: Some(Scale { factor: 0.0, offset: 1.0 }),
        unit: "x".repeat(17),
        digits: Some(12),
        min: Some(2.0),
        max: Some(1.0),
        choices: vec![Choice { value: 1, text: String::new() }],
        ..VariableConfig::default()
    };
    let findings = variable(&config, None, &Types::default()).unwrap_err();
    let expected = [
        ("name", "missing"),
        ("unit", "text_too_long"),
        ("digits", "out_of_range"),
        ("scale", "factor"),
        ("min", "min_over_max"),
        ("choices", "missing"),
        ("address", "address"),
        ("type", "type"),
    ];
    assert_eq!(fields(&findings), expected);
}

#[test]
fn parents_may_be_there_or_be_added_with_their_parts() {
    let there = [variable_of(1, None, "motor", "stMotor", "STRUCT{speed: REAL}")];
    let new = |parent: Option<&str>, address: &str, kind: &str| NewVariable {
        parent_address: parent.map(Into::into),
        config: VariableConfig { kind: kind.into(), ..VariableConfig::new(address, address) },
    };
    let fresh =
        [new(Some("stMotor"), "speed", ""), new(None, " arTemp ", "INT[10]"), new(Some("arTemp"), "[3]", "")];
    let place = |number| alloc::format!("variables[{number}]");
    let accepted = added(&there, &fresh, &Types::default(), place).unwrap();
    assert_eq!((accepted[0].config.parent, accepted[0].parent), (Some(VariableId(1)), None));
    assert_eq!((accepted[2].config.parent, accepted[2].parent), (None, Some(1)));
    assert_eq!(accepted[1].config.address, "arTemp");

    let fresh = [
        new(None, "ok", ""),
        new(Some("nothing"), "x", ""),
        new(Some("arTemp"), "[1]", ""),
        new(None, "a b", ""),
    ];
    let findings = added(&there, &fresh, &Types::default(), place).unwrap_err();
    let expected = [
        ("variables[1].parent_address", "no_parent"),
        ("variables[2].parent_address", "no_parent"),
        ("variables[3].address", "address"),
    ];
    assert_eq!(fields(&findings), expected);
}

#[test]
fn a_variable_never_becomes_a_part_of_itself() {
    let all = [variable_of(1, None, "a", "a", ""), variable_of(2, Some(1), "b", "b", "")];
    let mut config = all[0].config.clone();
    config.parent = Some(VariableId(2));
    let findings = changed(VariableId(1), &config, &all, &Types::default()).unwrap_err();
    assert_eq!(fields(&findings), [("parent", "parent_loop")]);
    config.parent = None;
    config.address = " c ".into();
    assert_eq!(changed(VariableId(1), &config, &all, &Types::default()).unwrap().address, "c");
}

#[test]
fn a_file_comes_back_as_it_was_written() {
    let mut all = [
        variable_of(2, Some(1), "speed, \"fast\"", "speed", ""),
        variable_of(1, None, "=motor", "stMotor", "STRUCT{speed: REAL; run: BOOL}"),
    ];
    all[0].config.scale = Some(Scale { factor: 0.1, offset: -5.0 });
    all[0].config.choices =
        vec![Choice { value: 0, text: "off".into() }, Choice { value: -1, text: "on".into() }];
    (all[0].config.unit, all[0].config.digits, all[0].config.writable) = ("1/min".into(), Some(1), true);
    (all[0].config.min, all[0].config.max, all[0].config.order) = (Some(-1.5), Some(1e6), 7);
    all[0].config.display = Display::Hex;
    let text = write_csv(&all);
    assert!(text.starts_with("parent,name,address,type,"), "{text}");
    assert!(text.contains("\r\n,'=motor,stMotor,"), "{text}");
    let read = read_csv(&text).unwrap();
    let (lines, read): (Vec<_>, Vec<_>) = read.into_iter().unzip();
    assert_eq!(lines, [2, 3]);
    assert_eq!(read[1].parent_address.as_deref(), Some("stMotor"));
    assert_eq!(read[0].config, all[1].config);
    assert_eq!(VariableConfig { parent: Some(VariableId(1)), ..read[1].config.clone() }, all[0].config);
}

#[test]
fn what_a_spreadsheet_has_on_the_clipboard_is_read() {
    let text = "\u{feff}Name\tAddress\tFactor\tWritable\nPV\tgrHWCs_PV\t0,5\tTRUE\n\n\"two\nlines\"\tx\t\t\n";
    let read = read_csv(text).unwrap();
    assert_eq!(read[0].1.config.scale.map(|scale| scale.factor), Some(0.5));
    assert!(read[0].1.config.writable);
    assert_eq!((read[1].0, read[1].1.config.name.as_str()), (4, "two\nlines"));
}

#[test]
fn what_is_not_understood_is_said_with_line_and_column() {
    let text = "name,address,min,display,writable,choices\na,b,x,octal,maybe,one=1\n,\n\"c,d\n";
    let findings = read_csv(text).unwrap_err();
    let expected = [
        ("line 2.min", "not_a_number"),
        ("line 2.display", "not_a_word"),
        ("line 2.writable", "not_yes_or_no"),
        ("line 2.choices", "not_a_number"),
        ("line 4", "bad_line"),
    ];
    assert_eq!(fields(&findings), expected);
    let findings = read_csv("nme;address\nx;y").unwrap_err();
    assert_eq!(fields(&findings), [("line 1", "unknown_column"), ("line 1.name", "missing")]);
    assert_eq!(fields(&read_csv("").unwrap_err()), [("line 1", "missing")]);
}
