//! A value as it was read, and how everybody sees it.

use cipdeck_shared::api::{Quality, VariableValue};
use cipdeck_shared::config::VariableId;
use cipdeck_shared::tag::{Type, Value, View};
use tokio::time::Instant;

use crate::wall_clock;

/// What is known of a variable's value.
#[derive(Clone, Debug, PartialEq)]
pub(crate) struct Point {
    /// Whether it can be relied on.
    pub(crate) quality: Quality,
    /// Why not.
    pub(crate) reason: Option<String>,
    /// The last one that was read.
    pub(crate) value: Option<Value>,
    /// Its type.
    pub(crate) kind: Option<Type>,
    /// When it was read.
    pub(crate) at: Option<Instant>,
}

impl Default for Point {
    fn default() -> Self {
        Self { quality: Quality::Waiting, reason: None, value: None, kind: None, at: None }
    }
}

/// A variable as it is shown.
#[derive(Clone, Debug, PartialEq)]
pub(crate) struct Shown {
    /// Which one.
    pub(crate) variable: VariableId,
    /// Its full address.
    pub(crate) address: String,
    /// How its value is put into words.
    pub(crate) view: View,
    /// The unit behind the words.
    pub(crate) unit: String,
    /// Why it cannot be read at all.
    pub(crate) wrong: Option<String>,
}

impl Shown {
    /// What everybody sees.
    pub(crate) fn value(&self, point: &Point) -> VariableValue {
        let value = point.value.as_ref();
        let (quality, reason) = match &self.wrong {
            Some(wrong) => (Quality::Bad, Some(wrong.clone())),
            None => (point.quality, point.reason.clone()),
        };
        VariableValue {
            variable: self.variable,
            quality,
            reason,
            text: value.map(|value| self.text(point.kind.as_ref(), value)).unwrap_or_default(),
            number: value.and_then(|value| self.view.number(value)),
            value: value.map(Value::to_json),
            kind: point.kind.as_ref().map(ToString::to_string).unwrap_or_default(),
            at: point.at.map(wall_clock::of),
            age_ms: point.at.map(|at| u64::try_from(at.elapsed().as_millis()).unwrap_or(u64::MAX)),
        }
    }

    /// A value in words, with its unit.
    pub(crate) fn text(&self, kind: Option<&Type>, value: &Value) -> String {
        let text = self.view.text(kind, value);
        if self.unit.is_empty() { text } else { format!("{text} {}", self.unit) }
    }
}

#[cfg(test)]
mod tests {
    use cipdeck_shared::tag::Scale;

    use super::*;

    #[tokio::test(start_paused = true)]
    async fn a_value_is_shown_with_its_unit_its_number_and_its_age() {
        let view =
            View { scale: Some(Scale { factor: 0.1, offset: 0.0 }), digits: Some(1), ..View::default() };
        let shown = Shown {
            variable: VariableId(1),
            address: "PV".to_owned(),
            view,
            unit: "°C".to_owned(),
            wrong: None,
        };
        let point = Point {
            quality: Quality::Good,
            value: Some(Value::Signed(215)),
            kind: "INT".parse().ok(),
            at: Some(Instant::now()),
            ..Point::default()
        };
        tokio::time::advance(std::time::Duration::from_millis(12)).await;
        let value = shown.value(&point);
        assert_eq!((value.text.as_str(), value.kind.as_str()), ("21.5 °C", "INT"));
        assert_eq!((value.number, value.value, value.age_ms), (Some(21.5), Some(215.into()), Some(12)));
        let wrong = Shown { wrong: Some("no such type".to_owned()), ..shown };
        assert_eq!(wrong.value(&Point::default()).quality, Quality::Bad);
    }
}
