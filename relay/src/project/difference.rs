//! What becomes of something, in words: a preview has to say more than "changed".

use std::collections::BTreeMap;
use std::fmt::Write;

use serde::Serialize;
use serde_json::Value;

/// Members that are told one by one; of the rest their number.
const MAX_TOLD: usize = 4;

/// Characters of a value that are told.
const MAX_VALUE: usize = 40;

/// What differs, member by member: `AppCfg.Attribute: 7 → 6`. Nothing, if nothing does.
pub(super) fn difference(before: &impl Serialize, after: &impl Serialize) -> Option<String> {
    let (before, after) = (members(before), members(after));
    let names = before.keys().chain(after.keys().filter(|name| !before.contains_key(*name)));
    let differ: Vec<_> = names.filter(|name| before.get(*name) != after.get(*name)).collect();
    let mut words = String::new();
    for name in differ.iter().take(MAX_TOLD) {
        let value = |members: &BTreeMap<String, Value>| members.get(*name).map_or("nothing".into(), shown);
        let comma = if words.is_empty() { "" } else { ", " };
        // Writing to a text cannot fail.
        let _ = write!(words, "{comma}{name}: {} → {}", value(&before), value(&after));
    }
    if differ.len() > MAX_TOLD {
        let _ = write!(words, ", and {} more", differ.len() - MAX_TOLD);
    }
    Some(words).filter(|words| !words.is_empty())
}

/// Those that are there, one after the other.
pub(super) fn together(words: impl IntoIterator<Item = Option<String>>) -> Option<String> {
    let words: Vec<_> = words.into_iter().flatten().collect();
    (!words.is_empty()).then(|| words.join("; "))
}

/// All values with their paths.
fn members(of: &impl Serialize) -> BTreeMap<String, Value> {
    fn collect(path: String, value: Value, all: &mut BTreeMap<String, Value>) {
        match value {
            Value::Object(members) if !members.is_empty() => {
                for (name, value) in members {
                    collect(if path.is_empty() { name } else { format!("{path}.{name}") }, value, all);
                }
            }
            Value::Array(items) if !items.is_empty() => {
                for (place, value) in items.into_iter().enumerate() {
                    collect(format!("{path}[{place}]"), value, all);
                }
            }
            value => drop(all.insert(path, value)),
        }
    }
    let mut all = BTreeMap::new();
    collect(String::new(), serde_json::to_value(of).unwrap_or_default(), &mut all);
    all
}

fn shown(value: &Value) -> String {
    let text = value.to_string();
    if text.chars().count() <= MAX_VALUE {
        return text;
    }
    text.chars().take(MAX_VALUE).chain(['…']).collect()
}

#[cfg(test)]
mod tests {
    use super::*;
    use serde_json::json;

    #[test]
    fn what_differs_is_told_with_its_place_and_both_values() {
        let before = json!({ "name": "a", "AppCfg": { "Attribute": 7, "MemberId": [0, 0] }, "site": "x" });
        let after = json!({ "name": "a", "AppCfg": { "Attribute": 6, "MemberId": [0, 5] }, "rack": "7b" });
        assert_eq!(
            difference(&before, &after).unwrap(),
            "AppCfg.Attribute: 7 → 6, AppCfg.MemberId[1]: 0 → 5, site: \"x\" → nothing, rack: nothing → \"7b\""
        );
        assert_eq!(difference(&before, &before), None);
    }

    #[test]
    fn much_and_long_is_cut_and_says_so() {
        let long = difference(&json!({ "x": "" }), &json!({ "x": "ä".repeat(1_000) })).unwrap();
        assert!(long.starts_with("x: \"\" → \"äää") && long.ends_with("ä…") && long.len() < 120, "{long}");
        let many = |value: u32| json!((0..9).map(|place| place + value).collect::<Vec<_>>());
        let many = difference(&many(0), &many(1)).unwrap();
        assert!(many.starts_with("[0]: 0 → 1, [1]: 1 → 2") && many.ends_with(", and 5 more"), "{many}");
    }
}
