//! The entry of the sixth document: wasm-bindgen calls `main` once the module is loaded.
fn main() {
    cipdeck_frontend::start_take();
}
