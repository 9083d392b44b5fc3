//! Names of users as identifiers of a program.

use alloc::string::String;

/// Characters of an identifier; the shortest limit among the dialects.
const MAX_IDENTIFIER: usize = 32;

/// ASCII letters, digits and single underscores, beginning with a letter. A name without any is `message`.
pub(super) fn identifier(name: &str) -> String {
    let mut identifier = String::new();
    for c in name.chars() {
        if identifier.len() == MAX_IDENTIFIER {
            break;
        }
        if c.is_ascii_alphanumeric() {
            if identifier.is_empty() && c.is_ascii_digit() {
                identifier.push('m');
            }
            identifier.push(c);
        } else if !identifier.is_empty() && !identifier.ends_with('_') {
            identifier.push('_');
        }
    }
    while identifier.ends_with('_') {
        identifier.pop();
    }
    if identifier.is_empty() { "message".into() } else { identifier }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn every_name_is_an_identifier() {
        for (name, made) in [
            ("drive-current", "drive_current"),
            ("  '); DROP -- ", "DROP"),
            ("3rd axis", "m3rd_axis"),
            ("écran", "cran"),
            ("日本", "message"),
            ("", "message"),
            ("a__b", "a_b"),
        ] {
            assert_eq!(identifier(name), made, "{name}");
        }
        assert_eq!(identifier(&"x".repeat(99)).len(), MAX_IDENTIFIER);
    }
}
