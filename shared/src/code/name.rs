//! Names of users as identifiers of a program.

use alloc::string::String;

/// Characters of an identifier; the shortest limit among the dialects.
const MAX_IDENTIFIER: usize = 32;

/// Words that a variable cannot be called in Structured Text of any vendor: IEC 61131-3, and the types and functions
/// that stand beside it in what is written here.
const RESERVED: &str = "\
    ACTION ADDM ADDMX ADDR AND AND_MASK ANY ARRAY AT BOOL BY BYTE CAL CALC CALCN CASE CIPAPPCFG CIPCLOSE \
    CIPCONTROLCFG CIPOPEN CIPREAD CIPSEND CIPSTATUS CIPTARGETCFG CIPUCMMSEND CIPWRITE CONFIGURATION CONSTANT \
    CONTINUE COP DATA_EXCH DATE DATE_AND_TIME DINT DO DT DWORD ELSE ELSIF EN END END_CASE END_FOR \
    END_FUNCTION END_FUNCTION_BLOCK END_IF END_PROGRAM END_REPEAT END_STRUCT END_TYPE END_VAR END_WHILE ENO \
    EXIT FALSE FOR FUNCTION FUNCTION_BLOCK GOTO IF INT JMP JMPC JMPCN LD LDN LINT LREAL LWORD MOD MOV MSG \
    MSG_CIPGENERIC NOT OF ON OR PROGRAM REAL REPEAT RESOURCE RET RETAIN RETURN SEND_REQ SHR SINT ST STEP STN \
    STRING STRUCT TASK THEN TIME TOD TOF TON TP TRANSITION TRUE TYPE UDINT UINT ULINT UNTIL USINT VAR \
    VAR_EXTERNAL VAR_GLOBAL VAR_INPUT VAR_IN_OUT VAR_OUTPUT VAR_TEMP WHILE WITH WORD XOR";

/// ASCII letters, digits and single underscores, beginning with a letter, and no word of the language (`m_IF`). A name
/// without any is `message`.
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
    if identifier.is_empty() {
        return "message".into();
    }
    if RESERVED.split(' ').any(|word| identifier.eq_ignore_ascii_case(word)) {
        identifier.insert_str(0, "m_");
    }
    identifier
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
            ("if", "m_if"),
            ("End_If;", "m_End_If"),
            ("IF_1", "IF_1"),
            ("CIPSTATUS", "m_CIPSTATUS"),
        ] {
            assert_eq!(identifier(name), made, "{name}");
        }
        assert_eq!(identifier(&"x".repeat(99)).len(), MAX_IDENTIFIER);
    }
}
