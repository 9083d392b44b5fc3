//! The files of the page: names that change with their content, so that a browser may keep them for ever.

use std::{
    collections::BTreeMap,
    fs,
    hash::{DefaultHasher, Hash, Hasher},
    io::ErrorKind,
    path::Path,
};

use anyhow::{Context, Result, bail};

/// What people write: the page, its boot script, its picture and its styles.
#[derive(Debug, Hash)]
pub(crate) struct Sources {
    index: String,
    boot: String,
    icon: String,
    styles: String,
}

impl Sources {
    /// Reads the sources in the folder `frontend`.
    pub(crate) fn read(frontend: &Path) -> Result<Self> {
        let text = |name: &str| {
            let path = frontend.join(name);
            fs::read_to_string(&path).with_context(|| format!("cannot read {}", path.display()))
        };
        Ok(Self {
            index: text("index.html")?,
            boot: text("boot.js")?,
            icon: text("icon.svg")?,
            styles: styles(&frontend.join("styles"))?,
        })
    }
}

/// What wasm-bindgen made.
#[derive(Debug)]
pub(crate) struct Bound {
    /// The module, as the browser loads it.
    pub(crate) wasm: Vec<u8>,
    /// Its JavaScript.
    pub(crate) script: String,
    /// Scripts of its crates: path below the page, text.
    pub(crate) snippets: Vec<(String, String)>,
}

/// The files of the page: path below `frontend/dist` to content.
pub(crate) type Files = BTreeMap<String, Vec<u8>>;

/// Gives each file its hashed name, and writes these names into the files that refer to it.
pub(crate) fn assemble(sources: &Sources, bound: Bound) -> Result<Files> {
    let mut files: Files = bound.snippets.into_iter().map(|(path, text)| (path, text.into_bytes())).collect();
    let wasm = add(&mut files, "page.wasm", bound.wasm);
    let script = add(&mut files, "page.js", bound.script.into_bytes());
    let icon = add(&mut files, "icon.svg", sources.icon.clone().into_bytes());
    let styles = add(&mut files, "styles.css", sources.styles.clone().into_bytes());
    let boot = refer(&sources.boot, "boot.js", &[("./page.wasm", &wasm), ("./page.js", &script)])?;
    let boot = add(&mut files, "boot.js", boot.into_bytes());
    let index = refer(
        &sources.index,
        "index.html",
        &[
            ("/icon.svg", &icon),
            ("/styles.css", &styles),
            ("/page.wasm", &wasm),
            ("/page.js", &script),
            ("/boot.js", &boot),
        ],
    )?;
    files.insert("index.html".to_owned(), index.into_bytes());
    Ok(files)
}

/// Makes the folder hold exactly these files, without touching one that has its content already.
pub(crate) fn write(dist: &Path, files: &Files) -> Result<()> {
    remove_others(dist, "", files)?;
    for (name, content) in files {
        let path = dist.join(name);
        if fs::read(&path).is_ok_and(|present| present == *content) {
            continue;
        }
        if let Some(folder) = path.parent() {
            fs::create_dir_all(folder)?;
        }
        fs::write(&path, content).with_context(|| format!("cannot write {}", path.display()))?;
        println!("    {name}: {} kB", content.len().div_ceil(1000));
    }
    Ok(())
}

fn remove_others(dist: &Path, below: &str, files: &Files) -> Result<()> {
    let entries = match fs::read_dir(dist.join(below)) {
        Ok(entries) => entries,
        Err(error) if error.kind() == ErrorKind::NotFound => return Ok(()),
        Err(error) => return Err(error).context("cannot read frontend/dist"),
    };
    for entry in entries {
        let entry = entry?;
        let name = format!("{below}{}", entry.file_name().to_string_lossy());
        if entry.file_type()?.is_dir() {
            remove_others(dist, &format!("{name}/"), files)?;
        } else if !files.contains_key(&name) {
            fs::remove_file(entry.path())?;
        }
    }
    Ok(())
}

/// Adds a file under a name with its hash: `page.js` becomes `page-0123456789abcdef.js`.
fn add(files: &mut Files, name: &str, content: Vec<u8>) -> String {
    let mut hasher = DefaultHasher::new();
    content.hash(&mut hasher);
    let (stem, extension) = name.split_once('.').unwrap_or((name, ""));
    let name = format!("{stem}-{:016x}.{extension}", hasher.finish());
    files.insert(name.clone(), content);
    name
}

/// Replaces each quoted reference (`"/page.js"`) by the hashed name; a reference that is not there is an error.
fn refer(text: &str, file: &str, names: &[(&str, &str)]) -> Result<String> {
    let mut text = text.to_owned();
    for (reference, hashed) in names {
        let quoted = format!("\"{reference}\"");
        if !text.contains(&quoted) {
            bail!("frontend/{file} does not refer to {quoted}");
        }
        let folder = reference.rfind('/').map_or("", |slash| &reference[..=slash]);
        text = text.replace(&quoted, &format!("\"{folder}{hashed}\""));
    }
    Ok(text)
}

/// All style sheets as one: tokens, then base, then the others by name.
fn styles(folder: &Path) -> Result<String> {
    let mut sheets: Vec<String> = match fs::read_dir(folder) {
        Ok(entries) => {
            entries.flatten().map(|entry| entry.file_name().to_string_lossy().into_owned()).collect()
        }
        Err(_) => Vec::new(),
    };
    sheets.retain(|name| Path::new(name).extension().is_some_and(|extension| extension == "css"));
    sheets.sort_by_key(|name| (name != "tokens.css", name != "base.css", name.clone()));
    let mut all = String::new();
    for sheet in sheets {
        all += &fs::read_to_string(folder.join(&sheet)).with_context(|| format!("cannot read {sheet}"))?;
    }
    Ok(all)
}

#[cfg(test)]
mod tests {
    use super::*;

    fn sources(boot: &str) -> Sources {
        Sources {
            index: r#"<link href="/styles.css"><link href="/icon.svg"><link href="/page.wasm"><link href="/page.js"><script src="/boot.js">"#.into(),
            boot: boot.into(),
            icon: "<svg/>".into(),
            styles: "a{}".into(),
        }
    }

    fn bound(wasm: &[u8]) -> Bound {
        Bound { wasm: wasm.to_vec(), script: "export default 1".into(), snippets: Vec::new() }
    }

    fn index(files: &Files) -> String {
        String::from_utf8(files["index.html"].clone()).unwrap()
    }

    const BOOT: &str = r#"import init from "./page.js"; init("./page.wasm")"#;

    #[test]
    fn every_file_that_the_page_names_exists_under_its_hashed_name() {
        let files = assemble(&sources(BOOT), bound(b"\0asm")).unwrap();
        let page = index(&files);
        let named: Vec<_> = files.keys().filter(|name| *name != "index.html").collect();
        assert_eq!(named.len(), 5);
        for name in named {
            assert!(page.contains(&format!("\"/{name}\"")), "{name} is not in {page}");
        }
    }

    #[test]
    fn a_changed_module_changes_its_name_and_the_names_of_those_that_refer_to_it() {
        let one = assemble(&sources(BOOT), bound(b"one")).unwrap();
        let two = assemble(&sources(BOOT), bound(b"two")).unwrap();
        let same = one.keys().filter(|name| two.contains_key(*name)).collect::<Vec<_>>();
        assert!(same.iter().all(|name| !name.starts_with("boot") && !name.ends_with("wasm")), "{same:?}");
        assert_ne!(index(&one), index(&two));
    }

    #[test]
    fn a_boot_script_that_names_no_module_is_refused() {
        let error = assemble(&sources("nothing"), bound(b"")).unwrap_err().to_string();
        assert_eq!(error, r#"frontend/boot.js does not refer to "./page.wasm""#);
    }

    #[test]
    fn writing_again_touches_nothing_and_removes_what_is_old() {
        let folder = tempfile::tempdir().unwrap();
        let dist = folder.path().join("dist");
        write(&dist, &assemble(&sources(BOOT), bound(b"one")).unwrap()).unwrap();
        let two = assemble(&sources(BOOT), bound(b"two")).unwrap();
        write(&dist, &two).unwrap();
        let present = || {
            let mut all: Vec<_> = fs::read_dir(&dist)
                .unwrap()
                .map(|entry| entry.unwrap())
                .map(|entry| {
                    (entry.file_name().into_string().unwrap(), entry.metadata().unwrap().modified().unwrap())
                })
                .collect();
            all.sort();
            all
        };
        let before = present();
        assert_eq!(before.iter().map(|(name, _)| name).collect::<Vec<_>>(), two.keys().collect::<Vec<_>>());
        write(&dist, &two).unwrap();
        assert_eq!(present(), before);
    }
}
