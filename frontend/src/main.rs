//! The workbench's entry: wasm-bindgen calls `main` once the module is loaded.
fn main() {
    cipdeck_frontend::start();
}
