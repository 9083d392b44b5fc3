//! Words as people find them in programs and watch windows: `Data[0] := 16#030E;`, `%MW100 := 782`, `[16#0000, 782]`.

use cipdeck_shared::config::read_number;

use crate::invisible;

/// The words of a pasted text that assigns or lists them, in the order of their numbers; `None` for a text that is none
/// of this, or plain words, which need no reading.
///
/// Behind `:=` and between brackets a number without a mark is decimal, as in Structured Text.
pub fn pasted(text: &str) -> Option<Vec<u16>> {
    let text = without_comments(&invisible::without(text))?;
    let trimmed = text.trim();
    if let Some(list) =
        trimmed.strip_prefix('[').and_then(|rest| rest.trim_end_matches(';').strip_suffix(']'))
    {
        return list.split(',').map(literal).collect();
    }
    if !text.contains(":=") && !text.contains('%') {
        return None;
    }
    let mut words: Vec<(&str, u32, u16)> = Vec::new();
    for line in trimmed.split([';', '\n', '\r']).map(str::trim).filter(|line| !line.is_empty()) {
        let (place, value) = line.split_once(":=").or_else(|| line.split_once(['=', ':', ' ', '\t']))?;
        let (name, index) = place_of(place)?;
        words.push((name, index, literal(value)?));
    }
    words.sort_unstable_by_key(|(_, index, _)| *index);
    let in_a_row = |(one, at, _): &(&str, u32, u16), (two, next, _): &(&str, u32, u16)| {
        one == two && at.checked_add(1) == Some(*next)
    };
    let is_one_table = words.windows(2).all(|pair| matches!(pair, [one, two] if in_a_row(one, two)));
    (is_one_table && !words.is_empty()).then(|| words.into_iter().map(|(_, _, word)| word).collect())
}

/// Without `(* … *)` and `// …`; `None` where a comment does not end.
fn without_comments(text: &str) -> Option<String> {
    let mut kept = String::new();
    let mut rest = text;
    while let Some((before, comment)) = rest.split_once("(*") {
        kept.push_str(before);
        kept.push(' ');
        rest = comment.split_once("*)")?.1;
    }
    kept.push_str(rest);
    Some(kept.lines().filter_map(|line| line.split("//").next()).collect::<Vec<_>>().join("\n"))
}

/// What is numbered, and the number: `%MW` and 100 of `%MW100`, `Data[` and 3 of `Data[3]`.
fn place_of(place: &str) -> Option<(&str, u32)> {
    let place = place.trim().trim_end_matches(']').trim_end();
    let name = place.trim_end_matches(|c: char| c.is_ascii_digit());
    // An index in another radix is another number.
    let digits = place.get(name.len()..).filter(|_| !name.ends_with('#'))?;
    Some((name, digits.parse().ok()?))
}

/// `16#030E`, `782`, `-1`, `INT#782`
fn literal(text: &str) -> Option<u16> {
    let text = text.trim();
    let text =
        ["INT#", "UINT#", "WORD#", "10#"].iter().find_map(|mark| text.strip_prefix(mark)).unwrap_or(text);
    let value = read_number(text).ok()?;
    u16::try_from(value).ok().or_else(|| i16::try_from(value).ok().map(i16::cast_unsigned))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn words_are_taken_from_programs_in_their_order() {
        let expected = Some(vec![0x0000, 0x030E, 0x0120]);
        for text in [
            "Data_to_Send[0] := 0;\nData_to_Send[1] := 16#030E; (* service *)\nData_to_Send[2] := 288;",
            "%MW100 := 16#0000;\r\n%MW102 := 16#0120;\r\n%MW101 := 782;",
            "%MW100\t0\n%MW101\t782\n%MW102\t16#0120",
            "%MW7: 0\n%MW8: WORD#16#030E\n%MW9: INT#288 // path",
            "[16#0000, 16#30E, 288]",
            "[0, 782, 288];",
            "(* head *) D[0] := 0; (* two\nlines *) D[1] := 782;\nD[2] := 288; // end",
            "D[0] := 16#00\u{AD}00; D[1]\u{A0}:= 782; D[2] := 288;",
        ] {
            assert_eq!(pasted(text), expected, "{text}");
        }
        assert_eq!(pasted("%MW0 := -1;"), Some(vec![0xFFFF]));
    }

    #[test]
    fn what_is_no_table_of_words_is_left_as_it_is() {
        for text in
            ["0000 030E", "16#0000, 16#030E", "", "%MW100 := 1;\n%MW102 := 2;", "%MW1 := x;", "a := 70000;"]
        {
            assert_eq!(pasted(text), None, "{text}");
        }
        for text in ["A[0] := 1; B[1] := 2;", "D[16#9] := 1; D[16#10] := 2;", "%MW0 := 1; (* open"] {
            assert_eq!(pasted(text), None, "{text}");
        }
    }
}
