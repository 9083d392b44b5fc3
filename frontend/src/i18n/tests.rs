use std::{collections::BTreeSet, fs, path::Path};

use cipdeck_shared::{
    config::MsgCipGeneric,
    plan::{MessagePlan, Rule},
};

use super::*;

/// All Rust sources below a folder.
fn sources(folder: &Path) -> Vec<String> {
    let entries = fs::read_dir(folder).unwrap().map(|entry| entry.unwrap().path());
    entries
        .flat_map(|path| if path.is_dir() { sources(&path) } else { vec![fs::read_to_string(path).unwrap()] })
        .collect()
}

/// Keys in `tr!("…")` and `t!("…")`.
fn used() -> BTreeSet<String> {
    let root = Path::new(env!("CARGO_MANIFEST_DIR")).join("src");
    let mut keys = BTreeSet::new();
    for source in sources(&root) {
        let calls = source.match_indices("t!(\"").chain(source.match_indices("tr!(\""));
        for (at, call) in calls {
            let rest = &source[at + call.len()..];
            let key = &rest[..rest.find('"').unwrap()];
            if !key.contains(['…', '{']) {
                keys.insert(key.to_owned());
            }
        }
    }
    keys
}

#[test]
fn every_key_that_the_page_uses_has_a_text() {
    let used = used();
    assert!(used.len() > 100, "only {} keys were found", used.len());
    let has_text = |key: &String| {
        try_text(key).is_some() || crate::office::has_text(key) || crate::devices::has_text(key)
    };
    let missing: Vec<_> = used.iter().filter(|key| !has_text(key)).collect();
    assert!(missing.is_empty(), "{missing:?}");
}

#[test]
fn every_rule_has_a_text() {
    let missing: Vec<_> =
        Rule::KEYS.iter().filter(|key| try_text(&format!("rule.{key}")).is_none()).collect();
    assert!(missing.is_empty(), "{missing:?}");
}

#[test]
fn the_texts_of_rules_name_all_their_arguments() {
    let mut config = MsgCipGeneric::product_name("4,drive:44820");
    config.app_cfg.service = 300;
    config.req_data = "0x".into();
    config.target_cfg.ucmm_timeout = 1;
    config.app_cfg.member_id.clear();
    let (_, findings) = MessagePlan::parse(&config);
    assert!(findings.len() >= 5, "{findings:?}");
    for finding in findings {
        let text = rule_text(finding.rule.key(), &finding.rule.arguments());
        assert!(!text.contains("%{"), "{}: {text}", finding.rule.key());
        for (name, value) in finding.rule.arguments() {
            assert!(text.contains(&value), "{}: {name} is not in “{text}”", finding.rule.key());
        }
    }
}
