//! The page: compiled to wasm, given its JavaScript by wasm-bindgen, laid down in `frontend/dist`.

use std::{
    fs,
    hash::{DefaultHasher, Hash, Hasher},
    path::Path,
};

use anyhow::{Context, Result};
use wasm_bindgen_cli_support::Bindgen;

use crate::{
    page::{self, DOCUMENTS, Document, Files, Sources},
    process::run,
    report::Report,
    toolchain::{WASM, WasmToolchain},
    workspace,
};

/// How the page is compiled.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Profile {
    /// Compiled quickly, for `run` and `test`.
    Quick,
    /// Optimised for size, for `dist`.
    Shipped,
}

impl Profile {
    /// The profile's name in Cargo.toml; also the name of its folder.
    fn name(self) -> &'static str {
        match self {
            Self::Quick => "page",
            Self::Shipped => "wasm",
        }
    }
}

/// Builds the page. `frontend/dist` is touched only where its content changes, so that the relay is not linked again for nothing.
pub(crate) fn build(report: &mut Report, wasm: &WasmToolchain, profile: Profile) -> Result<()> {
    report.step("page: compile to wasm32", || compile(wasm, profile))?;
    let compiled = wasm.target().join(WASM).join(profile.name());
    report.step("page: wasm-bindgen, hashed names, frontend/dist", || lay_down(&compiled, profile))
}

fn compile(wasm: &WasmToolchain, profile: Profile) -> Result<()> {
    run(wasm.cargo().args(["build", "--package", "cipdeck-frontend", "--bins"]).args([
        "--target",
        WASM,
        "--profile",
        profile.name(),
    ]))
}

fn lay_down(compiled: &Path, profile: Profile) -> Result<()> {
    let mut modules = Vec::new();
    for document in DOCUMENTS {
        let path = compiled.join(format!("{}.wasm", document.binary));
        modules.push(fs::read(&path).with_context(|| format!("cannot read {}", path.display()))?);
    }
    let sources = Sources::read(&workspace::root().join("frontend"))?;
    let state = fingerprint(&modules, &sources);
    let (dist, stamp) = (workspace::page(), workspace::root().join("frontend").join("dist.stamp"));
    let is_there = DOCUMENTS.iter().all(|document| dist.join(document.index).is_file());
    if is_there && fs::read_to_string(&stamp).is_ok_and(|last| last == state) {
        println!("    unchanged");
        return Ok(());
    }
    let mut files = Files::new();
    for (document, module) in DOCUMENTS.into_iter().zip(modules) {
        page::assemble(&mut files, document, &sources, bind(document, module, profile)?)?;
    }
    if profile == Profile::Shipped {
        page::zip(&mut files)?;
    }
    page::write(&dist, &files)?;
    fs::write(&stamp, state).context("cannot write the page's stamp")
}

/// The JavaScript and the wasm of a compiled module, and the snippets that its crates bring along.
fn bind(document: Document, module: Vec<u8>, profile: Profile) -> Result<page::Bound> {
    let mut output = Bindgen::new()
        .input_bytes(document.name, module)
        .web(true)?
        .typescript(false)
        .omit_default_module_path(true)
        .remove_name_section(profile == Profile::Shipped)
        .remove_producers_section(true)
        .generate_output()
        .context("wasm-bindgen")?;
    let mut snippets = Vec::new();
    for (name, texts) in output.snippets() {
        for (number, text) in texts.iter().enumerate() {
            snippets.push((format!("snippets/{name}/inline{number}.js"), text.clone()));
        }
    }
    for (path, text) in output.local_modules() {
        snippets.push((format!("snippets/{path}"), text.clone()));
    }
    let script = output.js().to_owned();
    Ok(page::Bound { wasm: output.wasm_mut().emit_wasm(), script, snippets })
}

/// Changes when anything changes that the page is made of.
fn fingerprint(modules: &[Vec<u8>], sources: &Sources) -> String {
    let mut hasher = DefaultHasher::new();
    modules.hash(&mut hasher);
    sources.hash(&mut hasher);
    format!("{:016x}", hasher.finish())
}
