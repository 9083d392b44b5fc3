//! Lays the texts down as the page reads them: one `key<TAB>text` per line, in the order of the keys. Reading TOML in the
//! browser, or a crate that does, would be a part of the page that a table is not.

use std::{collections::BTreeMap, env, fs, path::Path};

fn main() {
    println!("cargo:rerun-if-changed=locales");
    let to = env::var_os("OUT_DIR").expect("cargo names a folder");
    for name in ["page", "office", "devices"] {
        let file = format!("locales/en/{name}.toml");
        let text = fs::read_to_string(&file).unwrap_or_else(|error| panic!("{file}: {error}"));
        let table: toml::Table = toml::from_str(&text).unwrap_or_else(|error| panic!("{file}: {error}"));
        let mut texts = BTreeMap::new();
        collect("", &toml::Value::Table(table), &mut texts);
        let lines: Vec<_> = texts.iter().map(|(key, text)| format!("{key}\t{text}\n")).collect();
        let path = Path::new(&to).join(format!("{name}.tsv"));
        fs::write(&path, lines.concat()).unwrap_or_else(|error| panic!("{}: {error}", path.display()));
    }
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
