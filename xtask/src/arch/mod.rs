//! `cargo xtask arch`: the arrows between layers and packages, compared with what the sources import.

mod imports;
mod packages;

use std::{
    fs,
    path::{Path, PathBuf},
};

use anyhow::{Context, Result, bail};

use self::imports::{Import, Origin};

/// The layers of `shared`, and what each may import from its own crate. An entry `engine::time` allows that module alone.
const LAYERS: &[(&str, &[&str])] = &[
    ("wire", &[]),
    ("table", &["wire"]),
    ("dissect", &["wire", "table", "tag"]),
    ("config", &["wire", "tag::Display", "tag::Scale"]),
    (
        "tag",
        &[
            "wire",
            "table",
            "config::Profile",
            "config::NumberError",
            "config::read_number",
            "config::space_hex",
            "config::write_hex",
        ],
    ),
    ("plan", &["config", "wire", "table", "tag"]),
    ("code", &["config", "plan", "wire", "table", "tag"]),
    (
        "engine",
        &[
            "wire",
            "plan",
            "tag",
            "config::BlockId",
            "config::Channel",
            "config::Profile",
            "config::SendReqForm",
            "config::Target",
        ],
    ),
    ("sim", &["wire", "engine::time", "tag", "config::Profile"]),
    (
        "api",
        &[
            "config",
            "dissect::Decoded",
            "plan",
            "table",
            "tag",
            "wire::Epath",
            "wire::ListIdentityItem",
            "wire::Segment",
            "engine::BlockView",
            "engine::Cause",
            "engine::CipStatus",
            "engine::Exchange",
            "engine::Management",
            "engine::Phase",
            "engine::StatusBits",
            "engine::TargetState",
            "engine::TargetView",
        ],
    ),
];

/// Crates that bring I/O or a clock: never named in `shared`.
const IMPURE: &[&str] = &["std", "tokio", "axum", "rusqlite", "web_sys", "js_sys", "yew"];

/// Reads the workspace in this folder, and fails with every import that the tables do not allow.
pub(crate) fn check(root: &Path) -> Result<()> {
    let mut violations = packages::violations(root)?;
    let sources = root.join("shared").join("src");
    for file in rust_files(&sources)? {
        let text = fs::read_to_string(&file).with_context(|| format!("cannot read {}", file.display()))?;
        let module = module_of(file.strip_prefix(&sources)?);
        let shown = file.strip_prefix(root)?.display().to_string();
        let found = in_file(&module, &text);
        violations.extend(found.iter().map(|found| format!("{shown}:{}: {}", found.line, found.what)));
    }
    if violations.is_empty() {
        println!("    every import follows the layers");
        return Ok(());
    }
    for violation in &violations {
        eprintln!("    {violation}");
    }
    bail!("{} forbidden import(s)", violations.len());
}

/// An import that the table does not allow.
#[derive(Debug)]
struct Found {
    line: usize,
    what: String,
}

/// The imports in one file of `shared` that the table does not allow.
fn in_file(module: &[String], text: &str) -> Vec<Found> {
    let Some(layer) = module.first() else {
        return Vec::new(); // lib.rs declares the layers; it imports nothing
    };
    let Some((_, allowed)) = LAYERS.iter().find(|(name, _)| name == layer) else {
        let what = format!("the module {layer} is not in the table of layers (xtask/src/arch)");
        return vec![Found { line: 1, what }];
    };
    let imports = imports::read(text, module.len());
    imports.iter().filter_map(|import| judge(layer, allowed, import)).collect()
}

fn judge(layer: &str, allowed: &[&str], import: &Import) -> Option<Found> {
    let path = import.path.join("::");
    let first = import.path.first().map_or("", String::as_str);
    let line = import.line;
    let inside = match import.origin {
        Origin::Crate => true,
        Origin::Super => LAYERS.iter().any(|(name, _)| *name == first),
        Origin::Name => false,
    };
    if !inside {
        let impure = import.origin == Origin::Name && IMPURE.contains(&first);
        let what = format!("shared is pure, it must not name {path}");
        return impure.then_some(Found { line, what });
    }
    if first == layer || allowed.iter().any(|entry| covers(entry, &path)) {
        return None;
    }
    let list = if allowed.is_empty() { "nothing".to_owned() } else { allowed.join(", ") };
    Some(Found { line, what: format!("{layer} may import {list}, not crate::{path}") })
}

/// Whether the entry `engine::time` allows the path `engine::time::Instant`.
fn covers(entry: &str, path: &str) -> bool {
    path.strip_prefix(entry).is_some_and(|rest| rest.is_empty() || rest.starts_with("::"))
}

/// `engine/session.rs` is the module `engine`, `session`; `engine/mod.rs` is `engine`; `lib.rs` is the root.
fn module_of(file: &Path) -> Vec<String> {
    let mut module: Vec<String> =
        file.with_extension("").iter().map(|part| part.to_string_lossy().into_owned()).collect();
    if module.last().is_some_and(|last| last == "mod" || last == "lib") {
        module.pop();
    }
    module
}

/// The sources below a folder, without those that are tests.
fn rust_files(folder: &Path) -> Result<Vec<PathBuf>> {
    let mut files = Vec::new();
    let entries = fs::read_dir(folder).with_context(|| format!("cannot read {}", folder.display()))?;
    for entry in entries {
        let path = entry?.path();
        let name = path.file_stem().unwrap_or_default();
        if name == "tests" {
            continue;
        }
        if path.is_dir() {
            files.extend(rust_files(&path)?);
        } else if path.extension().is_some_and(|extension| extension == "rs") {
            files.push(path);
        }
    }
    files.sort();
    Ok(files)
}

#[cfg(test)]
mod tests {
    use super::*;

    fn found(file: &str, text: &str) -> Vec<String> {
        let found = in_file(&module_of(Path::new(file)), text);
        found.iter().map(|found| format!("{}: {}", found.line, found.what)).collect()
    }

    #[test]
    fn a_layer_may_import_itself_and_what_the_table_gives_it() {
        assert!(
            found("plan/request.rs", "use crate::{config::Block, plan::Finding, wire::{Epath, open}};")
                .is_empty()
        );
    }

    #[test]
    fn an_arrow_upwards_is_named_with_its_line() {
        assert_eq!(
            found("wire/epath.rs", "\nuse crate::plan::Finding;"),
            ["2: wire may import nothing, not crate::plan::Finding"]
        );
    }

    #[test]
    fn a_path_in_an_expression_counts_like_an_import() {
        assert_eq!(found("table/mod.rs", "fn f() { crate::sim::start() }").len(), 1);
    }

    #[test]
    fn super_does_not_lead_around_the_table() {
        assert_eq!(
            found("config/path.rs", "use super::super::engine::Client;"),
            ["1: config may import wire, tag::Display, tag::Scale, not crate::engine::Client"]
        );
        assert!(found("config/path.rs", "use super::block::Block;").is_empty());
        assert!(found("config/mod.rs", "mod inline { use super::Block; }").is_empty());
    }

    #[test]
    fn the_simulator_sees_the_engine_s_time_and_nothing_else_of_it() {
        assert!(found("sim/mod.rs", "use crate::engine::time::Instant;").is_empty());
        assert_eq!(found("sim/mod.rs", "use crate::engine::{time::Instant, Client};").len(), 1);
    }

    #[test]
    fn the_engine_sees_the_names_of_things_and_not_their_configuration() {
        assert!(found("engine/entry.rs", "use crate::config::{BlockId, Channel, Target};").is_empty());
        assert_eq!(found("engine/entry.rs", "use crate::config::{Target, MsgCipGeneric};").len(), 1);
    }

    #[test]
    fn the_interface_shows_what_the_engine_shows_and_not_the_engine() {
        assert!(found("api/status.rs", "use crate::engine::{BlockView, Phase, StatusBits};").is_empty());
        assert_eq!(found("api/status.rs", "use crate::engine::Engine;").len(), 1);
    }

    #[test]
    fn shared_names_neither_std_nor_an_io_crate() {
        assert_eq!(found("engine/mod.rs", "use std::time::Instant;").len(), 1);
        assert_eq!(found("engine/mod.rs", "async fn f() { tokio::time::sleep(d).await }").len(), 1);
        assert!(found("engine/mod.rs", "use core::time::Duration; use alloc::vec::Vec;").is_empty());
    }

    #[test]
    fn comments_texts_and_unit_tests_are_not_imports() {
        let text = "/// See [`crate::sim`].\nconst A: &str = \"crate::sim\";\n#[cfg(test)]\nmod tests {\n use crate::sim;\n use std::vec;\n}";
        assert!(found("wire/mod.rs", text).is_empty());
    }

    #[test]
    fn a_module_that_the_table_does_not_know_is_an_error() {
        assert_eq!(found("utils.rs", "").len(), 1);
    }
}
