//! Whether something is open at the end of a line.

use super::line::{Look, look};

/// Lines that brackets may stay open. A bracket that nobody closes must not take the rest of the text.
const MAX_OPEN_LINES: usize = 2000;

/// What is open.
#[derive(Clone, Debug, Default)]
pub(super) struct Open {
    /// Brackets, or elements of XML.
    depth: usize,
    /// `(*`, `<!--` and their like.
    comment: usize,
    lines: usize,
    /// A backslash or a comma at the end of the line.
    goes_on: bool,
    /// Something has been opened: XML and JSON end when it is closed.
    begun: bool,
}

impl Open {
    /// Whether the next line belongs to what is open, whatever it looks like.
    pub(super) fn holds(&self, current: Look, next: &str) -> bool {
        if self.lines > MAX_OPEN_LINES && !matches!(current, Look::Xml | Look::Json) {
            return false;
        }
        match current {
            Look::Xml => self.depth > 0 || self.comment > 0 || !self.begun,
            Look::Json => self.depth > 0,
            Look::Shell | Look::Hex => self.goes_on,
            Look::Iec if self.comment > 0 => true,
            // What certainly is something else ends a bracket that was forgotten.
            Look::Iec | Look::Python | Look::Rust => {
                self.depth > 0 && !matches!(look(next, None), Look::Xml | Look::Json | Look::Shell)
            }
            Look::Table | Look::Words | Look::Nothing | Look::Remark => false,
        }
    }

    /// Reads one more line of it.
    pub(super) fn line(&mut self, current: Look, line: &str) {
        self.lines += 1;
        let end = line.trim_end();
        self.goes_on = match current {
            Look::Shell => end.ends_with('\\'),
            Look::Hex => end.ends_with(','),
            _ => false,
        };
        match current {
            Look::Xml => self.elements(line),
            Look::Json | Look::Iec | Look::Python | Look::Rust => self.brackets(current, line),
            _ => {}
        }
    }

    fn brackets(&mut self, current: Look, line: &str) {
        let mut quote = None;
        let mut escaped = false;
        let mut last = ' ';
        for c in line.chars() {
            let pair = (last, c);
            last = c;
            if let Some(open) = quote {
                if c == open && !escaped {
                    quote = None;
                }
                escaped = !escaped && c == if current == Look::Iec { '$' } else { '\\' };
                continue;
            }
            match pair {
                ('(', '*') if current == Look::Iec => {
                    self.comment += 1;
                    self.depth = self.depth.saturating_sub(usize::from(self.comment == 1));
                    last = ' ';
                }
                ('*', ')') if self.comment > 0 => {
                    self.comment -= 1;
                    last = ' ';
                }
                _ if self.comment > 0 => {}
                ('/', '/') if current != Look::Python => return,
                (_, '#') if current == Look::Python => return,
                // A lifetime is no quote.
                (_, '\'') if current == Look::Rust || current == Look::Json => {}
                (_, '"' | '\'') => quote = Some(c),
                (_, '(' | '[' | '{') => (self.depth, self.begun) = (self.depth + 1, true),
                (_, ')' | ']' | '}') => self.depth = self.depth.saturating_sub(1),
                _ => {}
            }
        }
    }

    /// Elements, without what is in comments, instructions and CDATA.
    fn elements(&mut self, line: &str) {
        let mut rest = line;
        while !rest.is_empty() {
            if self.comment > 0 {
                let Some((_, after)) = rest.split_once(if self.comment == 1 { "-->" } else { "]]>" }) else {
                    return;
                };
                self.comment = 0;
                rest = after;
                continue;
            }
            let Some(at) = rest.find(['<', '/']) else { return };
            let here = rest.get(at..).unwrap_or_default();
            let mut step = 1;
            if here.starts_with("<!--") {
                (self.comment, step) = (1, 4);
            } else if here.starts_with("<![CDATA[") {
                (self.comment, step) = (2, 9);
            } else if here.starts_with("</") || here.starts_with("/>") {
                self.depth = self.depth.saturating_sub(1);
                step = 2;
            } else if here.starts_with('<') && !here.starts_with("<?") && !here.starts_with("<!") {
                (self.depth, self.begun) = (self.depth + 1, true);
            }
            rest = here.get(step..).unwrap_or_default();
        }
    }
}
