//! The fields of a variable.

use cipdeck_shared::config::{ValueDisplay, VariableId};
use yew::prelude::*;

use super::{VariableDialogProps, shape::Shape};
use crate::{
    devices::{
        fields::{Findings, Said, area, bound, check, text},
        group::draft::{VariableDraft, Wrong, at},
        i18n::tr,
        live::Shown,
    },
    office::kit::choice,
};

/// What the fields show.
pub(super) struct Fields<'a> {
    pub(super) draft: &'a UseStateHandle<VariableDraft>,
    pub(super) parent: &'a UseStateHandle<Option<VariableId>>,
    pub(super) shape: Shape,
    pub(super) wrong: &'a [Wrong],
    pub(super) findings: &'a Findings,
    pub(super) props: &'a VariableDialogProps,
    pub(super) address: &'a str,
    pub(super) own: Option<&'a Shown>,
}

impl Fields<'_> {
    /// What is wrong with a member: found here, or by the relay, which counts what it was sent.
    fn said(&self, field: &'static str) -> Option<AttrValue> {
        let of_list = || self.findings.at(&format!("variables[0].{field}"));
        at(self.wrong, field).or_else(|| self.findings.at(field)).or_else(of_list)
    }
}

/// The members that have a field here.
const FIELDS: [&str; 15] = [
    "name",
    "address",
    "type",
    "unit",
    "factor",
    "offset",
    "scale.factor",
    "scale.offset",
    "digits",
    "display",
    "choices",
    "writable",
    "min",
    "max",
    "parent",
];

/// Address and type first; how it is shown and written below.
pub(super) fn fields(it: &Fields<'_>) -> Html {
    let draft = it.draft;
    let (kind_hint, address_hint) = match (it.shape, **it.parent) {
        (Shape::Structure, _) => (tr!("variable.type_structure"), tr!("variable.address_structure")),
        (Shape::Array, _) => (tr!("variable.type_array"), tr!("variable.address_array")),
        (Shape::Plain, None) => (tr!("variable.type_hint"), tr!("variable.address_hint")),
        (Shape::Plain, Some(_)) => (tr!("variable.type_hint"), tr!("variable.address_part")),
    };
    let known = it.own.map(|own| own.value.kind.clone()).filter(|kind| !kind.is_empty());
    let kind_hint = known.map_or(kind_hint, |kind| tr!("variable.type_known", kind = kind));
    html! { <>
        { parents(it) }
        { text(draft, "variable-address", tr!("variable.address"), |draft| &mut draft.address).hint(address_hint).problem(it.said("address")).draw() }
        if it.parent.is_some() && !draft.address.is_empty() {
            <p class="hint" data-test="full-address">{ tr!("variable.full_address") }{ " " }<span class="mono">{ it.address }</span></p>
        }
        { text(draft, "variable-name", tr!("variable.name"), |draft| &mut draft.name).hint(tr!("variable.name_hint")).problem(it.said("name")).draw() }
        { text(draft, "variable-type", tr!("variable.type"), |draft| &mut draft.kind).hint(kind_hint).problem(it.said("type")).draw() }
        if it.shape == Shape::Plain {
            { shown(it) }
        }
        { it.findings.elsewhere(&FIELDS.iter().flat_map(|field| [(*field).to_owned(), format!("variables[0].{field}")]).collect::<Vec<_>>().iter().map(String::as_str).collect::<Vec<_>>()) }
    </> }
}

/// What it is a part of: variables that have parts, or could.
fn parents(it: &Fields<'_>) -> Html {
    let lines = &it.props.lines;
    let own = it.props.stored.as_ref().map(|stored| stored.id);
    let could = |kind: &str| kind.contains(['[', '{']) || it.props.device.config.types.contains_key(kind);
    let candidates = lines.ids.iter().filter_map(|id| lines.line(*id)).filter(|line| {
        let id = line.variable.id;
        Some(id) != own && (line.has_parts || could(&line.variable.config.kind) || **it.parent == Some(id))
    });
    let choices: Vec<_> = candidates
        .map(|line| (AttrValue::from(line.variable.id.to_string()), AttrValue::from(line.address.clone())))
        .collect();
    if choices.is_empty() {
        return html! {};
    }
    let choices: Vec<_> =
        [(AttrValue::from(""), tr!("variable.no_parent"))].into_iter().chain(choices).collect();
    let chosen = it.parent.map(|id| id.to_string()).unwrap_or_default();
    let parent = it.parent.clone();
    let on_choice = Callback::from(move |text: String| parent.set(text.parse().ok()));
    choice("variable-parent", tr!("variable.parent"), &chosen, &choices, on_choice)
}

fn shown(it: &Fields<'_>) -> Html {
    let draft = it.draft;
    let (display, on_display) = bound(draft, |draft| &mut draft.display);
    let (choices, on_choices) = bound(draft, |draft| &mut draft.choices);
    let (writable, on_writable) = bound(draft, |draft| &mut draft.writable);
    let displays = ValueDisplay::ALL.map(|it| (it.word().into(), display_words(it)));
    let is_writable = !writable.is_empty();
    let on_writable = on_writable.reform(|on: bool| if on { "yes".to_owned() } else { String::new() });
    let line = |id, words, member, field| text(draft, id, words, member).problem(it.said(field)).draw();
    let more = it.said("factor").or(it.said("offset")).or(it.said("digits")).or(it.said("choices")).is_some();
    let is_scaled = !(draft.factor.is_empty() && draft.offset.is_empty() && draft.choices.is_empty());
    html! { <>
        { line("variable-unit", tr!("variable.unit"), |draft| &mut draft.unit, "unit") }
        <details class="field-more" open={more || is_scaled}>
            <summary>{ tr!("variable.more") }</summary>
            <div class="pair">
                { line("variable-factor", tr!("variable.factor"), |draft| &mut draft.factor, "factor") }
                { line("variable-offset", tr!("variable.offset"), |draft| &mut draft.offset, "offset") }
                { line("variable-digits", tr!("variable.digits"), |draft| &mut draft.digits, "digits") }
                { choice("variable-display", tr!("variable.display"), if display.is_empty() { "auto" } else { &display }, &displays, on_display) }
            </div>
            <p class="hint">{ tr!("variable.scale_hint") }</p>
            { area("variable-choices", tr!("variable.choices"), 2, &choices, Said::of(it.said("choices"), tr!("variable.choices_hint")), on_choices) }
        </details>
        { check("variable-writable", tr!("variable.writable"), is_writable, on_writable) }
        if is_writable {
            <div class="pair">
                { line("variable-min", tr!("variable.min"), |draft| &mut draft.min, "min") }
                { line("variable-max", tr!("variable.max"), |draft| &mut draft.max, "max") }
            </div>
        }
    </> }
}

fn display_words(display: ValueDisplay) -> AttrValue {
    match display {
        ValueDisplay::Auto => tr!("display.auto"),
        ValueDisplay::Dec => tr!("display.dec"),
        ValueDisplay::Hex => tr!("display.hex"),
        ValueDisplay::Bin => tr!("display.bin"),
        ValueDisplay::Float => tr!("display.float"),
        ValueDisplay::Ascii => tr!("display.ascii"),
    }
}
