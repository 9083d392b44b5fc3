//! The engine and simulated devices with a network between them, in virtual time: what is late, lost, doubled, changed
//! or cut off on the way never gives a wrong value, never lets a device act twice, and never leaves anything behind.
#![allow(clippy::unwrap_used, clippy::expect_used, clippy::indexing_slicing, reason = "a test may fail")]
#![expect(clippy::std_instead_of_alloc, clippy::std_instead_of_core, reason = "tests have std")]

mod accidents;
#[cfg(not(target_arch = "wasm32"))]
mod any;
mod checks;
mod cuts;
mod network;
mod plain;
mod shots;
mod world;

#[cfg(target_arch = "wasm32")]
wasm_bindgen_test::wasm_bindgen_test_configure!(run_in_browser);
