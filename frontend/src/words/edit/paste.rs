//! Words as people find them in programs and watch windows: `Data[0] := 16#030E;`, `%MW100 := 782`, `[16#0000, 782]`.

use cipdeck_shared::config::read_number;

/// The words of a pasted text that assigns or lists them, in the order of their numbers; `None` for a text that is none
/// of this, or plain words, which need no reading.
///
/// Behind `:=` and between brackets a number without a mark is decimal, as in Structured Text.
pub fn pasted(text: &str) -> Option<Vec<u16>> {
    let trimmed = text.trim();
    if let Some(list) =
        trimmed.strip_prefix('[').and_then(|rest| rest.trim_end_matches(';').strip_suffix(']'))
    {
        return list.split(',').map(literal).collect();
    }
    if !text.contains(":=") && !text.contains('%') {
        return None;
    }
    let mut words: Vec<(u32, u16)> = Vec::new();
    for line in trimmed.split([';', '\n', '\r']).map(without_comment).filter(|line| !line.is_empty()) {
        let (place, value) = line.split_once(":=").or_else(|| line.split_once(['=', ':', ' ', '\t']))?;
        words.push((index(place)?, literal(value)?));
    }
    words.sort_unstable_by_key(|(index, _)| *index);
    let in_a_row = words.windows(2).all(|pair| matches!(pair, [one, two] if one.0 + 1 == two.0));
    (in_a_row && !words.is_empty()).then(|| words.into_iter().map(|(_, word)| word).collect())
}

/// `(* … *)` and `// …` at the end of a line.
fn without_comment(line: &str) -> &str {
    let line = line.split("//").next().unwrap_or_default();
    line.split("(*").next().unwrap_or_default().trim()
}

/// The number of a place: 3 of `Data_to_Send[3]`, 100 of `%MW100`.
fn index(place: &str) -> Option<u32> {
    let place = place.trim().trim_end_matches(']');
    let digits = place.rsplit(|c: char| !c.is_ascii_digit()).next()?;
    digits.parse().ok()
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
    }
}
