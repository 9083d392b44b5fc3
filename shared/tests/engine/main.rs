//! The engine, driven as its owner drives it: virtual time, no sockets.
#![expect(clippy::unwrap_used, clippy::expect_used, reason = "a test may fail")]
#![expect(clippy::std_instead_of_alloc, reason = "tests have std")]
#![cfg_attr(target_arch = "wasm32", expect(clippy::indexing_slicing, reason = "a test may fail"))]

mod alive;
#[cfg(not(target_arch = "wasm32"))]
mod any;
mod connections;
mod moments;
mod opening;
mod owner;
mod profiles;
mod promises;
mod queues;
mod rarely;
mod routers;
mod target;
mod tolerance;
mod words;

#[cfg(target_arch = "wasm32")]
wasm_bindgen_test::wasm_bindgen_test_configure!(run_in_browser);
