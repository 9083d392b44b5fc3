//! Whatever is typed as `TargetCfg.Path` is a plan or findings; a plan's messages fit and have a place to go.
#![no_main]

use cipdeck_shared::config::{MsgCipGeneric, TargetPath};
use cipdeck_shared::plan::{MessagePlan, Severity};
use libfuzzer_sys::fuzz_target;

fuzz_target!(|text: &str| {
    let parsed = text.parse::<TargetPath>();
    let (plan, findings) = MessagePlan::parse(&MsgCipGeneric::product_name(text));
    let has_error = findings.iter().any(|finding| finding.severity == Severity::Error);
    assert_eq!(plan.is_none(), has_error, "no plan without a reason: {findings:?}");
    if let Some(plan) = plan {
        let path = parsed.expect("a plan's path can be read");
        assert_eq!(plan.target(), &path.target);
        // What is shown of a target can be typed again.
        let shown = format!("4,{}", path.target);
        if let Ok(again) = shown.parse::<TargetPath>() {
            assert_eq!(again.target, path.target);
        }
    }
});
