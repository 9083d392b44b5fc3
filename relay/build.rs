//! Rebuilds the relay when the page changes: `rust-embed` reads the folder at compile time, which cargo does not see.

fn main() {
    // A folder that does not exist would make every build a full one; its parent tells when it appears.
    let dist = std::path::Path::new("../frontend/dist");
    let watched = if dist.is_dir() { "../frontend/dist" } else { "../frontend" };
    println!("cargo::rerun-if-changed={watched}");
    println!("cargo::rerun-if-changed=build.rs");
}
