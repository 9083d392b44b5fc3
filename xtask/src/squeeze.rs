//! Scripts and style sheets without what only people read. wasm-bindgen's script is a tenth of comments and indentation.

/// A script without indentation, empty lines, and comments that have their lines to themselves.
///
/// Not for a text with a template of several lines, whose indentation means something: neither wasm-bindgen nor we
/// write one.
pub(crate) fn script(text: &str) -> String {
    let mut short = String::with_capacity(text.len());
    let mut inside_comment = false;
    for line in text.lines().map(str::trim) {
        let begins = line.starts_with("/*");
        if inside_comment || begins {
            inside_comment = !line.ends_with("*/");
        } else if !line.is_empty() && !line.starts_with("//") {
            short += line;
            short.push('\n');
        }
    }
    short
}

/// A style sheet without comments and without space where none is needed.
pub(crate) fn styles(text: &str) -> String {
    let mut short = String::with_capacity(text.len());
    let mut rest = text;
    while let Some((before, comment)) = rest.split_once("/*") {
        squeeze(before, &mut short);
        rest = comment.split_once("*/").map_or("", |(_, after)| after);
    }
    squeeze(rest, &mut short);
    short
}

fn squeeze(text: &str, short: &mut String) {
    for word in text.split_whitespace() {
        // Only these need no space after them wherever they stand: `a :hover` and `1px + 2px` do.
        let joins = short.is_empty() || short.ends_with(['{', '}', ';', ',']) || word.starts_with(['{', '}']);
        // The colon of a declaration is the one with a space behind it.
        let is_value = short.ends_with(':');
        if word.starts_with('}') && short.ends_with(';') {
            short.pop();
        }
        if !joins && !is_value {
            short.push(' ');
        }
        short.push_str(word);
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_script_keeps_its_lines_and_loses_what_people_read() {
        let text = "// why\nfunction a() {\n    /**\n     * more\n     */\n    const url = \"https://a//b\"; // kept\n\n}\n";
        assert_eq!(script(text), "function a() {\nconst url = \"https://a//b\"; // kept\n}\n");
    }

    #[test]
    fn a_style_sheet_means_the_same() {
        let text = "/* one */\n.a:hover,\n.b > c :focus {\n  width: calc(100% - 2px);\n  font: 12px / 1 mono;\n}\n\n@media (max-width: 9px) {\n  .d {\n    margin: 0 auto;\n  }\n}\n";
        let short = ".a:hover,.b > c :focus{width:calc(100% - 2px);font:12px / 1 mono}@media (max-width:9px){.d{margin:0 auto}}";
        assert_eq!(styles(text), short);
    }
}
