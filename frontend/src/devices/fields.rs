//! Fields of a form whose texts are kept in one draft, and what the relay finds fault with at them.

use std::rc::Rc;

use cipdeck_shared::{api::Problem, plan::Severity};
use web_sys::{HtmlInputElement, HtmlTextAreaElement};
use yew::prelude::*;

use super::i18n::tr;
use crate::{editor::Remark, office::kit::Entry};

/// A line of a form.
pub(super) fn text<D: Clone + 'static>(
    draft: &UseStateHandle<D>,
    id: &'static str,
    label: AttrValue,
    at: fn(&mut D) -> &mut String,
) -> Entry {
    let (text, on_text) = bound(draft, at);
    Entry { id, label, kind: "text", autocomplete: "off", text, hint: None, problem: None, on_text }
}

/// What a draft has, and how to change it.
pub(super) fn bound<D: Clone + 'static>(
    draft: &UseStateHandle<D>,
    at: fn(&mut D) -> &mut String,
) -> (String, Callback<String>) {
    let now = at(&mut (**draft).clone()).clone();
    let draft = draft.clone();
    let on_text = move |text: String| {
        let mut changed = (*draft).clone();
        *at(&mut changed) = text;
        draft.set(changed);
    };
    (now, Callback::from(on_text))
}

/// Several lines of text.
pub(super) fn area(
    id: &'static str,
    label: AttrValue,
    rows: u32,
    text: &str,
    said: Said,
    on_text: Callback<String>,
) -> Html {
    let oninput = move |event: InputEvent| {
        on_text.emit(event.target_unchecked_into::<HtmlTextAreaElement>().value());
    };
    let said_id = format!("{id}-said");
    html! {
        <div class="entry-line">
            <label for={id}>{ label }</label>
            <textarea
                {id} name={id} class="input area mono" rows={rows.to_string()} spellcheck="false" autocapitalize="none"
                value={text.to_owned()} {oninput} aria-invalid={said.is_problem().then_some("true")}
                aria-describedby={said.is_some().then(|| said_id.clone())}
            />
            { said.draw(said_id) }
        </div>
    }
}

/// What is said at a field.
pub(super) enum Said {
    Hint(AttrValue),
    Problem(AttrValue),
}

impl Said {
    /// What is wrong, or what may be typed.
    pub(super) fn of(problem: Option<AttrValue>, hint: AttrValue) -> Self {
        problem.map_or(Self::Hint(hint), Self::Problem)
    }

    fn is_some(&self) -> bool {
        !matches!(self, Self::Hint(words) if words.is_empty())
    }

    fn is_problem(&self) -> bool {
        matches!(self, Self::Problem(_))
    }

    fn draw(self, id: String) -> Html {
        match self {
            Self::Hint(words) if words.is_empty() => html! {},
            Self::Hint(words) => html! { <p {id} class="hint">{ words }</p> },
            Self::Problem(words) => html! { <p {id} class="finding error" role="alert">{ words }</p> },
        }
    }
}

/// A check box with its label beside it.
pub(super) fn check(id: &'static str, label: AttrValue, checked: bool, changed: Callback<bool>) -> Html {
    let onchange = move |event: Event| {
        changed.emit(event.target_unchecked_into::<HtmlInputElement>().checked());
    };
    html! {
        <div class="check-line">
            <input {id} type="checkbox" class="check" {checked} {onchange} />
            <label for={id}>{ label }</label>
        </div>
    }
}

/// What the relay finds fault with, by field.
#[derive(Clone, Debug, Default)]
pub(super) struct Findings(Option<Rc<Problem>>);

impl Findings {
    /// Those of a refusal.
    pub(super) fn of(problem: Option<Rc<Problem>>) -> Self {
        Self(problem.filter(|problem| problem.findings.is_some()))
    }

    /// In words, what is wrong with a field.
    pub(super) fn at(&self, field: &str) -> Option<AttrValue> {
        let words: Vec<_> = self.all().filter(|(name, _)| name == field).map(|(_, words)| words).collect();
        (!words.is_empty()).then(|| words.join(" ").into())
    }

    /// Those that belong to none of the form's fields: nothing that is said is lost.
    pub(super) fn elsewhere(&self, fields: &[&str]) -> Html {
        let others = self.all().filter(|(name, _)| !fields.contains(&name.as_str()));
        let line = |(name, words): (String, String)| {
            html! { <p class="finding error" role="alert">{ tr!("finding_at", field = name, words = words) }</p> }
        };
        html! { <>{ for others.map(line) }</> }
    }

    /// Field and words of each error.
    pub(super) fn all(&self) -> impl Iterator<Item = (String, String)> + '_ {
        let findings = self.0.iter().filter_map(|problem| problem.findings.as_ref()).flatten();
        let errors = findings.filter(|finding| finding.severity == Severity::Error);
        errors.map(|finding| (finding.field.clone(), Remark::from_relay(finding).text))
    }
}
