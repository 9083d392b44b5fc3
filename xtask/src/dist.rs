//! `cargo xtask dist`: the one binary that users get, and the size of the page in it.

use std::{
    fs,
    path::{Path, PathBuf},
};

use anyhow::{Context, Result, bail};

use crate::{
    frontend::{self, Profile},
    page::{self, DOCUMENTS, Document},
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

/// Prints each file's size, and fails where what a browser loads for one document is over the budget.
fn measure(page: &Path) -> Result<()> {
    for document in DOCUMENTS {
        let mut total = 0;
        for (name, content) in loaded(page, document)? {
            let zipped = page::gzipped(&content)?.len();
            total += zipped;
            println!("    {:>7} kB {:>7} kB gz  {name}", content.len().div_ceil(1000), zipped.div_ceil(1000));
        }
        println!(
            "    {:>17}.{} kB gz of {} kB  {}",
            total / 1000,
            total % 1000 / 100,
            BUDGET / 1000,
            document.index
        );
        if total > BUDGET {
            bail!("{} is larger than its budget", document.index);
        }
    }
    Ok(())
}

/// The wasm, the scripts and the styles that a document names, and the scripts that these bring along.
fn loaded(page: &Path, document: Document) -> Result<Vec<(String, Vec<u8>)>> {
    let index = page.join(document.index);
    let index = fs::read_to_string(&index).with_context(|| format!("cannot read {}", index.display()))?;
    let mut files = Vec::new();
    for name in index.split('"').filter_map(|quoted| quoted.strip_prefix('/')) {
        let kind = Path::new(name).extension();
        if kind.is_some_and(|kind| kind == "wasm" || kind == "js" || kind == "css") {
            let path = page.join(name);
            let content = fs::read(&path).with_context(|| format!("cannot read {}", path.display()))?;
            files.push((name.to_owned(), content));
        }
    }
    snippets(&page.join("snippets"), &mut files)?;
    files.sort();
    Ok(files)
}

fn snippets(folder: &Path, files: &mut Vec<(String, Vec<u8>)>) -> Result<()> {
    if !folder.is_dir() {
        return Ok(());
    }
    for entry in fs::read_dir(folder)? {
        let path = entry?.path();
        if path.is_dir() {
            snippets(&path, files)?;
        } else {
            files.push((path.display().to_string(), fs::read(&path)?));
        }
    }
    Ok(())
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

/// Bytes of a document's wasm, JavaScript and CSS together, after gzip.
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
        for document in DOCUMENTS {
            let module = format!("{}.wasm", document.name);
            fs::write(page.path().join(document.index), format!("<link href=\"/{module}\">"))
                .expect("written");
            fs::write(page.path().join(module), &content[..1000]).expect("written");
        }
        assert!(measure(page.path()).is_ok());
        fs::write(page.path().join("office.wasm"), &content).expect("written");
        let error = measure(page.path()).expect_err("too large").to_string();
        assert!(error.contains("office.html"), "{error}");
    }
}
