//! A compiler for wasm32-unknown-unknown: the installed one, rustup's, or one made of Debian's packages.

mod debian;

use std::{
    fmt::{Display, Formatter},
    path::{Path, PathBuf},
    process::Command,
};

use anyhow::{Result, bail};
use clap::Args;

use crate::{
    process::{cargo, find as find_program, program, read, run},
    report::Report,
    system::Consent,
    workspace,
};

/// The target of the page.
pub(crate) const WASM: &str = "wasm32-unknown-unknown";

/// What the caller wants of the search for a compiler.
#[derive(Clone, Copy, Debug, Default, Args)]
pub(crate) struct Preference {
    #[command(flatten)]
    pub(crate) consent: Consent,
    /// Use Debian's packages for wasm32 even where rustup has the target.
    #[arg(long)]
    pub(crate) debian: bool,
}

/// A compiler that has the std library of wasm32.
#[derive(Debug)]
pub(crate) struct WasmToolchain {
    /// The name for `RUSTUP_TOOLCHAIN`; the caller's own toolchain without one.
    name: Option<String>,
}

impl WasmToolchain {
    /// A cargo command that compiles for wasm32 into a target folder of its own.
    pub(crate) fn cargo(&self) -> Command {
        let mut command = cargo();
        self.prepare(&mut command);
        command
    }

    /// Makes a command, and every cargo that it starts, use this compiler and its target folder.
    pub(crate) fn prepare(&self, command: &mut Command) {
        command.env("CARGO_TARGET_DIR", self.target());
        if let Some(name) = &self.name {
            command.env("RUSTUP_TOOLCHAIN", name).env_remove("RUSTC").env_remove("CARGO");
        }
    }

    /// Compilers do not share a target folder: each would build everything again after the other.
    pub(crate) fn target(&self) -> PathBuf {
        workspace::target().join(if self.name.is_some() { "wasm-debian" } else { "wasm" })
    }
}

impl Display for WasmToolchain {
    fn fmt(&self, f: &mut Formatter<'_>) -> std::fmt::Result {
        f.write_str(self.name.as_deref().unwrap_or("the present toolchain has the target"))
    }
}

/// Finds a compiler, or installs one: the present toolchain, then rustup, then Debian's packages.
pub(crate) fn find(report: &mut Report, preference: Preference) -> Result<WasmToolchain> {
    report.step("wasm32: a compiler for the page", || {
        let found = search(preference)?;
        println!("    {found}");
        Ok(found)
    })
}

fn search(preference: Preference) -> Result<WasmToolchain> {
    if preference.debian {
        return debian::toolchain(preference);
    }
    if has_target(&mut program("rustc")) {
        return Ok(WasmToolchain { name: None });
    }
    if let Some(ready) = debian::linked() {
        return Ok(ready);
    }
    if find_program("rustup").is_none() {
        println!("    rustup is not installed");
    } else if run(program("rustup").args(["target", "add", WASM])).is_ok()
        && has_target(&mut program("rustc"))
    {
        return Ok(WasmToolchain { name: None });
    } else {
        println!("    rustup could not add the target");
    }
    if debian::is_possible() {
        println!("    trying Debian's packages");
        return debian::toolchain(preference);
    }
    bail!("{THREE_WAYS}");
}

/// Whether this rustc has a std library for wasm32.
fn has_target(rustc: &mut Command) -> bool {
    read(rustc.args(["--print", "target-libdir", "--target", WASM]))
        .is_ok_and(|folder| holds_core(Path::new(&folder)))
}

fn holds_core(folder: &Path) -> bool {
    folder.read_dir().is_ok_and(|mut entries| {
        entries
            .any(|entry| entry.is_ok_and(|entry| entry.file_name().to_string_lossy().starts_with("libcore")))
    })
}

const THREE_WAYS: &str = "the Rust compiler cannot build for wasm32-unknown-unknown, which the page needs. One of these helps:
  1. rustup:  install rustup, then `rustup target add wasm32-unknown-unknown`
  2. Debian:  as root, `cargo xtask toolchain --yes` (installs rustc-web and its std sources by apt-get)
  3. your system's packages: a rustc whose `rustc --print target-libdir --target wasm32-unknown-unknown` names a folder that exists";
