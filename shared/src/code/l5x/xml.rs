//! Texts of users inside of XML.

use alloc::string::String;

/// Inside of an attribute or between tags.
pub(super) fn escaped(text: &str) -> String {
    let mut escaped = String::with_capacity(text.len());
    for c in text.chars().map(allowed) {
        match c {
            '&' => escaped.push_str("&amp;"),
            '<' => escaped.push_str("&lt;"),
            '>' => escaped.push_str("&gt;"),
            '"' => escaped.push_str("&quot;"),
            '\'' => escaped.push_str("&apos;"),
            c => escaped.push(c),
        }
    }
    escaped
}

/// A CDATA section, as Studio 5000 writes texts. What would end it is divided between two.
pub(super) fn cdata(text: &str) -> String {
    let text: String = text.chars().map(allowed).collect();
    alloc::format!("<![CDATA[{}]]>", text.replace("]]>", "]]]]><![CDATA[>"))
}

/// XML has no place for most control characters, not even escaped.
const fn allowed(c: char) -> char {
    match c {
        '\t' | '\n' => c,
        '\u{0}'..'\u{20}' | '\u{7f}'..'\u{a0}' | '\u{fffe}' | '\u{ffff}' => ' ',
        c => c,
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_text_stays_where_it_is() {
        assert_eq!(
            escaped("</Tag> & \"x\" 'y' \u{0}\u{b}"),
            "&lt;/Tag&gt; &amp; &quot;x&quot; &apos;y&apos;   "
        );
        assert_eq!(cdata("a]]></Comment>"), "<![CDATA[a]]]]><![CDATA[></Comment>]]>");
        for text in ["]]>", "]]]]>>", "</Tag>\u{1b}🦀", "--><!--", "<?xml ?>", "&amp;&#0;"] {
            let document = alloc::format!("<a b=\"{}\">{}</a>", escaped(text), cdata(text));
            let read = roxmltree::Document::parse(&document).unwrap();
            let expected = text.replace('\u{1b}', " ");
            assert_eq!(read.root_element().attribute("b"), Some(expected.as_str()));
            let inside: String = read.root_element().children().filter_map(|node| node.text()).collect();
            assert_eq!(inside, expected);
        }
    }
}
