//! Lays the texts down as tables of Rust, sorted by their keys. Reading TOML in the browser, or a crate that does, would be
//! a part of the page that a table is not.

use std::{collections::BTreeMap, env, fmt::Write, fs, path::Path};

/// Sections whose keys are put together at run time: each is a table of its own, without the section's name.
const AT_RUN_TIME: [(&str, &str); 6] = [
    ("page", "cause"),
    ("page", "problem"),
    ("page", "rule"),
    ("page", "try"),
    ("office", "event"),
    ("office", "member"),
];

fn main() {
    println!("cargo:rerun-if-changed=locales");
    let to = env::var_os("OUT_DIR").expect("cargo names a folder");
    let mut tables = String::new();
    for name in ["page", "office", "devices", "words", "code"] {
        let file = format!("locales/en/{name}.toml");
        let text = fs::read_to_string(&file).unwrap_or_else(|error| panic!("{file}: {error}"));
        let table: toml::Table = toml::from_str(&text).unwrap_or_else(|error| panic!("{file}: {error}"));
        let mut texts = BTreeMap::new();
        collect("", &toml::Value::Table(table), &mut texts);
        tables += &written(name, texts.iter().map(|(key, text)| (key.as_str(), text.as_str())));
        for (_, section) in AT_RUN_TIME.iter().filter(|(of, _)| *of == name) {
            let keys = texts.iter().filter_map(|(key, text)| {
                Some((key.strip_prefix(section)?.strip_prefix('.')?, text.as_str()))
            });
            tables += &written(section, keys);
        }
    }
    let path = Path::new(&to).join("texts.rs");
    fs::write(&path, tables).unwrap_or_else(|error| panic!("{}: {error}", path.display()));
}

fn written<'a>(name: &str, texts: impl Iterator<Item = (&'a str, &'a str)>) -> String {
    let mut table =
        format!("/// The texts of `{name}`.\npub(crate) const {}: Texts = &[\n", name.to_uppercase());
    for (key, text) in texts {
        writeln!(table, "    ({key:?}, {text:?}),").expect("writing to a String");
    }
    table + "];\n"
}

fn collect(above: &str, value: &toml::Value, texts: &mut BTreeMap<String, String>) {
    match value {
        toml::Value::Table(members) => {
            for (name, value) in members {
                let key = if above.is_empty() { name.clone() } else { format!("{above}.{name}") };
                collect(&key, value, texts);
            }
        }
        toml::Value::String(text) if !text.contains(['\t', '\n']) => {
            texts.insert(above.to_owned(), text.clone());
        }
        _ => panic!("{above}: not a text on one line"),
    }
}
