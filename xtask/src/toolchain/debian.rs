//! wasm32 without rustup's servers: Debian's packages hold a compiler and the std sources that match it.
//!
//! std is built once into a sysroot of our own in the user's cache; the packaged folders stay as they are. Small
//! scripts start the packaged programs with this sysroot, and rustup knows the folder as a toolchain.

use std::{
    env, fs,
    path::{Path, PathBuf},
    process::Command,
};

use anyhow::{Context, Result};

use super::{Preference, WASM, WasmToolchain, has_target};
use crate::{
    process::{find, program, read, run},
    system, workspace,
};

/// The toolchain, if an earlier call has made it and its compiler is still the installed one.
pub(super) fn linked() -> Option<WasmToolchain> {
    let ready = WasmToolchain { name: Some(NAME.to_owned()) };
    let rustc = || {
        let mut rustc = program("rustc");
        ready.prepare(&mut rustc);
        rustc
    };
    let is_current = version(&mut rustc()).ok()? == version(&mut program(RUSTC)).ok()?;
    (is_current && has_target(&mut rustc())).then_some(ready)
}

/// Whether this way can be tried here.
pub(super) fn is_possible() -> bool {
    system::is_debian() && find("rustup").is_some()
}

/// Installs the packages, builds std, and makes the toolchain known to rustup; does only what is missing.
pub(super) fn toolchain(preference: Preference) -> Result<WasmToolchain> {
    system::install(preference.consent, PACKAGES, "A compiler for wasm32")?;
    if let Some(ready) = linked() {
        return Ok(ready);
    }
    let sysroot = sysroot()?;
    if !sysroot.is_dir() {
        let libraries = build_std()?;
        lay_down(&sysroot, &libraries)?;
        // What was compiled against the std before is of no use any more, and cargo would not notice.
        let ready = WasmToolchain { name: Some(NAME.to_owned()) };
        remove(&ready.target())?;
    }
    run(program("rustup").args(["toolchain", "link", NAME]).arg(&sysroot))?;
    linked().context("the toolchain made of Debian's packages cannot compile for wasm32")
}

/// Builds std for wasm32 from the packaged sources, and returns its libraries.
fn build_std() -> Result<Vec<PathBuf>> {
    let package = workspace::target().join("wasm-std");
    remove(&package)?;
    fs::create_dir_all(&package)?;
    fs::write(package.join("lib.rs"), "")?;
    fs::write(package.join("Cargo.toml"), EMPTY_PACKAGE)?;
    // The variable lets the packaged compiler, a stable one, build the std that belongs to it.
    // Bitcode inside the libraries is what the shipped page needs for its link-time optimisation.
    run(program(CARGO)
        .current_dir(&package)
        .args(["build", "--release", "-Zbuild-std=std,panic_abort,test", "--target", WASM])
        .env("RUSTC", RUSTC)
        .env("RUSTC_BOOTSTRAP", "1")
        .env("RUSTFLAGS", "-Cembed-bitcode=yes")
        .env("CARGO_TARGET_DIR", package.join("target"))
        .env_remove("RUSTUP_TOOLCHAIN"))?;
    let built = package.join("target").join(WASM).join("release").join("deps");
    let mut libraries = Vec::new();
    for entry in fs::read_dir(&built).with_context(|| format!("cannot read {}", built.display()))? {
        let path = entry?.path();
        if path.extension().is_some_and(|extension| extension == "rlib") {
            libraries.push(path);
        }
    }
    Ok(libraries)
}

/// Makes the sysroot: the packaged host libraries by a link, ours for wasm32, and scripts that name the sysroot.
fn lay_down(sysroot: &Path, libraries: &[PathBuf]) -> Result<()> {
    let partial = sysroot.with_extension("partial");
    remove(&partial)?;
    let rustlib = partial.join("lib").join("rustlib");
    let wasm = rustlib.join(WASM).join("lib");
    fs::create_dir_all(&wasm)?;
    for library in libraries {
        fs::copy(library, wasm.join(library.file_name().unwrap_or_default()))?;
    }
    let host = host()?;
    link(&Path::new("/usr/lib/rustlib").join(&host), &rustlib.join(&host))?;
    let bin = partial.join("bin");
    fs::create_dir_all(&bin)?;
    for program in ["rustc", "rustdoc"] {
        script(&bin, program, &format!("exec /usr/bin/{program} --sysroot '{}' \"$@\"", sysroot.display()))?;
    }
    // Clippy's driver is started by the packaged cargo-clippy, and takes its sysroot from this variable.
    for program in ["cargo", "cargo-clippy"] {
        script(&bin, program, &format!("SYSROOT='{}' exec /usr/bin/{program} \"$@\"", sysroot.display()))?;
    }
    fs::rename(&partial, sysroot).with_context(|| format!("cannot make {}", sysroot.display()))
}

/// The folder of the sysroot, which belongs to one version of the compiler.
fn sysroot() -> Result<PathBuf> {
    let cache = env::var_os("XDG_CACHE_HOME")
        .map(PathBuf::from)
        .or_else(|| Some(env::home_dir()?.join(".cache")))
        .context("there is no home directory for the cache")?;
    let version = read(program(RUSTC).arg("--version"))?;
    let number = version.split_whitespace().nth(1).unwrap_or("unknown");
    // A dot would end the name where the extension "partial" begins.
    Ok(cache.join("cipdeck").join(format!("wasm-rustc-{}", number.replace('.', "-"))))
}

fn host() -> Result<String> {
    let version = version(&mut program(RUSTC))?;
    let line = version.lines().find_map(|line| line.strip_prefix("host: "));
    Ok(line.context("rustc -vV names no host")?.to_owned())
}

fn version(rustc: &mut Command) -> Result<String> {
    read(rustc.arg("-vV"))
}

fn remove(folder: &Path) -> Result<()> {
    if folder.exists() {
        fs::remove_dir_all(folder).with_context(|| format!("cannot remove {}", folder.display()))?;
    }
    Ok(())
}

fn script(bin: &Path, name: &str, line: &str) -> Result<()> {
    let path = bin.join(name);
    fs::write(&path, format!("#!/bin/sh\n{line}\n"))?;
    run(program("chmod").arg("+x").arg(path))
}

#[cfg(unix)]
fn link(from: &Path, to: &Path) -> Result<()> {
    Ok(std::os::unix::fs::symlink(from, to)?)
}

#[cfg(not(unix))]
fn link(_: &Path, _: &Path) -> Result<()> {
    anyhow::bail!("Debian's packages are for Linux")
}

/// The toolchain's name for rustup.
const NAME: &str = "cipdeck-wasm";

const RUSTC: &str = "/usr/bin/rustc";
const CARGO: &str = "/usr/bin/cargo";

/// Debian's compiler for its browsers, newer than its own release; `/usr/bin/rust-lld` is a link into lld-22.
const PACKAGES: &[&str] =
    &["rustc-web", "cargo-web", "rust-web-src", "rust-web-llvm", "rust-web-clippy", "lld-22"];

const EMPTY_PACKAGE: &str = r#"[package]
name = "wasm-std"
version = "0.0.0"
edition = "2021"

[lib]
path = "lib.rs"

[workspace]
"#;
