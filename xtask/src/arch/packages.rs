//! The arrows between packages, read from their Cargo.toml.

use std::{fs, path::Path};

use anyhow::{Context, Result};
use toml::{Table, Value};

/// Each package's folder, its name, and those of ours that it may depend on.
const PACKAGES: &[(&str, &str, &[&str])] = &[
    ("shared", "cipdeck-shared", &[]),
    ("relay", "cipdeck-relay", &["cipdeck-shared"]),
    ("frontend", "cipdeck-frontend", &["cipdeck-shared"]),
    ("tests", "cipdeck-tests", &["cipdeck-relay", "cipdeck-shared"]),
    ("xtask", "xtask", &[]),
];

/// What `shared` may take from elsewhere: nothing that does I/O.
const PURE: &[&str] = &["roxmltree", "serde", "serde_json", "thiserror", "utoipa", "winnow", "zmij"];

/// Every dependency that the table does not allow.
pub(super) fn violations(root: &Path) -> Result<Vec<String>> {
    let mut found = Vec::new();
    for member in members(&read(&root.join("Cargo.toml"))?) {
        let Some((_, _, allowed)) = PACKAGES.iter().find(|(folder, ..)| *folder == member) else {
            found.push(format!("Cargo.toml: {member} is not in the table of packages (xtask/src/arch)"));
            continue;
        };
        let manifest = read(&root.join(&member).join("Cargo.toml"))?;
        for name in dependencies(&manifest, &["dependencies", "dev-dependencies", "build-dependencies"]) {
            if PACKAGES.iter().any(|(_, ours, _)| *ours == name) && !allowed.contains(&name.as_str()) {
                found.push(format!("{member}/Cargo.toml: {member} must not depend on {name}"));
            }
        }
        if member == "shared" {
            for name in dependencies(&manifest, &["dependencies", "build-dependencies"]) {
                if !PURE.contains(&name.as_str()) && !name.starts_with("cipdeck-") {
                    found.push(format!("shared/Cargo.toml: shared is pure, it must not depend on {name}"));
                }
            }
        }
    }
    Ok(found)
}

fn read(path: &Path) -> Result<Table> {
    let text = fs::read_to_string(path).with_context(|| format!("cannot read {}", path.display()))?;
    text.parse().with_context(|| format!("cannot parse {}", path.display()))
}

fn members(manifest: &Table) -> Vec<String> {
    let members = manifest.get("workspace").and_then(|workspace| workspace.get("members"));
    let list = members.and_then(Value::as_array).into_iter().flatten();
    list.filter_map(Value::as_str).map(str::to_owned).collect()
}

/// The names in these tables, also in those for one target only.
fn dependencies(manifest: &Table, tables: &[&str]) -> Vec<String> {
    let for_targets = manifest.get("target").and_then(Value::as_table).into_iter().flat_map(Table::values);
    std::iter::once(manifest)
        .chain(for_targets.filter_map(Value::as_table))
        .flat_map(|owner| tables.iter().filter_map(|table| owner.get(*table)?.as_table()))
        .flat_map(|table| table.iter().map(|(name, value)| package(name, value)))
        .collect()
}

/// The package's name, which a dependency may carry under another one.
fn package(name: &str, value: &Value) -> String {
    value.get("package").and_then(Value::as_str).unwrap_or(name).to_owned()
}

#[cfg(test)]
mod tests {
    use super::*;

    fn workspace(packages: &[(&str, &str)]) -> tempfile::TempDir {
        let root = tempfile::tempdir().unwrap();
        let members: Vec<_> = packages.iter().map(|(folder, _)| format!("\"{folder}\"")).collect();
        fs::write(root.path().join("Cargo.toml"), format!("[workspace]\nmembers = [{}]", members.join(",")))
            .unwrap();
        for (folder, manifest) in packages {
            fs::create_dir(root.path().join(folder)).unwrap();
            fs::write(root.path().join(folder).join("Cargo.toml"), manifest).unwrap();
        }
        root
    }

    #[test]
    fn the_page_must_not_depend_on_the_relay_not_even_under_another_name() {
        let root = workspace(&[(
            "frontend",
            "[dependencies]\ncipdeck-shared = {}\n[target.'cfg(unix)'.dev-dependencies]\nhost = { package = \"cipdeck-relay\" }",
        )]);
        assert_eq!(
            violations(root.path()).unwrap(),
            ["frontend/Cargo.toml: frontend must not depend on cipdeck-relay"]
        );
    }

    #[test]
    fn nobody_depends_on_the_tests_and_xtask_on_nothing_of_ours() {
        let root = workspace(&[
            ("relay", "[dev-dependencies]\ncipdeck-tests = {}"),
            ("xtask", "[dependencies]\ncipdeck-shared.workspace = true"),
        ]);
        assert_eq!(violations(root.path()).unwrap().len(), 2);
    }

    #[test]
    fn shared_takes_nothing_that_does_io() {
        let root = workspace(&[("shared", "[dependencies]\nserde = \"1\"\ntokio = \"1\"")]);
        assert_eq!(
            violations(root.path()).unwrap(),
            ["shared/Cargo.toml: shared is pure, it must not depend on tokio"]
        );
    }
}
