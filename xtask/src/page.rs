//! The files of the page: names that change with their content, so that a browser may keep them for ever.

use std::{
    collections::BTreeMap,
    fs,
    hash::{DefaultHasher, Hash, Hasher},
    io::ErrorKind,
    path::Path,
};

use anyhow::{Context, Result, bail};
use zopfli::{Format, Options};

use crate::squeeze;

/// A document of its own, with a module of its own: what somebody only looks at once a day is not loaded every day.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) struct Document {
    /// What its files are called.
    pub(crate) name: &'static str,
    /// The frontend's binary.
    pub(crate) binary: &'static str,
    /// The file that a browser asks for.
    pub(crate) index: &'static str,
    /// Its style sheets in `frontend/styles`, in this order.
    styles: &'static [&'static str],
}

/// All documents.
pub(crate) const DOCUMENTS: [Document; 6] = [
    Document {
        name: "page",
        binary: "cipdeck-page",
        index: "index.html",
        styles: &["tokens", "base", "kit", "access", "pages"],
    },
    Document {
        name: "office",
        binary: "cipdeck-office",
        index: "office.html",
        styles: &["tokens", "base", "kit", "access", "document", "office"],
    },
    Document {
        name: "devices",
        binary: "cipdeck-devices",
        index: "devices.html",
        styles: &["tokens", "base", "kit", "access", "document", "office", "devices"],
    },
    Document {
        name: "words",
        binary: "cipdeck-words",
        index: "words.html",
        styles: &["tokens", "base", "kit", "access", "document", "pages", "words"],
    },
    Document {
        name: "code",
        binary: "cipdeck-code",
        index: "code.html",
        styles: &["tokens", "base", "kit", "access", "document", "office", "code"],
    },
    Document {
        name: "take",
        binary: "cipdeck-take",
        index: "take.html",
        styles: &["tokens", "base", "kit", "access", "document", "office", "code"],
    },
];

/// What people write: the page, its boot script, its picture and its styles.
#[derive(Debug, Hash)]
pub(crate) struct Sources {
    index: String,
    boot: String,
    icon: String,
    /// By name, without its ending.
    styles: BTreeMap<String, String>,
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

    fn sheet(&self, document: Document) -> Result<String> {
        let mut all = String::new();
        for name in document.styles {
            all +=
                self.styles.get(*name).with_context(|| format!("there is no frontend/styles/{name}.css"))?;
        }
        Ok(squeeze::styles(&all))
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

/// Gives each file of a document its hashed name, and writes these names into the files that refer to it.
pub(crate) fn assemble(files: &mut Files, document: Document, sources: &Sources, bound: Bound) -> Result<()> {
    files.extend(bound.snippets.into_iter().map(|(path, text)| (path, text.into_bytes())));
    let name = |ending: &str| format!("{}.{ending}", document.name);
    let wasm = add(files, &name("wasm"), bound.wasm);
    let script = add(files, &name("js"), squeeze::script(&bound.script).into_bytes());
    let icon = add(files, "icon.svg", sources.icon.clone().into_bytes());
    let styles = add(files, &name("css"), sources.sheet(document)?.into_bytes());
    let boot = refer(&sources.boot, "boot.js", &[("./page.wasm", &wasm), ("./page.js", &script)])?;
    let boot = add(files, "boot.js", squeeze::script(&boot).into_bytes());
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
    files.insert(document.index.to_owned(), index.into_bytes());
    Ok(())
}

/// Adds a gzipped copy of each file that a browser loads: the relay sends it as it is.
pub(crate) fn zip(files: &mut Files) -> Result<()> {
    let mut zipped = Files::new();
    for (name, content) in &*files {
        if Path::new(name).extension().is_some_and(|kind| kind == "wasm" || kind == "js" || kind == "css") {
            zipped.insert(format!("{name}.gz"), gzipped(content)?);
        }
    }
    files.extend(zipped);
    Ok(())
}

/// As small as gzip gets: it is made once and loaded often.
pub(crate) fn gzipped(content: &[u8]) -> Result<Vec<u8>> {
    let mut zipped = Vec::new();
    zopfli::compress(Options::default(), Format::Gzip, content, &mut zipped)?;
    Ok(zipped)
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

/// All style sheets by name.
fn styles(folder: &Path) -> Result<BTreeMap<String, String>> {
    let mut sheets = BTreeMap::new();
    for entry in fs::read_dir(folder).with_context(|| format!("cannot read {}", folder.display()))? {
        let path = entry?.path();
        if path.extension().is_some_and(|extension| extension == "css") {
            let text =
                fs::read_to_string(&path).with_context(|| format!("cannot read {}", path.display()))?;
            let name = path.file_stem().unwrap_or_default().to_string_lossy().into_owned();
            sheets.insert(name, text);
        }
    }
    Ok(sheets)
}

#[cfg(test)]
mod tests {
    use super::*;

    fn sources(boot: &str) -> Sources {
        Sources {
            index: r#"<link href="/styles.css"><link href="/icon.svg"><link href="/page.wasm"><link href="/page.js"><script src="/boot.js">"#.into(),
            boot: boot.into(),
            icon: "<svg/>".into(),
            styles: ["tokens", "base", "kit", "access", "document", "pages", "office", "devices", "words", "code"].map(|name| (name.into(), format!(".{name} {{}}"))).into(),
        }
    }

    /// All documents, with this as the module of the first.
    fn assembled(boot: &str, wasm: &[u8]) -> Result<Files> {
        let mut files = Files::new();
        for (document, wasm) in
            DOCUMENTS.into_iter().zip([wasm, b"office", b"plants", b"send_req", b"import", b"export"])
        {
            let bound = Bound {
                wasm: wasm.to_vec(),
                script: format!("export {{{}}}", document.name),
                snippets: Vec::new(),
            };
            assemble(&mut files, document, &sources(boot), bound)?;
        }
        Ok(files)
    }

    fn index<'a>(files: &'a Files, document: &Document) -> &'a str {
        std::str::from_utf8(&files[document.index]).unwrap()
    }

    const BOOT: &str = r#"import init from "./page.js"; init("./page.wasm")"#;

    #[test]
    fn every_file_that_a_document_names_exists_under_its_hashed_name() {
        let files = assembled(BOOT, b"\0asm").unwrap();
        let indices = DOCUMENTS.map(|document| index(&files, &document));
        let named: Vec<_> = files.keys().filter(|name| !name.ends_with("html")).collect();
        assert_eq!(named.len(), 25, "one icon for all: {named:?}");
        for name in named {
            let quoted = format!("\"/{name}\"");
            assert!(indices.iter().any(|index| index.contains(&quoted)), "{name} is in no document");
        }
    }

    #[test]
    fn a_document_has_its_own_styles_after_those_of_all() {
        let files = assembled(BOOT, b"").unwrap();
        let sheet = |wanted: &str| {
            let found = files.iter().find(|(name, _)| name.starts_with(wanted) && name.ends_with("css"));
            String::from_utf8(found.unwrap().1.clone()).unwrap()
        };
        assert!(sheet("page").ends_with(".access{}.pages{}"), "{}", sheet("page"));
        assert!(sheet("office").ends_with(".document{}.office{}"), "{}", sheet("office"));
        assert!(sheet("devices").ends_with(".office{}.devices{}"), "{}", sheet("devices"));
        assert!(sheet("words").ends_with(".pages{}.words{}"), "{}", sheet("words"));
        assert!(sheet("code").ends_with(".office{}.code{}"), "{}", sheet("code"));
    }

    #[test]
    fn a_changed_module_changes_its_name_and_the_names_of_those_that_refer_to_it() {
        let [one, two] = [b"one", b"two"].map(|wasm| assembled(BOOT, wasm).unwrap());
        let changed: Vec<_> = one.keys().filter(|name| !two.contains_key(*name)).collect();
        assert!(changed.iter().all(|name| name.starts_with("boot") || name.ends_with("wasm")), "{changed:?}");
        assert_eq!(changed.len(), 2);
        let are_equal = DOCUMENTS.map(|document| index(&one, &document) == index(&two, &document));
        assert_eq!(are_equal, [false, true, true, true, true, true]);
    }

    #[test]
    fn what_is_shipped_is_there_gzipped_as_well() {
        let mut files = assembled(BOOT, b"one").unwrap();
        let before = files.len();
        zip(&mut files).unwrap();
        let zipped: Vec<_> = files.iter().filter(|(name, _)| name.ends_with("gz")).collect();
        assert_eq!(zipped.len(), before - 7, "all but the documents and the icon");
        assert!(zipped.iter().all(|(_, content)| content.starts_with(&[0x1F, 0x8B])));
    }

    #[test]
    fn a_boot_script_that_names_no_module_is_refused() {
        let error = assembled("nothing", b"").unwrap_err().to_string();
        assert_eq!(error, r#"frontend/boot.js does not refer to "./page.wasm""#);
    }

    #[test]
    fn writing_again_touches_nothing_and_removes_what_is_old() {
        let folder = tempfile::tempdir().unwrap();
        let dist = folder.path().join("dist");
        write(&dist, &assembled(BOOT, b"one").unwrap()).unwrap();
        let two = assembled(BOOT, b"two").unwrap();
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
