//! The poller, driven as its owner drives it: virtual time, and a device of a few lines.
#![expect(clippy::unwrap_used, clippy::expect_used, reason = "a test may fail")]
#![expect(clippy::std_instead_of_alloc, reason = "tests have std")]
#![expect(clippy::indexing_slicing, reason = "a test may fail")]

#[cfg(not(target_arch = "wasm32"))]
mod any;
mod controllers;
mod device;
mod isolation;
mod learning;
mod long;
mod owner;
mod packing;
mod quality;
mod timing;

#[cfg(target_arch = "wasm32")]
wasm_bindgen_test::wasm_bindgen_test_configure!(run_in_browser);
