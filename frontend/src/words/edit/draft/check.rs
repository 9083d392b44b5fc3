//! What is to be said about a draft.

use cipdeck_shared::{
    config::{BlockConfig, read_number},
    plan::{MessagePlan, Severity},
};

use super::{super::part::Part, Draft};
use crate::{editor::Remark, invisible::Invisible, words::i18n::tr};

impl Draft {
    /// A message, if the draft can be sent, and everything that is to be said about it.
    pub fn check(&self) -> (Option<MessagePlan>, Vec<Remark>) {
        let mut remarks = Vec::new();
        for (field, text) in self.numbers.iter() {
            remarks.extend(read_number(text).err().map(|error| Remark::unreadable(field, error)));
        }
        let typed: Vec<_> = remarks.iter().map(|remark| remark.field.clone()).collect();
        remarks.extend(self.wrong_parts().into_iter().map(|(part, text)| wrong(part, text)));
        let (plan, findings) = MessagePlan::check(&BlockConfig::SendReq(self.config.clone()));
        let found = findings.iter().map(Remark::from_rule);
        remarks.extend(found.filter(|remark| !typed.contains(&remark.field)));
        for refused in &self.refused {
            let remark = Remark::from_relay(refused);
            if remarks.iter().all(|other| (&other.field, &other.rule) != (&remark.field, &remark.rule)) {
                remarks.push(remark);
            }
        }
        for remark in remarks.iter_mut().filter(|remark| remark.is_error()) {
            // Nobody finds by looking what cannot be seen.
            if let Some(found) = self.text_of(&remark.field).as_deref().and_then(Invisible::first_of) {
                let hint = tr!("data.invisible", position = found.position, name = found.name());
                remark.text = format!("{}. {hint}", remark.text);
            }
        }
        let sendable = remarks.iter().all(|remark| remark.severity != Severity::Error);
        (plan.filter(|_| sendable), remarks)
    }

    /// What somebody has typed into a field, by its name.
    fn text_of(&self, name: &str) -> Option<String> {
        let number =
            self.numbers.iter().find(|(field, _)| field.to_string() == name).map(|(_, text)| text.clone());
        let part = || Part::ALL.into_iter().find(|part| part.word() == name).map(|part| self.part(part));
        let text = || match name {
            "Address" => Some(self.config.address.clone()),
            "Data_to_Send" => Some(self.config.data_to_send.clone()),
            "ReqLayout" => Some(self.config.req_layout.clone()),
            "ResLayout" => Some(self.config.res_layout.clone()),
            _ => None,
        };
        number.or_else(part).or_else(text)
    }
}

fn wrong(part: Part, text: String) -> Remark {
    Remark {
        field: part.word().to_owned(),
        severity: Severity::Error,
        rule: "unreadable_field".to_owned(),
        text,
        error_ids: None,
    }
}
