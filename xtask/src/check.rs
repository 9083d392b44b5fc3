//! `cargo xtask check`: what can be said about the sources without running the product, cheap things first.

use std::process::Command;

use anyhow::{Result, bail};

use crate::{
    arch,
    process::{cargo, program, run},
    report::Report,
    toolchain::{self, Preference, WASM},
    tools, workspace,
};

/// Format, lints on host and wasm32, layers, documentation, dependencies.
pub(crate) fn all(report: &mut Report, preference: Preference) -> Result<()> {
    report.step("check: format", || run(cargo().args(["fmt", "--all", "--check"])))?;
    report.step("check: layers", || arch::check(&workspace::root()))?;
    report.step("check: lints (host)", || {
        run(cargo().args(["clippy", "--workspace", "--all-targets", "--", "-D", "warnings"]))
    })?;
    let wasm = toolchain::find(report, preference)?;
    report.step("check: lints (wasm32)", || {
        run(wasm
            .cargo()
            .args(["clippy", "-p", "cipdeck-shared", "-p", "cipdeck-frontend", "--all-targets"])
            .args(["--target", WASM, "--profile", "page", "--", "-D", "warnings"]))
    })?;
    report.step("check: shared alone compiles to wasm32", || {
        run(wasm.cargo().args(["check", "-p", "cipdeck-shared", "--target", WASM, "--profile", "page"]))
    })?;
    report.step("check: documentation", || {
        run(cargo().args(["doc", "--workspace", "--no-deps"]).env("RUSTDOCFLAGS", "-D warnings"))
    })?;
    report.step("tool: cargo-deny", tools::cargo_deny)?;
    report.step("check: licences, sources, bans", || {
        run(deny()?.args(["check", "--hide-inclusion-graph", "bans", "licenses", "sources"]))
    })?;
    report.step("check: advisories", advisories)
}

/// Known faults of dependencies, where their list can be fetched; without network this says so and passes.
fn advisories() -> Result<()> {
    if let Err(error) = run(deny()?.args(["fetch", "db"])) {
        println!("    not checked: the advisory database is out of reach ({error:#})");
        return Ok(());
    }
    run(deny()?.args(["check", "--disable-fetch", "advisories"]))
}

fn deny() -> Result<Command> {
    let mut command = program("cargo-deny");
    command.env("PATH", tools::path()?);
    let root = workspace::root();
    if !root.join("deny.toml").is_file() {
        bail!("deny.toml is missing");
    }
    Ok(command)
}
