//! Names of files, from names that people give.

use alloc::format;
use alloc::string::String;

/// Characters of a name of a file that we make, without its ending and without the number that tells it from others.
const MAX_FILE_NAME: usize = 60;

/// What a file is called whose name has nothing that a file may be called.
const NAMELESS: &str = "unnamed";

/// Devices of Windows: no file can be called like that, whatever its ending. Source: Microsoft, "Naming Files, Paths,
/// and Namespaces".
const DEVICES: [&str; 4] = ["con", "prn", "aux", "nul"];

/// The name of a file, without ending, for what people call `name`: small letters of ASCII, digits, `_` and `-`, so
/// that every file system can have it and tells it from others.
pub fn file_name(name: &str) -> String {
    let mut file = String::new();
    for character in name.chars() {
        let character = match character {
            'a'..='z' | '0'..='9' | '_' => character,
            'A'..='Z' => character.to_ascii_lowercase(),
            _ => '-',
        };
        if character != '-' || !(file.is_empty() || file.ends_with('-')) {
            file.push(character);
        }
        if file.len() == MAX_FILE_NAME {
            break;
        }
    }
    let end = file.trim_end_matches('-').len();
    file.truncate(end);
    if file.is_empty() {
        file.push_str(NAMELESS);
    }
    if is_device(&file) {
        file.push('_');
    }
    file
}

/// [`file_name`], or the first of `name-2`, `name-3` … that is free.
pub fn free_file_name(name: &str, is_taken: impl Fn(&str) -> bool) -> String {
    let first = file_name(name);
    if !is_taken(&first) {
        return first;
    }
    // At most as many are taken as there are files.
    let numbered = (2_u64..).map(|number| format!("{first}-{number}"));
    numbered.into_iter().find(|file| !is_taken(file)).unwrap_or(first)
}

/// Whether every file system can have a file of this name.
pub fn is_portable(name: &str) -> bool {
    let is_plain = |byte: u8| byte.is_ascii_alphanumeric() || matches!(byte, b'_' | b'-' | b'.' | b' ');
    let device = name.split('.').next().unwrap_or_default().trim_end();
    !name.is_empty()
        && name.len() <= 2 * MAX_FILE_NAME
        && name.bytes().all(is_plain)
        && !name.starts_with(['.', ' ', '-'])
        && !name.ends_with(['.', ' '])
        && !is_device(device)
}

fn is_device(name: &str) -> bool {
    let lower = name.to_ascii_lowercase();
    let port = lower.strip_prefix("com").or_else(|| lower.strip_prefix("lpt"));
    DEVICES.contains(&lower.as_str())
        || port.is_some_and(|port| port.len() == 1 && port.bytes().all(|byte| byte.is_ascii_digit()))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_name_becomes_one_that_every_file_system_can_have() {
        for (name, file) in [
            ("drive-current", "drive-current"),
            ("Drive Current", "drive-current"),
            ("Förderband 3", "f-rderband-3"),
            ("../../etc/passwd", "etc-passwd"),
            ("C:\\x", "c-x"),
            ("a.b.", "a-b"),
            ("...", "unnamed"),
            ("", "unnamed"),
            ("温度", "unnamed"),
            ("NUL", "nul_"),
            ("com1", "com1_"),
            ("Lpt9", "lpt9_"),
            ("com10", "com10"),
            ("console", "console"),
            ("-rf", "rf"),
            ("_x_", "_x_"),
        ] {
            assert_eq!(file_name(name), file, "{name}");
            assert!(is_portable(file), "{file}");
        }
        let long = file_name(&"ab ".repeat(200));
        assert!(long.len() <= MAX_FILE_NAME && is_portable(&long), "{long}");
    }

    #[test]
    fn what_is_taken_gets_a_number() {
        let taken = ["x", "x-2"];
        assert_eq!(free_file_name("X", |file| taken.contains(&file)), "x-3");
        assert_eq!(free_file_name("y", |file| taken.contains(&file)), "y");
    }

    #[test]
    fn names_that_some_file_system_refuses_are_known() {
        for name in ["", ".x", "x.", "x ", "a/b", "a\\b", "a:b", "con", "Con.x", "é", "-x", "a\0b"] {
            assert!(!is_portable(name), "{name:?}");
        }
        assert!(is_portable("Drive 1.old"));
    }
}
