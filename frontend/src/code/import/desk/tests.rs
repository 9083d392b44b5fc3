use cipdeck_shared::{
    code::Found,
    config::{BlockId, MsgCipGeneric},
};

use super::*;

fn found(name: &str) -> Found {
    let mut config = MsgCipGeneric::product_name("0,0");
    config.name = name.to_owned();
    Found { config: config.into(), dialect: Dialect::CcwSt, lines: 1..2, remarks: Vec::new() }
}

fn imported(names: &[&str]) -> Rc<Imported> {
    Rc::new(Imported { blocks: names.iter().map(|name| found(name)).collect(), remarks: Vec::new() })
}

fn done(deeds: Vec<Deed>) -> Rc<Desk> {
    deeds.into_iter().fold(Rc::default(), Desk::reduce)
}

fn read(text: &str, names: &[&str]) -> [Deed; 2] {
    [Deed::Type(0, text.to_owned()), Deed::Read(0, text.into(), None, imported(names))]
}

fn picks(desk: &Desk) -> Vec<(Option<&str>, bool)> {
    desk.sources[0].picks.iter().map(|pick| (pick.name.as_deref(), pick.kept)).collect()
}

#[test]
fn decisions_stay_with_their_block_while_somebody_types() {
    let mut deeds = Vec::from(read("a b", &["a", "b"]));
    deeds.extend([Deed::Rename((0, 1), "mine".into()), Deed::Keep((0, 0), false)]);
    deeds.extend(read("new a b", &["new", "a", "b"]));
    assert_eq!(picks(&done(deeds.clone())), [(None, true), (None, false), (Some("mine"), true)]);
    deeds.extend(read("a c", &["a", "c"]));
    assert_eq!(picks(&done(deeds)), [(None, false), (None, true)]);
}

#[test]
fn a_block_whose_name_changes_in_the_text_keeps_its_decisions() {
    let mut deeds = Vec::from(read("a b", &["a", "b"]));
    deeds.push(Deed::Keep((0, 1), false));
    deeds.extend(read("a bb", &["a", "bb"]));
    assert_eq!(picks(&done(deeds)), [(None, true), (None, false)]);
}

#[test]
fn what_was_saved_stays_saved_until_its_text_changes() {
    let mut deeds = Vec::from(read("a b", &["a", "b"]));
    deeds.push(Deed::Became((0, 0), Outcome::Saved(BlockId(7))));
    deeds.extend(read("a b ", &["a", "b"]));
    assert!(done(deeds.clone()).sources[0].picks[0].is_saved());
    deeds.extend(read("c b", &["c", "b"]));
    assert_eq!(done(deeds).sources[0].picks[0].outcome, Outcome::Open);
}

#[test]
fn an_answer_to_an_older_text_is_dropped() {
    let desk = done(vec![
        Deed::Type(0, "old".into()),
        Deed::Type(0, "new".into()),
        Deed::Read(0, "old".into(), None, imported(&["old"])),
    ]);
    assert_eq!(desk.sources[0].imported, None);
    let chosen = done(vec![
        Deed::Type(0, "x".into()),
        Deed::Choose(0, Some(Dialect::Hex)),
        Deed::Read(0, "x".into(), None, imported(&["x"])),
    ]);
    assert_eq!(chosen.sources[0].imported, None);
}

#[test]
fn a_file_takes_the_empty_place_and_lies_beside_a_text() {
    let file = |name: &str| Deed::Add(name.to_owned(), "text".into(), Encoding::Utf8);
    let desk = done(vec![file("a.st"), file("b.st")]);
    let names = |desk: &Desk| desk.sources.iter().map(|it| it.file.clone()).collect::<Vec<_>>();
    assert_eq!(names(&desk), [Some("a.st".to_owned()), Some("b.st".to_owned())]);
    assert_eq!(desk.shown, 1);
    let desk = done(vec![Deed::Type(0, "typed".into()), file("a.st")]);
    assert_eq!(names(&desk), [None, Some("a.st".to_owned())]);
    let key = desk.sources[1].key;
    let desk = desk.reduce(Deed::Remove(key)).reduce(Deed::Remove(0));
    assert_eq!((desk.sources.len(), desk.shown), (1, 0));
    assert!(desk.sources[0].is_empty());
}

#[test]
fn too_many_files_are_told() {
    let files = (0..=MAX_SOURCES).map(|n| Deed::Add(format!("{n}.st"), "x".into(), Encoding::Utf8));
    let desk = done(files.collect());
    assert_eq!(desk.sources.len(), MAX_SOURCES);
    assert_eq!(desk.refused, [(format!("{MAX_SOURCES}.st"), Refusal::TooMany)]);
}

#[test]
fn a_refused_block_may_be_tried_again_once_it_is_changed() {
    let problem = Rc::new(crate::net::rest::unreachable(String::new()));
    let mut deeds = Vec::from(read("a", &["a"]));
    deeds.push(Deed::Became((0, 0), Outcome::Refused(problem)));
    assert!(matches!(done(deeds.clone()).sources[0].picks[0].outcome, Outcome::Refused(_)));
    deeds.push(Deed::Rename((0, 0), "b".into()));
    assert_eq!(done(deeds).sources[0].picks[0].outcome, Outcome::Open);
}
