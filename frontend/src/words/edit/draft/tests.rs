use cipdeck_shared::config::SendReqForm;

use super::*;
use crate::editor::Remark;

const PRODUCT_NAME: &str = "0000 030E 0120 0124 0730";

fn draft(form: SendReqForm, words: &str) -> Draft {
    let mut draft = Draft::new(SendReq::new(form, "read"), None);
    draft.edit(Edit::Words(words.to_owned()));
    draft
}

fn product_name() -> Draft {
    draft(SendReqForm::Etc100, PRODUCT_NAME)
}

fn typed(mut draft: Draft, part: Part, text: &str) -> Draft {
    draft.edit(Edit::Part(part, text.to_owned()));
    draft
}

fn errors(draft: &Draft) -> Vec<String> {
    draft.check().1.into_iter().filter(Remark::is_error).map(|remark| remark.field).collect()
}

#[test]
fn words_and_fields_show_each_other() {
    let draft = product_name();
    let texts = [Part::MessageType, Part::Service, Part::Class, Part::Instance, Part::Attribute];
    assert_eq!(texts.map(|part| draft.part(part)), ["0", "14", "1", "1", "7"]);
    assert_eq!(draft.length(), 10);
    let draft = typed(draft, Part::Attribute, "0x06");
    assert_eq!(draft.config.data_to_send, "0000 030E 0120 0124 0630");
    assert_eq!(draft.part(Part::Attribute), "0x06", "as it was typed");
    let draft = typed(draft, Part::Attribute, "");
    assert_eq!((draft.config.data_to_send.as_str(), draft.length()), ("0000 020E 0120 0124", 8));
    let mut draft = typed(draft, Part::Class, "0x374");
    draft.edit(Edit::Words(PRODUCT_NAME.to_owned()));
    assert_eq!(draft.part(Part::Class), "1", "the words are newer");
}

#[test]
fn a_field_that_cannot_be_read_stays_and_leaves_the_words() {
    let draft = typed(product_name(), Part::Instance, "1x");
    assert_eq!((draft.part(Part::Instance), draft.config.data_to_send.as_str()), ("1x".into(), PRODUCT_NAME));
    assert!(errors(&draft).contains(&"Instance".to_owned()), "{:?}", errors(&draft));
    assert!(draft.check().0.is_none());
    assert_eq!(draft.waiting_parts(), [(Part::Instance, "1x".to_owned())]);
    let mut draft = typed(draft, Part::Service, "1");
    assert_eq!(draft.config.data_to_send, PRODUCT_NAME, "not before all can be read");
    assert_eq!(draft.waiting_parts().len(), 2);
    let right = typed(draft.clone(), Part::Instance, "2");
    assert_eq!(right.config.data_to_send, "0000 0301 0120 0224 0730");
    draft.edit(Edit::ForgetParts);
    assert_eq!((draft.part(Part::Service).as_str(), draft.waiting_parts().len()), ("14", 0));
}

#[test]
fn words_that_cannot_be_read_stay_as_they_are() {
    for words in ["0000 030", "0000 030E0", "0000 03GE", "10"] {
        let draft = draft(SendReqForm::Etc100, words);
        assert_eq!((draft.fields(), draft.config.data_to_send.as_str()), (Fields::Unreadable, words));
        assert!(errors(&draft).contains(&"Data_to_Send".to_owned()), "{words}: {:?}", errors(&draft));
    }
    let short = draft(SendReqForm::Etc100, "0000 030E 0120");
    assert_eq!(short.fields(), Fields::NoRequest(FieldsError::PathCut { words: 3, left: 2 }));
}

#[test]
fn a_block_without_words_begins_with_fields() {
    let draft = draft(SendReqForm::Etc101, "");
    assert_eq!(draft.fields(), Fields::Empty);
    let mut draft = typed(draft, Part::Service, "0x4E");
    assert!(errors(&draft).contains(&"Class".to_owned()));
    for (part, text) in [(Part::Class, "0x44"), (Part::Instance, "1"), (Part::Ip, "192.168.1.102")] {
        assert_eq!(draft.config.data_to_send, "");
        draft.edit(Edit::Part(part, text.to_owned()));
    }
    draft.edit(Edit::DataAs(DataAs::Uint));
    draft.edit(Edit::Part(Part::Data, "0 10".to_owned()));
    assert_eq!(draft.config.data_to_send, "0000 C0A8 0166 024E 4420 0124 0000 000A");
    assert_eq!(draft.length(), 16);
}

#[test]
fn the_length_follows_the_words_until_somebody_wants_another() {
    let mut draft = typed(product_name(), Part::Data, "05");
    assert_eq!((draft.length(), draft.config.data_to_send.as_str()), (11, "0000 030E 0120 0124 0730 0005"));
    assert_eq!(draft.part(Part::Data), "05");
    draft.edit(Edit::Words("0000 030E 0120 0124 0730 0006".to_owned()));
    assert_eq!(draft.length(), 11, "half a word stays half a word");
    draft.edit(Edit::Words("0000 030E 0120 0124 0730 0106".to_owned()));
    assert_eq!(draft.length(), 12, "its high byte is needed now");
    draft.edit(Edit::AutoLength(false));
    draft.edit(Edit::Number(Field::ManagementParam(3), "8".to_owned()));
    draft.edit(Edit::Words(PRODUCT_NAME.to_owned()));
    assert_eq!(draft.length(), 8);
    assert!(!Draft::new(draft.config.clone(), None).auto_length, "the same after a reload");
    draft.edit(Edit::AutoLength(true));
    assert_eq!(draft.length(), 10);
}

#[test]
fn a_path_that_is_no_numbers_is_bytes() {
    let mut draft = draft(SendReqForm::DataExch, "040E 0021 0001 0124 0730");
    assert!(draft.raw_path && draft.needs_raw_path());
    assert_eq!(draft.part(Part::Path), "21 00 01 00 24 01 30 07");
    draft.edit(Edit::RawPath(false));
    assert!(draft.raw_path, "numbers would send other bytes");
    draft.edit(Edit::Part(Part::Path, "20 01 24 01 30 07".to_owned()));
    draft.edit(Edit::RawPath(false));
    assert_eq!((draft.raw_path, draft.part(Part::Attribute)), (false, "7".to_owned()));
    let mut draft = typed(draft, Part::Instance, "1x");
    draft.edit(Edit::RawPath(true));
    assert!(!errors(&draft).contains(&"Instance".to_owned()), "the words are as they are shown");
    draft.edit(Edit::RawPath(false));
    assert_eq!(draft.part(Part::Instance), "1x", "nothing is lost");
}

#[test]
fn numbers_that_cannot_be_read_stay_with_their_finding() {
    let mut draft = product_name();
    draft.edit(Edit::Number(Field::ManagementParam(2), "3s".to_owned()));
    assert_eq!(draft.number(&Field::ManagementParam(2)), "3s");
    assert!(errors(&draft).contains(&"Management_Param[2]".to_owned()));
    assert!(draft.differs_from(&draft.config));
}

#[test]
fn what_nobody_sees_is_said_beside_what_is_wrong() {
    let mut draft = typed(product_name(), Part::Service, "16#\u{AD}0E");
    draft.edit(Edit::Text(Field::Address, "ADDR('0.2.0.192.\u{200B}168.1.102')".to_owned()));
    draft.edit(Edit::Number(Field::ManagementParam(2), "3\u{202F}000".to_owned()));
    let remarks = draft.check().1;
    let said = |field: &str| {
        remarks.iter().find(|it| it.field == field).map(|it| it.text.clone()).unwrap_or_default()
    };
    for (field, says) in [
        ("Service", "Character 4 cannot be seen: soft hyphen, U+00AD"),
        ("Address", "Character 17 cannot be seen: character without a width, U+200B"),
        ("Management_Param[2]", "Character 2 cannot be seen: space that is none, U+202F"),
    ] {
        assert!(said(field).contains(says), "{field}: {}", said(field));
    }
}
