//! What somebody is typing: keeps the text, so that `1x` stays visible, and the configuration as far as it is readable.

use cipdeck_shared::{
    api,
    config::{Channel, MsgCipGeneric, NumberError, Profile, read_number},
    plan::{Field, MessagePlan, Severity},
};

use super::{
    editable::Editable,
    number::{number, set_number},
    remark::Remark,
};
use crate::store::Shelf;

/// A block that is being edited.
#[derive(Clone, Debug, PartialEq)]
pub struct Draft {
    /// The stored revision that it started from; none for a block that is not stored yet.
    pub revision: Option<u64>,
    /// Everything readable.
    pub config: MsgCipGeneric,
    /// Numbers as typed, where they differ from how we would write them.
    typed: Shelf<Field, String>,
    /// What the relay did not accept, until something is changed.
    refused: Vec<api::Finding>,
}

/// One change.
#[derive(Clone, Debug, PartialEq)]
pub enum Edit {
    /// The text of a number field.
    Number(Field, String),
    /// `name`, `TargetCfg.Path` or `ReqData`.
    Text(Field, String),
    /// `CtrlCfg.Cancel`, `TargetCfg.ConnClose` or `Resume`.
    Flag(Field, bool),
    /// `Channel`
    Channel(Channel),
    /// `Profile`
    Profile(Profile),
}

impl Draft {
    /// A draft as it was kept over a reload.
    pub fn restored(config: MsgCipGeneric, revision: Option<u64>, typed: Shelf<Field, String>) -> Self {
        Self { typed, ..Self::new(config, revision) }
    }

    /// The text of a number field.
    pub fn text(&self, field: &Field) -> String {
        let plain = || number(&self.config, field).map(|value| value.to_string());
        self.typed.get(field).cloned().or_else(plain).unwrap_or_default()
    }

    /// The typed texts.
    pub const fn typed(&self) -> &Shelf<Field, String> {
        &self.typed
    }

    /// A message, if the draft can be sent, and everything that is to be said about it.
    pub fn check(&self) -> (Option<MessagePlan>, Vec<Remark>) {
        let unreadable: Vec<_> =
            self.typed.iter().filter_map(|(field, text)| Some((field, read(field, text).err()?))).collect();
        let (plan, findings) = MessagePlan::parse(&self.config);
        let mut remarks: Vec<_> =
            unreadable.iter().map(|(field, error)| Remark::unreadable(field, *error)).collect();
        for finding in &findings {
            if unreadable.iter().all(|(field, _)| **field != finding.field) {
                remarks.push(Remark::from_rule(finding));
            }
        }
        for refused in &self.refused {
            let remark = Remark::from_relay(refused);
            if remarks.iter().all(|other| (&other.field, &other.rule) != (&remark.field, &remark.rule)) {
                remarks.push(remark);
            }
        }
        let sendable = remarks.iter().all(|remark| remark.severity != Severity::Error);
        (plan.filter(|_| sendable), remarks)
    }

    fn type_number(&mut self, field: Field, text: String) {
        if let Ok(value) = read(&field, &text) {
            set_number(&mut self.config, &field, value);
        }
        self.typed.insert(field, text);
    }
}

impl Editable for Draft {
    type Config = MsgCipGeneric;
    type Edit = Edit;

    fn new(config: MsgCipGeneric, revision: Option<u64>) -> Self {
        Self { revision, config, typed: Shelf::default(), refused: Vec::new() }
    }

    fn config(&self) -> &MsgCipGeneric {
        &self.config
    }

    fn revision(&mut self) -> &mut Option<u64> {
        &mut self.revision
    }

    fn edit(&mut self, edit: Edit) {
        self.refused.clear();
        match edit {
            Edit::Number(field, text) => self.type_number(field, text),
            Edit::Text(field, text) => {
                if let Some(member) = text_member(&mut self.config, &field) {
                    *member = text;
                }
            }
            Edit::Flag(field, on) => {
                if let Some(member) = flag_member(&mut self.config, &field) {
                    *member = on;
                }
            }
            Edit::Channel(channel) => self.config.channel = channel,
            Edit::Profile(profile) => self.config.profile = profile,
        }
    }

    fn refuse(&mut self, findings: Vec<api::Finding>) {
        self.refused = findings;
    }

    fn differs_from(&self, stored: &MsgCipGeneric) -> bool {
        self.config != *stored || self.typed.iter().any(|(field, text)| read(field, text).is_err())
    }
}

/// Reads a number; an empty `ReqLength` means all of `ReqData`.
fn read(field: &Field, text: &str) -> Result<Option<i64>, NumberError> {
    match read_number(text) {
        Err(NumberError::Empty) if *field == Field::ReqLength => Ok(None),
        other => other.map(Some),
    }
}

fn text_member<'a>(config: &'a mut MsgCipGeneric, field: &Field) -> Option<&'a mut String> {
    match field {
        Field::Name => Some(&mut config.name),
        Field::Path => Some(&mut config.target_cfg.path),
        Field::ReqData => Some(&mut config.req_data),
        _ => None,
    }
}

fn flag_member<'a>(config: &'a mut MsgCipGeneric, field: &Field) -> Option<&'a mut bool> {
    match field {
        Field::Cancel => Some(&mut config.ctrl_cfg.cancel),
        Field::ConnClose => Some(&mut config.target_cfg.conn_close),
        Field::Resume => Some(&mut config.resume),
        _ => None,
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn draft() -> Draft {
        Draft::new(MsgCipGeneric::product_name("4,192.168.1.100"), Some(3))
    }

    fn typed(field: Field, text: &str) -> Draft {
        let mut draft = draft();
        draft.edit(Edit::Number(field, text.into()));
        draft
    }

    #[test]
    fn what_cannot_be_read_stays_visible_with_its_finding_and_is_not_sent() {
        let draft = typed(Field::Service, "1x");
        assert_eq!(draft.text(&Field::Service), "1x");
        let (plan, remarks) = draft.check();
        assert!(plan.is_none());
        assert_eq!(
            (remarks[0].field.as_str(), remarks[0].rule.as_str()),
            ("AppCfg.Service", "unreadable_number")
        );
    }

    #[test]
    fn a_number_out_of_range_is_found_at_its_field() {
        let (plan, remarks) = typed(Field::Service, "300").check();
        assert!(plan.is_none());
        assert_eq!((remarks[0].field.as_str(), remarks[0].severity), ("AppCfg.Service", Severity::Error));
        assert!(remarks[0].text.contains("1 to 127"), "{}", remarks[0].text);
    }

    #[test]
    fn hexadecimal_is_kept_as_typed_and_means_its_number() {
        let draft = typed(Field::Service, "0x0E");
        assert_eq!((draft.text(&Field::Service).as_str(), draft.config.app_cfg.service), ("0x0E", 14));
        assert!(draft.check().0.is_some());
        assert!(!draft.differs_from(&MsgCipGeneric::product_name("4,192.168.1.100")), "14 was stored");
    }

    #[test]
    fn an_empty_length_means_all_of_the_data() {
        assert_eq!(typed(Field::ReqLength, "").config.req_length, None);
        assert_eq!(typed(Field::ReqLength, "0").config.req_length, Some(0));
        assert!(typed(Field::ReqLength, "").check().0.is_some());
    }

    #[test]
    fn what_the_relay_refuses_is_shown_until_the_next_change() {
        let mut draft = draft();
        let (_, findings) = MessagePlan::parse(&typed(Field::Class, "0").config);
        draft.refuse(api::findings(&findings));
        assert!(draft.check().0.is_none());
        draft.edit(Edit::Flag(Field::Resume, true));
        assert!(draft.check().0.is_some());
    }
}
