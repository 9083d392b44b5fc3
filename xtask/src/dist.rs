//! `cargo xtask dist`: the one binary that users get, and the size of the page in it.

use std::{
    fs,
    path::{Path, PathBuf},
};

use anyhow::{Context, Result, bail};
use flate2::{Compression, write::GzEncoder};

use crate::{
    frontend::{self, Profile},
    process::{cargo, run},
    report::Report,
    toolchain::{self, Preference},
    workspace,
};

/// Builds the page for its size and the relay for its speed, and leaves `target/dist/cipdeck`.
pub(crate) fn build(report: &mut Report, preference: Preference) -> Result<()> {
    let wasm = toolchain::find(report, preference)?;
    frontend::build(report, &wasm, Profile::Shipped)?;
    report.step("size of the page", || measure(&workspace::page()))?;
    report.step("relay: release build", || {
        run(cargo().args(["build", "-p", "cipdeck-relay", "--bin", "cipdeck", "--release"]))
    })?;
    let binary = report.step("target/dist", copy)?;
    report.say(&format!("{}: {} kB", binary.display(), kilobytes(&binary)?));
    Ok(())
}

/// Prints each file's size, and fails where what a browser loads is over the budget.
fn measure(page: &Path) -> Result<()> {
    let mut total = 0;
    for (name, content) in loaded(page, page)? {
        let zipped = gzipped(&content)?;
        total += zipped;
        println!("    {:>7} kB {:>7} kB gz  {name}", content.len().div_ceil(1000), zipped.div_ceil(1000));
    }
    println!("    {:>21} kB gz of {} kB", total.div_ceil(1000), BUDGET / 1000);
    if total > BUDGET {
        bail!("the page is larger than its budget");
    }
    Ok(())
}

/// The wasm, the scripts and the styles.
fn loaded(page: &Path, folder: &Path) -> Result<Vec<(String, Vec<u8>)>> {
    let mut files = Vec::new();
    for entry in fs::read_dir(folder).with_context(|| format!("cannot read {}", folder.display()))? {
        let path = entry?.path();
        if path.is_dir() {
            files.extend(loaded(page, &path)?);
        } else if path.extension().is_some_and(|kind| kind == "wasm" || kind == "js" || kind == "css") {
            files.push((path.strip_prefix(page)?.display().to_string(), fs::read(&path)?));
        }
    }
    files.sort();
    Ok(files)
}

/// The length after gzip, as a server sends it.
fn gzipped(content: &[u8]) -> Result<usize> {
    let mut encoder = GzEncoder::new(Vec::new(), Compression::best());
    std::io::Write::write_all(&mut encoder, content)?;
    Ok(encoder.finish()?.len())
}

fn copy() -> Result<PathBuf> {
    let name = format!("cipdeck{}", std::env::consts::EXE_SUFFIX);
    let folder = workspace::target().join("dist");
    fs::create_dir_all(&folder)?;
    let to = folder.join(&name);
    fs::copy(workspace::target().join("release").join(&name), &to)
        .with_context(|| format!("cannot write {}", to.display()))?;
    Ok(to)
}

fn kilobytes(path: &Path) -> Result<u64> {
    Ok(fs::metadata(path)?.len().div_ceil(1000))
}

/// Bytes of wasm, JavaScript and CSS together, after gzip.
const BUDGET: usize = 400_000;

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_page_over_the_budget_fails() {
        let page = tempfile::tempdir().expect("a folder");
        let mut state = 1_u64;
        let noise = |_| {
            // xorshift: bytes that gzip cannot make smaller
            state ^= state << 13;
            state ^= state >> 7;
            state ^= state << 17;
            state.to_le_bytes()[3]
        };
        let content: Vec<u8> = (0..=BUDGET).map(noise).collect();
        fs::write(page.path().join("page.wasm"), &content).expect("written");
        assert!(measure(page.path()).is_err());
        fs::write(page.path().join("page.wasm"), &content[..1000]).expect("written");
        assert!(measure(page.path()).is_ok());
    }
}
