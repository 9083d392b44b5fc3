//! A finding in the page's language, at its field.

use cipdeck_shared::{
    api,
    config::NumberError,
    plan::{self, Field, Rule, Severity},
};

use crate::i18n::rule_text;

/// What the page says about a field.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Remark {
    /// The field as JSON names it.
    pub field: String,
    /// How bad it is.
    pub severity: Severity,
    /// The stable name of the rule.
    pub rule: String,
    /// In the page's language.
    pub text: String,
    /// `ErrorID` and `SubErrorID` that the controller would give.
    pub error_ids: Option<(u16, Option<u16>)>,
}

impl Remark {
    /// Whether it stops the block.
    pub fn is_error(&self) -> bool {
        self.severity == Severity::Error
    }

    /// A finding of the plan.
    pub fn from_rule(finding: &plan::Finding) -> Self {
        Self {
            field: finding.field.to_string(),
            severity: finding.severity,
            rule: finding.rule.name().to_owned(),
            text: rule_text(finding.rule.key(), &finding.rule.arguments()),
            error_ids: finding.error_ids(),
        }
    }

    /// A text that is no number.
    pub fn unreadable(field: &Field, error: NumberError) -> Self {
        let key = match error {
            NumberError::Empty => "number_empty",
            NumberError::UnmarkedHex => "number_unmarked_hex",
            NumberError::Unreadable => "unreadable_number",
            NumberError::TooBig => "number_too_big",
        };
        Self {
            field: field.to_string(),
            severity: Severity::Error,
            rule: "unreadable_number".to_owned(),
            text: rule_text(key, &[]),
            error_ids: None,
        }
    }

    /// A finding of the relay. It is our own rule unless the relay is newer than the page.
    pub fn from_relay(finding: &api::Finding) -> Self {
        let without_arguments =
            Rule::KEYS.contains(&finding.rule.as_str()) && !rule_text(&finding.rule, &[]).contains("%{");
        let text = if without_arguments { rule_text(&finding.rule, &[]) } else { finding.message.clone() };
        Self {
            field: finding.field.clone(),
            severity: finding.severity,
            rule: finding.rule.clone(),
            text,
            error_ids: finding.error_id.map(|id| (id, finding.sub_error_id)),
        }
    }
}
