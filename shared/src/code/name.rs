//! Names of users as identifiers of a program.

use alloc::collections::BTreeSet;
use alloc::format;
use alloc::string::{String, ToString};
use alloc::vec::Vec;

use crate::config::BlockConfig;

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

/// Characters by which blocks of one program differ; the longest ending of a variable follows.
pub(super) const MAX_NAME: usize = 24;

/// Gives another name (`ramp_2`) to each block whose variables would be those of one before it, for code of several
/// blocks in one program. Tells the old and the new ones.
pub fn tell_apart<'a>(blocks: impl Iterator<Item = &'a mut BlockConfig>) -> Vec<(String, String)> {
    let blocks: Vec<_> = blocks.collect();
    let key = |name: &str| {
        let mut key = identifier(name).to_ascii_lowercase();
        key.truncate(MAX_NAME);
        key.trim_end_matches('_').to_string()
    };
    let all: BTreeSet<String> = blocks.iter().map(|block| key(block.name())).collect();
    let mut taken = BTreeSet::new();
    let mut renamed = Vec::new();
    for block in blocks {
        let old = block.name().to_string();
        if taken.insert(key(&old)) {
            continue;
        }
        let named = |number: usize| {
            let number = format!("_{number}");
            let mut name = identifier(&old);
            name.truncate(MAX_NAME - number.len());
            format!("{}{number}", name.trim_end_matches('_'))
        };
        // Who has a name of his own keeps it.
        let free = (2..10_000).map(named).find(|name| !all.contains(&key(name)) && taken.insert(key(name)));
        if let Some(name) = free {
            block.set_name(name.clone());
            renamed.push((old, name));
        }
    }
    renamed
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::config::MsgCipGeneric;

    #[test]
    fn blocks_of_one_program_have_variables_of_their_own() {
        let long = "x".repeat(40);
        let names = ["speed write", "speed-write", "SPEED_WRITE", "speed_write_2", &long, &long, "other"];
        let mut blocks = names.map(|name| {
            let mut block = BlockConfig::from(MsgCipGeneric::product_name("0,0"));
            block.set_name(name.into());
            block
        });
        let renamed = tell_apart(blocks.iter_mut());
        let x = "x".repeat(22) + "_2";
        let told: Vec<(&str, &str)> = renamed.iter().map(|(old, new)| (old.as_str(), new.as_str())).collect();
        assert_eq!(told, [("speed-write", "speed_write_3"), ("SPEED_WRITE", "SPEED_WRITE_4"), (&long, &x)]);
        let kept: Vec<&str> = blocks.iter().map(BlockConfig::name).collect();
        assert_eq!(
            kept,
            ["speed write", "speed_write_3", "SPEED_WRITE_4", "speed_write_2", &long, &x, "other"]
        );
    }

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
