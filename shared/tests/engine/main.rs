//! The engine, driven as its owner drives it: virtual time, no sockets.
#![expect(clippy::unwrap_used, clippy::expect_used, reason = "a test may fail")]
#![expect(clippy::std_instead_of_alloc, reason = "tests have std")]
#![cfg_attr(target_arch = "wasm32", expect(clippy::indexing_slicing, reason = "a test may fail"))]

#[cfg(not(target_arch = "wasm32"))]
mod any;
mod moments;
mod owner;
mod promises;
mod rarely;

#[cfg(target_arch = "wasm32")]
wasm_bindgen_test::wasm_bindgen_test_configure!(run_in_browser);
