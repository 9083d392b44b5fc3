//! Whatever is pasted is read without panic; every remark has a place, and what is found can be written as bytes.
#![no_main]

use cipdeck_shared::code::{Dialect, Options, export, highlight, import};
use libfuzzer_sys::fuzz_target;

fuzz_target!(|text: &str| {
    for dialect in Dialect::ALL.map(Some).into_iter().chain([None]) {
        let imported = import(text, dialect);
        for remark in imported.remarks.iter().chain(imported.blocks.iter().flat_map(|found| &found.remarks)) {
            assert!(remark.line > 0 && remark.column > 0, "{remark}");
        }
        for found in imported.blocks.iter().take(10) {
            let _ = export(&found.config, Dialect::Hex, &Options::default());
        }
        if let Some(dialect) = dialect {
            let mut at = 0;
            for (range, _) in highlight(dialect, text) {
                assert!(range.start >= at && text.get(range.clone()).is_some());
                at = range.end;
            }
        }
    }
});
