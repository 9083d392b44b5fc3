//! The texts are compiled in: without this a changed locale file would not be noticed.
fn main() {
    println!("cargo:rerun-if-changed=locales");
}
