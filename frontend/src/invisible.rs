//! Characters that nobody sees: soft hyphens, spaces that are none, marks of direction. They come with what is copied from
//! a PDF or a web page, and make a text unreadable that looks right.

/// One of them in a text.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Invisible {
    /// Which character it is, from 1.
    pub position: usize,
    /// The line that it is in, from 1.
    pub line: usize,
    /// The character.
    pub what: char,
}

impl Invisible {
    /// The first one of a text.
    pub fn first_of(text: &str) -> Option<Self> {
        let at = text.find(is_invisible)?;
        let (before, rest) = text.split_at_checked(at)?;
        Some(Self {
            position: before.chars().count() + 1,
            line: before.matches('\n').count() + 1,
            what: rest.chars().next()?,
        })
    }

    /// `soft hyphen, U+00AD`
    pub fn name(self) -> String {
        let code = u32::from(self.what);
        let name = match self.what {
            '\u{AD}' => "soft hyphen",
            '\u{200B}'..='\u{200D}' | '\u{2060}' | '\u{FEFF}' => "character without a width",
            what if is_blank(what) => "space that is none",
            _ => "control character",
        };
        format!("{name}, U+{code:04X}")
    }
}

/// How many there are.
pub fn count(text: &str) -> usize {
    text.matches(is_invisible).count()
}

/// The text without them: a space that is none becomes one.
pub fn without(text: &str) -> String {
    let seen = |c: char| match c {
        _ if is_blank(c) => Some(' '),
        _ => (!is_invisible(c)).then_some(c),
    };
    text.chars().filter_map(seen).collect()
}

/// The text with each of them written out: `16#03‹U+00AD›0E`.
pub fn shown(text: &str) -> String {
    let written =
        |c: char| if is_invisible(c) { format!("‹U+{:04X}›", u32::from(c)) } else { c.to_string() };
    text.chars().map(written).collect()
}

/// Tabs and the ends of lines and of pages are where they belong.
fn is_invisible(c: char) -> bool {
    let is_mark = matches!(
        c,
        '\u{AD}' | '\u{180E}' | '\u{200B}'..='\u{200F}' | '\u{2028}'..='\u{202E}' | '\u{2060}'..='\u{206F}' | '\u{FEFF}'
    );
    let is_control = c.is_control() && !matches!(c, '\t' | '\n' | '\r' | '\u{C}');
    is_mark || is_control || is_blank(c)
}

/// Looks like a space, and separates nothing.
const fn is_blank(c: char) -> bool {
    matches!(c, '\u{A0}' | '\u{2000}'..='\u{200A}' | '\u{202F}' | '\u{205F}' | '\u{3000}')
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn what_nobody_sees_has_a_name_and_a_place() {
        let text = "Data[0] := 0;\nData[1] := 16#03\u{AD}0E;\u{A0}";
        let first = Invisible::first_of(text).unwrap();
        assert_eq!((first.position, first.line), (31, 2));
        assert_eq!(first.name(), "soft hyphen, U+00AD");
        assert_eq!(count(text), 2);
        assert_eq!(without(text), "Data[0] := 0;\nData[1] := 16#030E; ");
        assert_eq!(shown("16#03\u{AD}0E"), "16#03‹U+00AD›0E");
        let blank = Invisible::first_of("1\u{202F}000").unwrap();
        assert_eq!((blank.position, blank.name().as_str()), (2, "space that is none, U+202F"));
    }

    #[test]
    fn what_is_seen_stays() {
        for text in ["(* débit : 5 µs *)\r\n\tx := 'Ω';", "x\u{C}", "‘quoted’ “text” – − ×", "東京 قيمة"]
        {
            assert_eq!((count(text), without(text), shown(text)), (0, text.to_owned(), text.to_owned()));
        }
    }
}
