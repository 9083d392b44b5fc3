//! A block that was found, with everything that somebody has decided about it, and what would be saved.

use std::{
    collections::{BTreeMap, BTreeSet},
    rc::Rc,
};

use cipdeck_shared::{
    code::{Found, Imported, RemarkKind},
    config::{BlockConfig, SendReqForm},
    plan::{Finding, MessagePlan, Severity},
};

use super::desk::{Desk, Pick, Place};

/// A block that may be saved.
#[derive(Clone, Debug, PartialEq)]
pub struct Entry {
    /// Where it is.
    pub place: Place,
    /// The file that it came from.
    pub file: Option<String>,
    /// What was read.
    pub found: Found,
    /// What was decided.
    pub pick: Pick,
    /// What would be saved.
    pub config: BlockConfig,
    /// What that would send.
    pub plan: Option<MessagePlan>,
    /// What is to be said about that.
    pub findings: Vec<Finding>,
    /// Whether its text names no device.
    pub is_without_target: bool,
    /// Whether something else has its name.
    pub double: Option<Double>,
}

/// Who else has a name.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Double {
    /// A block of the deck.
    InDeck,
    /// Another one of these.
    Here,
}

impl Entry {
    /// Whether it cannot be saved as it is.
    pub fn has_errors(&self) -> bool {
        self.plan.is_none() || self.findings.iter().any(|finding| finding.severity == Severity::Error)
    }

    /// Whether a click on Save would save it.
    pub fn is_due(&self) -> bool {
        self.pick.kept && !self.pick.is_saved() && !self.has_errors()
    }
}

/// All blocks of all texts.
pub fn entries(desk: &Desk, in_deck: &BTreeSet<String>) -> Vec<Rc<Entry>> {
    let mut entries = Vec::new();
    for source in &desk.sources {
        let Some(imported) = &source.imported else { continue };
        for (index, (found, pick)) in imported.blocks.iter().zip(&source.picks).enumerate() {
            entries.push(entry((source.key, index), source.file.as_deref(), found, pick, &desk.target));
        }
    }
    let mut here = BTreeMap::<&str, usize>::new();
    for entry in entries.iter().filter(|entry| entry.pick.kept) {
        *here.entry(entry.config.name()).or_default() += 1;
    }
    let doubles: Vec<_> = entries.iter().map(|entry| double(entry, in_deck, &here)).collect();
    entries.into_iter().zip(doubles).map(|(entry, double)| Rc::new(Entry { double, ..entry })).collect()
}

fn double(entry: &Entry, in_deck: &BTreeSet<String>, here: &BTreeMap<&str, usize>) -> Option<Double> {
    let name = entry.config.name();
    if entry.pick.is_saved() {
        None
    } else if in_deck.contains(name) {
        Some(Double::InDeck)
    } else {
        here.get(name).filter(|count| **count > 1).map(|_| Double::Here)
    }
}

fn entry(place: Place, file: Option<&str>, found: &Found, pick: &Pick, target: &str) -> Entry {
    let is_without_target = found.remarks.iter().any(|remark| tells_no_device(&remark.what));
    let mut config = found.config.clone();
    if let Some(name) = &pick.name {
        config.set_name(name.clone());
    }
    if is_without_target && !target.trim().is_empty() {
        aim(&mut config, target.trim());
    }
    let mut found = found.clone();
    if config.target_text() != found.config.target_text() {
        // Somebody has said where it goes.
        found.remarks.retain(|remark| !tells_no_device(&remark.what));
    }
    let (plan, findings) = MessagePlan::check(&config);
    Entry {
        place,
        file: file.map(str::to_owned),
        found,
        pick: pick.clone(),
        config,
        plan,
        findings,
        is_without_target,
        double: None,
    }
}

/// Whether it says that a text names no device. Words of Control Expert have a sentence of their own for it.
fn tells_no_device(what: &RemarkKind) -> bool {
    match what {
        RemarkKind::NoDevice => true,
        RemarkKind::Told(words) => words.starts_with("the text names no device"),
        _ => false,
    }
}

/// Points a block at a device: an address alone is written as the block's kind writes it; anything else is taken as it is,
/// and the block's findings say what is wrong with it.
fn aim(config: &mut BlockConfig, target: &str) {
    let address = target.strip_prefix("4,").unwrap_or(target);
    let is_alone = !address.contains([',', '(', '{', '\'']);
    match config {
        BlockConfig::MsgCipGeneric(block) => {
            block.target_cfg.path = if is_alone { format!("4,{address}") } else { target.to_owned() };
        }
        BlockConfig::SendReq(block) => {
            block.address = match block.form() {
                // Its device is among its words.
                SendReqForm::Etc101 => return,
                _ if !is_alone => target.to_owned(),
                SendReqForm::Etc100 => format!("ADDR('0.0.0.{address}')"),
                SendReqForm::DataExch => format!("ADDMX('0.0.0{{{address}}}UNC.CIP')"),
            }
        }
    }
}

/// How much is said about the texts, by severity: not understood, to be looked at, good to know.
pub fn remarks<'a>(imported: impl Iterator<Item = &'a Rc<Imported>>) -> [usize; 3] {
    let mut counts = [0; 3];
    for imported in imported {
        let of_blocks = imported.blocks.iter().flat_map(|found| &found.remarks);
        for remark in imported.remarks.iter().chain(of_blocks) {
            let [errors, warnings, notes] = &mut counts;
            *match remark.severity {
                Severity::Error => errors,
                Severity::Warning => warnings,
                Severity::Note => notes,
            } += 1;
        }
    }
    counts
}

#[cfg(test)]
mod tests {
    use cipdeck_shared::{
        code::{Dialect, Remark},
        config::{MsgCipGeneric, SendReq},
    };
    use yew::Reducible;

    use super::{super::desk::Deed, *};

    fn found(config: BlockConfig, what: Option<RemarkKind>) -> Found {
        let remark =
            |what| Remark { line: 1, column: 1, severity: Severity::Warning, excerpt: String::new(), what };
        let remarks = what.into_iter().map(remark).collect();
        Found { config, dialect: Dialect::Hex, lines: 1..2, remarks }
    }

    fn desk(blocks: Vec<Found>, deeds: Vec<Deed>) -> Rc<Desk> {
        let imported = Rc::new(Imported { blocks, remarks: Vec::new() });
        let begin = vec![Deed::Type(0, "x".into()), Deed::Read(0, "x".into(), None, imported)];
        begin.into_iter().chain(deeds).fold(Rc::default(), Desk::reduce)
    }

    fn named(name: &str) -> BlockConfig {
        let mut config = MsgCipGeneric::product_name("0,0");
        config.name = name.to_owned();
        config.into()
    }

    #[test]
    fn a_target_goes_only_where_the_text_names_none() {
        let blocks = vec![found(named("a"), Some(RemarkKind::NoDevice)), found(named("b"), None)];
        let target = |text: &str| Deed::Target(text.to_owned());
        let paths = |text: &str| -> Vec<_> {
            let desk = desk(blocks.clone(), vec![target(text)]);
            let entries = entries(&desk, &BTreeSet::new());
            entries.iter().map(|entry| entry.config.target_text().to_owned()).collect()
        };
        assert_eq!(paths(" 192.168.1.5 "), ["4,192.168.1.5", "0,0"]);
        assert_eq!(paths("4,192.168.1.5,1,0"), ["4,192.168.1.5,1,0", "0,0"]);
        assert_eq!(paths(""), ["0,0", "0,0"]);
    }

    #[test]
    fn nothing_wants_a_device_that_somebody_has_named() {
        let blocks = vec![found(named("a"), Some(RemarkKind::NoDevice))];
        let said = |target: &str| {
            let desk = desk(blocks.clone(), vec![Deed::Target(target.to_owned())]);
            entries(&desk, &BTreeSet::new()).iter().map(|entry| entry.found.remarks.len()).sum::<usize>()
        };
        assert_eq!((said(""), said("192.168.1.5")), (1, 0));
    }

    #[test]
    fn a_target_is_written_as_the_kind_of_the_block_writes_it() {
        let aimed = |form, target: &str| {
            let mut config = BlockConfig::from(SendReq::new(form, "a"));
            aim(&mut config, target);
            config.target_text().to_owned()
        };
        assert_eq!(aimed(SendReqForm::Etc100, "192.168.1.5"), "ADDR('0.0.0.192.168.1.5')");
        assert_eq!(aimed(SendReqForm::DataExch, "4,192.168.1.5"), "ADDMX('0.0.0{192.168.1.5}UNC.CIP')");
        assert_eq!(aimed(SendReqForm::Etc100, "ADDR('0.4.0.10.0.0.7')"), "ADDR('0.4.0.10.0.0.7')");
        assert_eq!(aimed(SendReqForm::Etc101, "192.168.1.5"), "");
    }

    #[test]
    fn what_is_pasted_alone_wants_a_device_unless_it_is_among_its_words() {
        let wants = |text: &str| {
            let imported = Rc::new(cipdeck_shared::code::import(text, None));
            let begin = [Deed::Type(0, text.into()), Deed::Read(0, text.into(), None, imported)];
            let desk = begin.into_iter().fold(Rc::default(), Desk::reduce);
            entries(&desk, &BTreeSet::new()).iter().map(|entry| entry.is_without_target).collect::<Vec<_>>()
        };
        assert_eq!(wants("0E 03 20 01 24 01 30 07"), [true]);
        assert_eq!(wants("0000 030E 0120 0124 0730"), [true]);
        assert_eq!(wants("024E 4420 0124 0000 000A"), [true]);
        assert_eq!(wants("0000 C0A8 0166 024E 4420 0124 0000 000A"), [false]);
    }

    #[test]
    fn who_else_has_a_name_is_told() {
        let blocks = ["a", "b", "b", "c"].map(|name| found(named(name), None));
        let deeds = vec![Deed::Rename((0, 0), "in the deck".into())];
        let desk = desk(blocks.into(), deeds);
        let entries = entries(&desk, &BTreeSet::from(["in the deck".to_owned()]));
        let doubles: Vec<_> = entries.iter().map(|entry| entry.double).collect();
        assert_eq!(doubles, [Some(Double::InDeck), Some(Double::Here), Some(Double::Here), None]);
    }

    #[test]
    fn what_has_errors_is_not_due() {
        let mut wrong = MsgCipGeneric::product_name("0,0");
        wrong.app_cfg.service = 300;
        let desk = desk(
            vec![found(wrong.into(), None), found(named("a"), None), found(named("b"), None)],
            vec![Deed::Keep((0, 2), false)],
        );
        let due: Vec<_> = entries(&desk, &BTreeSet::new()).iter().map(|entry| entry.is_due()).collect();
        assert_eq!(due, [false, true, false]);
    }
}
