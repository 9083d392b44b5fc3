//! Scripts and what their variables hold.

use super::*;
use alloc::string::{String, ToString};
use alloc::vec;
use alloc::vec::Vec;

fn remarks(script: &Script<'_>) -> Vec<String> {
    script.remarks.iter().map(ToString::to_string).collect()
}

#[test]
fn declarations_of_every_form_are_read() {
    let script = Script::read(
        "VAR_GLOBAL CONSTANT\n Tab, Other AT %MW10 : ARRAY[0..4] OF INT := [16#0000, 2(16#0E), 7];\nEND_VAR
        cfg : CIPAPPCFG := (Service := 14, MemberId := [1, 2, 3]);
        path : STRING[80] := '4,192.168.1.100';",
    );
    assert_eq!(remarks(&script), Vec::<String>::new());
    let memory = Memory::before(&script, 0);
    for (key, value) in [
        ("tab[0]", Some(0)),
        ("other[2]", Some(14)),
        ("tab[3]", Some(7)),
        ("tab[4]", None),
        ("%mw10[1]", Some(14)),
        ("cfg.service", Some(14)),
        ("cfg.memberid[2]", Some(3)),
    ] {
        assert_eq!(memory.integer(key), value, "{key}");
    }
    assert_eq!(memory.value("path").and_then(Expression::text), Some("4,192.168.1.100"));
    let Statement::Declaration(tab) = &script.items[0].statement else { panic!("a declaration") };
    assert_eq!(
        (tab.kind.elements(), tab.kind.is("int"), tab.constant, tab.at),
        (5, true, true, Some("%MW10"))
    );
}

#[test]
fn an_assignment_counts_for_the_calls_after_it_and_for_those_before_if_there_is_none() {
    let script = Script::read("cfg.Class := 1; fb(); cfg.Class := 16#93; cfg.Class := 148; fb(); late := 5;");
    let calls: Vec<usize> = (0..script.items.len())
        .filter(|index| matches!(script.items[*index].statement, Statement::Call(_)))
        .collect();
    let class = |at: usize| {
        let memory = Memory::before(&script, calls[at]);
        let cell = *memory.cell("cfg.class").unwrap();
        (cell.value.integer(), cell.again, memory.integer("late"))
    };
    assert_eq!(class(0), (Some(1), false, Some(5)));
    assert_eq!(class(1), (Some(148), true, Some(5)));
}

#[test]
fn what_can_be_calculated_is() {
    let script = Script::read(
        "speed := 1500; low := ANY_TO_USINT(speed MOD 256); high := ANY_TO_USINT((speed / 256) AND 16#FF);
         sum := 2 + 3 * 4 - 1; neg := -5; loop := loop + 1; big := ANY_TO_USINT(speed);",
    );
    let memory = Memory::before(&script, script.items.len());
    for (key, value) in [
        ("low", Some(0xDC)),
        ("high", Some(5)),
        ("sum", Some(13)),
        ("neg", Some(-5)),
        ("loop", None),
        ("big", None),
    ] {
        assert_eq!(memory.integer(key), value, "{key}");
    }
}

#[test]
fn calls_are_read_formal_and_positional() {
    let script =
        Script::read("m1(IN := start, Path:='a', Q => done, ENO =>);\nSEND_REQ(ADDR('0.2'), 16#0E, a, , b);");
    assert_eq!(remarks(&script), Vec::<String>::new());
    let calls: Vec<&Call<'_>> = script
        .items
        .iter()
        .filter_map(|item| if let Statement::Call(call) = &item.statement { Some(call) } else { None })
        .collect();
    assert!(calls[0].is("M1") && calls[0].argument(9, "q").is_some_and(|argument| argument.output));
    assert_eq!(calls[1].argument(1, "Request_Code").unwrap().value.as_ref().unwrap().integer(), Some(14));
    assert_eq!(calls[1].argument(3, "x").unwrap().value, None);
}

#[test]
fn frames_and_conditions_are_left_out_and_conditions_noted() {
    let script = Script::read(
        "PROGRAM p\nVAR a : INT; END_VAR\nIF NOT busy AND x > 3 THEN\n a := 1;\nELSIF y THEN a := 2; ELSE a := 3; END_IF;
CASE step OF\n0: a := 4;\n1, 2: b := 5; ELSE c := 6; END_CASE\nFOR i := 0 TO 9 DO d[i] := 0; END_FOR;\nEND_PROGRAM",
    );
    assert_eq!(script.items.len(), 8);
    assert_eq!(
        remarks(&script),
        vec![
            "3:1: note: a condition changes nothing about the message: IF NOT busy AND x > 3 THEN",
            "5:1: note: a condition changes nothing about the message: ELSIF y THEN",
            "6:1: note: a condition changes nothing about the message: CASE step OF",
            "9:1: note: a condition changes nothing about the message: FOR i := 0 TO 9 DO",
        ]
    );
}

#[test]
fn what_is_not_understood_is_told_with_its_line_and_the_next_line_is_read() {
    let script = Script::read(
        "a := ;\nb := 5;\nIf you want to know, ask;\nc := USINT#300;\nd := 1\ne := 2; f ? 3;\ng(1",
    );
    let keys = |script: &Script<'_>| {
        script.items.iter().map(|item| script.source(item).to_string()).collect::<Vec<_>>()
    };
    assert_eq!(keys(&script), ["b := 5;", "d := 1", "e := 2;"]);
    assert_eq!(
        remarks(&script),
        vec![
            "1:6: error: a value is expected here: a := ;",
            "3:1: error: THEN is expected here: If you want to know, ask;",
            "4:6: error: 300 is no USINT: it is 0 to 255: c := USINT#300;",
            "5:6: warning: ; is expected here: 1",
            "6:11: error: not understood, left out: ?",
            "6:13: error: := is expected here: f ? 3;",
            "7:3: error: , or ) is expected here: g(1",
        ]
    );
}

#[test]
fn slips_of_printed_manuals_are_read_and_marked() {
    let script =
        Script::read("Tab_Gest : ARRAY [0.3] OF INT;\nb : ARRAY[0...5] OF INT;\nx := Tab_Gest[1].0;");
    assert_eq!(remarks(&script), Vec::<String>::new());
    let bounds = |at: usize| match &script.items[at].statement {
        Statement::Declaration(declaration) => {
            (declaration.kind.bounds.clone(), declaration.kind.slip.is_some())
        }
        _ => panic!("a declaration"),
    };
    assert_eq!((bounds(0), bounds(1)), ((vec![(0, 3)], true), (vec![(0, 5)], true)));
    let Statement::Assignment { value, .. } = &script.items[2].statement else { panic!("an assignment") };
    assert_eq!(value.reference().unwrap().key().unwrap(), "tab_gest[1].0");
}

#[test]
fn whole_numbers_have_64_bits() {
    let one = Script::read(
        "a := 18446744073709551615; b := -9223372036854775808; c[18446744073709551615] := a * a;",
    );
    assert_eq!(remarks(&one), Vec::<String>::new());
    let memory = Memory::before(&one, one.items.len());
    assert_eq!(memory.integer("a"), Some(u64::MAX.into()));
    assert_eq!(memory.integer("b"), Some(i64::MIN.into()));
    assert_eq!(memory.integer("c[18446744073709551615]"), None, "a product that no controller holds");
    let more = Script::read("a := 18446744073709551616;\nb[170141183460469231731687303715884105727] := 1;");
    let told = remarks(&more);
    assert_eq!(told.len(), 2, "{told:?}");
    assert!(
        told.iter().all(|told| told.contains("a number of at most 64 bits is expected here")),
        "{told:?}"
    );
}

#[test]
fn bombs_are_refused_or_bounded() {
    let deep = [
        "(".repeat(100_000),
        alloc::format!("a := {}1{};", "(".repeat(10_000), ")".repeat(10_000)),
        alloc::format!("a := {}1;", "-".repeat(100_000)),
        alloc::format!("a{} := 1;", "[a".repeat(10_000)),
        alloc::format!("a : {} INT;", "ARRAY[0..1] OF ".repeat(10_000)),
        alloc::format!("a := 1{};", " + 1".repeat(100_000)),
        "IF\n".repeat(100_000),
        "a,\n".repeat(100_000),
        "f(".repeat(100_000),
    ];
    for text in deep {
        let script = Script::read(&text);
        let _ = Memory::before(&script, script.items.len());
    }
    let sums: Vec<String> =
        (0..20).map(|n| alloc::format!("v{n} := 1{};", alloc::format!(" + v{}", n + 1).repeat(99))).collect();
    let sums = sums.concat();
    let script = Script::read(&sums);
    assert_eq!(Memory::before(&script, script.items.len()).integer("v0"), None);
    let script = Script::read("a : ARRAY[0..1] OF INT := [9999999999(0)]; b : INT := [100(100(100(0)))];");
    assert!(Memory::before(&script, 0).is_full());
}
