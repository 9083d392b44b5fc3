//! A variable as it is typed or pasted: texts, so that what is wrong stays where it was typed.

use cipdeck_shared::config::{Choice, Scale, ValueDisplay, VariableConfig, VariableId, read_number};
use yew::AttrValue;

use crate::devices::i18n::tr;

/// What the form holds.
#[derive(Clone, Debug, Default, PartialEq)]
pub(super) struct VariableDraft {
    pub(super) name: String,
    pub(super) address: String,
    pub(super) kind: String,
    pub(super) unit: String,
    pub(super) factor: String,
    pub(super) offset: String,
    pub(super) digits: String,
    pub(super) display: String,
    /// `0 = off; 1 = on`, or one per line.
    pub(super) choices: String,
    /// A word for yes or no.
    pub(super) writable: String,
    pub(super) min: String,
    pub(super) max: String,
    pub(super) order: String,
}

/// A member of the configuration and what is wrong with it.
pub(super) type Wrong = (&'static str, AttrValue);

impl VariableDraft {
    /// As it is stored.
    pub(super) fn of(config: &VariableConfig) -> Self {
        let number = |number: Option<f64>| number.map(|number| number.to_string()).unwrap_or_default();
        let choices = config.choices.iter().map(|choice| format!("{} = {}\n", choice.value, choice.text));
        Self {
            name: config.name.clone(),
            address: config.address.clone(),
            kind: config.kind.clone(),
            unit: config.unit.clone(),
            factor: number(config.scale.map(|scale| scale.factor)),
            offset: number(config.scale.map(|scale| scale.offset)),
            digits: config.digits.map(|digits| digits.to_string()).unwrap_or_default(),
            display: config.display.word().to_owned(),
            choices: choices.collect(),
            writable: if config.writable { "yes" } else { "" }.to_owned(),
            min: number(config.min),
            max: number(config.max),
            order: if config.order == 0 { String::new() } else { config.order.to_string() },
        }
    }

    /// The member of a column.
    pub(super) fn member(&mut self, name: &str) -> Option<&mut String> {
        Some(match name {
            "name" => &mut self.name,
            "address" => &mut self.address,
            "type" => &mut self.kind,
            "unit" => &mut self.unit,
            "factor" => &mut self.factor,
            "offset" => &mut self.offset,
            "digits" => &mut self.digits,
            "display" => &mut self.display,
            "choices" => &mut self.choices,
            "writable" => &mut self.writable,
            "min" => &mut self.min,
            "max" => &mut self.max,
            "order" => &mut self.order,
            _ => return None,
        })
    }

    /// The configuration, or everything that is wrong. Without a name it is called as its address.
    pub(super) fn read(&self, parent: Option<VariableId>) -> Result<VariableConfig, Vec<Wrong>> {
        let mut wrong = Vec::new();
        let address = self.address.trim();
        if address.is_empty() {
            wrong.push(("address", tr!("check.missing")));
        }
        let name = if self.name.trim().is_empty() { address } else { self.name.trim() };
        if name.chars().count() > 128 {
            wrong.push(("name", tr!("variable.name_long")));
        }
        let (factor, offset) =
            (real("factor", &self.factor, &mut wrong), real("offset", &self.offset, &mut wrong));
        if factor == Some(0.0) {
            wrong.push(("factor", tr!("variable.factor_zero")));
        }
        let scale = (factor.is_some() || offset.is_some())
            .then(|| Scale { factor: factor.unwrap_or(1.0), offset: offset.unwrap_or(0.0) });
        let digits = whole("digits", &self.digits, &mut wrong);
        if digits.is_some_and(|digits| !(0..=9).contains(&digits)) {
            wrong.push(("digits", tr!("check.number", smallest = 0, biggest = 9)));
        }
        let (min, max) = (real("min", &self.min, &mut wrong), real("max", &self.max, &mut wrong));
        if min.zip(max).is_some_and(|(min, max)| min > max) {
            wrong.push(("max", tr!("variable.max_below")));
        }
        let config = VariableConfig {
            parent,
            name: name.to_owned(),
            address: address.to_owned(),
            kind: self.kind.trim().to_owned(),
            scale,
            unit: self.unit.trim().to_owned(),
            digits,
            display: self.read_display(&mut wrong),
            choices: self.read_choices(&mut wrong),
            writable: self.read_writable(&mut wrong),
            min,
            max,
            order: whole("order", &self.order, &mut wrong).unwrap_or(0),
        };
        if wrong.is_empty() { Ok(config) } else { Err(wrong) }
    }

    fn read_display(&self, wrong: &mut Vec<Wrong>) -> ValueDisplay {
        let word = self.display.trim().to_ascii_lowercase();
        let known = ValueDisplay::ALL.into_iter().find(|display| display.word() == word);
        if known.is_none() && !word.is_empty() {
            let words = ValueDisplay::ALL.map(ValueDisplay::word).join(", ");
            wrong.push(("display", tr!("variable.one_of", words = words)));
        }
        known.unwrap_or_default()
    }

    fn read_choices(&self, wrong: &mut Vec<Wrong>) -> Vec<Choice> {
        let mut choices = Vec::new();
        for part in self.choices.split(['\n', ';']).filter(|part| !part.trim().is_empty()) {
            let choice = part.split_once('=').and_then(|(value, text)| {
                let (value, text) = (read_number(value.trim()).ok()?, text.trim().to_owned());
                (!text.is_empty()).then_some(Choice { value, text })
            });
            match choice {
                Some(choice) => choices.push(choice),
                None => wrong.push(("choices", tr!("variable.choice_wrong", text = part.trim()))),
            }
        }
        choices
    }

    /// Spreadsheets of several languages say yes and no, TRUE and FALSE, 1 and 0.
    fn read_writable(&self, wrong: &mut Vec<Wrong>) -> bool {
        match self.writable.trim().to_ascii_lowercase().as_str() {
            "yes" | "true" | "1" | "x" | "y" | "rw" => true,
            "" | "no" | "false" | "0" | "n" | "r" | "ro" => false,
            _ => {
                wrong.push(("writable", tr!("variable.yes_or_no")));
                false
            }
        }
    }
}

/// What is wrong with a member, in words.
pub(super) fn at(wrong: &[Wrong], field: &str) -> Option<AttrValue> {
    wrong.iter().find(|(of, _)| *of == field).map(|(_, words)| words.clone())
}

/// A number; a comma is taken for the point where it can be nothing else.
fn real(field: &'static str, text: &str, wrong: &mut Vec<Wrong>) -> Option<f64> {
    let text = text.trim();
    if text.is_empty() {
        return None;
    }
    let number = text.replacen(',', ".", 1).parse().ok().filter(|number: &f64| number.is_finite());
    if number.is_none() {
        wrong.push((field, tr!("variable.no_number", text = text)));
    }
    number
}

fn whole(field: &'static str, text: &str, wrong: &mut Vec<Wrong>) -> Option<i64> {
    if text.trim().is_empty() {
        return None;
    }
    let number = read_number(text).ok();
    if number.is_none() {
        wrong.push((field, tr!("variable.no_number", text = text.trim())));
    }
    number
}

#[cfg(test)]
mod tests {
    use super::*;

    fn draft(members: &[(&str, &str)]) -> VariableDraft {
        let mut draft = VariableDraft::default();
        for (name, text) in members {
            *draft.member(name).unwrap() = (*text).to_owned();
        }
        draft
    }

    #[test]
    fn what_is_stored_comes_back() {
        let config = VariableConfig {
            parent: Some(VariableId(3)),
            kind: "INT".to_owned(),
            scale: Some(Scale { factor: 0.1, offset: -5.0 }),
            unit: "°C".to_owned(),
            digits: Some(1),
            display: ValueDisplay::Hex,
            choices: vec![Choice { value: 3, text: "running".to_owned() }],
            writable: true,
            min: Some(0.0),
            max: Some(99.5),
            order: 2,
            ..VariableConfig::new("mode", "[3]")
        };
        assert_eq!(VariableDraft::of(&config).read(config.parent), Ok(config));
    }

    #[test]
    fn without_a_name_it_is_called_as_its_address() {
        let config = draft(&[("address", " grHWCs_PV ")]).read(None).unwrap();
        assert_eq!((config.name.as_str(), config.address.as_str()), ("grHWCs_PV", "grHWCs_PV"));
    }

    #[test]
    fn spreadsheets_of_several_languages_are_read() {
        let config = draft(&[
            ("address", "a"),
            ("factor", "0,5"),
            ("writable", "TRUE"),
            ("choices", "0=off;0x1 = on"),
        ]);
        let config = config.read(None).unwrap();
        assert_eq!(config.scale, Some(Scale { factor: 0.5, offset: 0.0 }));
        assert!(config.writable);
        assert_eq!(config.choices[1], Choice { value: 1, text: "on".to_owned() });
    }

    #[test]
    fn everything_that_is_wrong_is_told_at_once() {
        let wrong = draft(&[
            ("name", &"x".repeat(129)),
            ("factor", "0"),
            ("offset", "1.2.3"),
            ("digits", "10"),
            ("display", "octal"),
            ("choices", "on"),
            ("writable", "perhaps"),
            ("min", "5"),
            ("max", "4"),
            ("order", "first"),
        ]);
        let wrong = wrong.read(None).unwrap_err();
        for field in [
            "address", "name", "factor", "offset", "digits", "display", "choices", "writable", "max", "order",
        ] {
            assert!(at(&wrong, field).is_some(), "{field}");
        }
    }
}
