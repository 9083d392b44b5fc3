//! The paths that a source names: `use` trees, and paths in expressions and types.

use std::{iter::Peekable, vec::IntoIter};

/// One path that a source names.
#[derive(Debug, PartialEq, Eq)]
pub(super) struct Import {
    /// Counted from 1.
    pub(super) line: usize,
    /// Where the path begins.
    pub(super) origin: Origin,
    /// Its segments, without `crate` and `super`.
    pub(super) path: Vec<String>,
}

/// Where a path begins.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Origin {
    /// At the root of its own crate.
    Crate,
    /// At that root, too, unless an inline module lies between.
    Super,
    /// At another crate, or at a name in scope.
    Name,
}

/// All paths outside tests, in a module so many levels below the crate's root.
pub(super) fn read(text: &str, depth: usize) -> Vec<Import> {
    let code = code_only(text);
    let mut tokens = tokens(&code).into_iter().peekable();
    let mut imports = Vec::new();
    let mut after_path_sign = false;
    while let Some((line, token)) = tokens.next() {
        let begins = !after_path_sign && is_name(&token);
        after_path_sign = token == "::";
        if !begins || !follows_path_sign(&mut tokens) {
            continue;
        }
        let mut begin = Import { line, origin: Origin::Name, path: Vec::new() };
        let mut ups = usize::from(token == "super");
        while ups > 0
            && tokens.next_if(|(_, next)| next == "super").is_some()
            && follows_path_sign(&mut tokens)
        {
            ups += 1;
        }
        if ups > 0 {
            if ups < depth {
                continue; // stays inside its layer
            }
            begin.origin = Origin::Super;
        } else if token == "crate" {
            begin.origin = Origin::Crate;
        } else if token == "self" || token == "Self" {
            continue;
        } else {
            begin.path.push(token);
        }
        tree(&mut tokens, begin, &mut imports);
    }
    imports
}

type Tokens = Peekable<IntoIter<(usize, String)>>;

/// Reads what follows `crate::`: names, and groups in braces.
fn tree(tokens: &mut Tokens, mut import: Import, imports: &mut Vec<Import>) {
    loop {
        match tokens.peek().map(|(line, token)| (*line, token.clone())) {
            Some((_, token)) if token == "{" => {
                tokens.next();
                group(tokens, &import, imports);
                return;
            }
            Some((line, token)) if is_name(&token) || token == "*" => {
                tokens.next();
                import.line = line;
                if token != "self" {
                    import.path.push(token);
                }
                if !follows_path_sign(tokens) {
                    imports.push(import);
                    return;
                }
            }
            _ => {
                imports.push(import);
                return;
            }
        }
    }
}

/// Reads the members of a group up to its closing brace.
fn group(tokens: &mut Tokens, before: &Import, imports: &mut Vec<Import>) {
    while let Some((line, token)) = tokens.peek().cloned() {
        match token.as_str() {
            "}" => {
                tokens.next();
                return;
            }
            // A separator; or the new name after `as`, which `tree` left behind.
            "," | "as" => {
                tokens.next();
                if token == "as" {
                    tokens.next();
                }
            }
            _ if is_name(&token) || token == "*" || token == "{" => {
                let member = Import { line, origin: before.origin, path: before.path.clone() };
                tree(tokens, member, imports);
            }
            _ => {
                tokens.next();
            }
        }
    }
}

fn follows_path_sign(tokens: &mut Tokens) -> bool {
    tokens.next_if(|(_, token)| token == "::").is_some()
}

fn is_name(token: &str) -> bool {
    token.starts_with(|first: char| first.is_alphabetic() || first == '_')
}

/// Names, `::`, and single characters, each with its line.
fn tokens(code: &str) -> Vec<(usize, String)> {
    let mut tokens = Vec::new();
    let mut characters = code.chars().peekable();
    let mut line = 1;
    while let Some(character) = characters.next() {
        match character {
            '\n' => line += 1,
            _ if character.is_whitespace() => {}
            ':' if characters.next_if_eq(&':').is_some() => tokens.push((line, "::".to_owned())),
            _ if character.is_alphanumeric() || character == '_' => {
                let mut name = character.to_string();
                while let Some(more) = characters.next_if(|next| next.is_alphanumeric() || *next == '_') {
                    name.push(more);
                }
                tokens.push((line, name));
            }
            _ => tokens.push((line, character.to_string())),
        }
    }
    tokens
}

/// The source without comments, texts and the tests at its end; lines stay where they are.
fn code_only(text: &str) -> String {
    let text = tests_cut_off(text);
    let mut code = String::with_capacity(text.len());
    let mut rest = text;
    while let Some(first) = rest.chars().next() {
        let skipped = if rest.starts_with("//") {
            rest.find('\n').unwrap_or(rest.len())
        } else if rest.starts_with("/*") {
            rest.find("*/").map_or(rest.len(), |end| end + 2)
        } else if rest.starts_with("r\"") || rest.starts_with("r#") {
            raw_text(rest)
        } else if first == '"' {
            quoted(rest, '"')
        } else if first == '\'' && is_character(rest) {
            quoted(rest, '\'')
        } else {
            code.push(first);
            rest = &rest[first.len_utf8()..];
            continue;
        };
        code.push(' ');
        code.extend(rest[..skipped].chars().filter(|character| *character == '\n'));
        rest = &rest[skipped..];
    }
    code
}

/// Tests may import what they like; by the house rules they are the end of a file.
fn tests_cut_off(text: &str) -> &str {
    let marks = ["#[cfg(test)]\nmod ", "#[cfg(all(test"];
    let end = marks.iter().filter_map(|mark| text.find(mark)).min().unwrap_or(text.len());
    &text[..end]
}

/// The length of a text or a character in quotes.
fn quoted(rest: &str, quote: char) -> usize {
    let mut escaped = false;
    for (at, character) in rest.char_indices().skip(1) {
        match character {
            _ if escaped => escaped = false,
            '\\' => escaped = true,
            _ if character == quote => return at + 1,
            _ => {}
        }
    }
    rest.len()
}

/// The length of `r"…"` or `r#"…"#`; of the `r` alone in a raw name such as `r#type`.
fn raw_text(rest: &str) -> usize {
    let hashes = rest[1..].chars().take_while(|character| *character == '#').count();
    if !rest[1 + hashes..].starts_with('"') {
        return 1 + hashes;
    }
    let end = format!("\"{}", "#".repeat(hashes));
    let begin = hashes + 2;
    rest[begin..].find(&end).map_or(rest.len(), |at| begin + at + end.len())
}

/// Whether a quote begins a character and not a lifetime.
fn is_character(rest: &str) -> bool {
    let mut after = rest.chars().skip(1);
    match after.next() {
        Some('\\') => true,
        Some(_) => after.next() == Some('\''),
        None => false,
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn paths(text: &str) -> Vec<String> {
        read(text, 1).iter().map(|import| import.path.join("::")).collect()
    }

    #[test]
    fn groups_within_groups_give_every_path() {
        assert_eq!(
            paths("pub(crate) use crate::{wire::{self, Epath as Path, cursor::*}, table};"),
            ["wire", "wire::Epath", "wire::cursor::*", "table"]
        );
    }

    #[test]
    fn a_name_that_ends_in_r_before_a_text_is_not_a_raw_text() {
        assert_eq!(paths("f!(for\"x\", crate::a::b, 'c', &'static str, '\\'')"), ["a::b"]);
    }

    #[test]
    fn a_multi_line_text_keeps_the_lines_that_follow() {
        assert_eq!(read("const A: &str = r#\"\n\n\"#;\nuse crate::sim;", 1)[0].line, 4);
    }
}
