use cipdeck_shared::{
    config::MsgCipGeneric,
    plan::{MessagePlan, Rule},
};

use super::*;

#[test]
fn a_text_is_found_by_its_whole_key() {
    for table in [PAGE, OFFICE, DEVICES, WORDS, CODE, CAUSE, TRY, RULE, PROBLEM, EVENT, MEMBER] {
        assert!(!table.is_empty());
        for (key, text) in table {
            assert_eq!(find(table, key), Some(*text));
            assert_eq!((find(table, &format!("{key}x")), find(table, &key[1..])), (None, None), "{key}");
        }
    }
}

#[test]
fn every_rule_has_a_text() {
    let missing: Vec<_> = Rule::KEYS.iter().filter(|key| find(RULE, key).is_none()).collect();
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
