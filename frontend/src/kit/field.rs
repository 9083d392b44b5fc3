//! A labelled field with its findings. There is no field without a label, and no finding without its field.

use cipdeck_shared::plan::Severity;
use yew::prelude::*;

use crate::{editor::Remark, i18n::tr};

/// The ids for `aria-describedby`: only what is there.
pub fn describes(id: &str, remarks: &[Remark], readout: Option<&AttrValue>) -> Option<AttrValue> {
    let finding = (!remarks.is_empty()).then(|| format!("{id}-finding"));
    let readout = readout.map(|_| format!("{id}-readout"));
    let ids: Vec<_> = finding.into_iter().chain(readout).collect();
    (!ids.is_empty()).then(|| ids.join(" ").into())
}

/// Label, input, readout and findings. A function: with nothing of its own to remember, a component would only cost.
pub fn field_row(
    id: &AttrValue,
    label: &AttrValue,
    remarks: &[Remark],
    readout: Option<&AttrValue>,
    input: Html,
) -> Html {
    html! {
        <div class="field">
            <label class="field-label" for={id.clone()}>{ label }</label>
            <div class="field-control">
                { input }
                if let Some(readout) = readout {
                    <span class="readout" id={format!("{id}-readout")}>{ readout }</span>
                }
            </div>
            if !remarks.is_empty() {
                <div class="findings" id={format!("{id}-finding")}>
                    { for remarks.iter().map(finding) }
                </div>
            }
        </div>
    }
}

/// One remark: how bad, what, and what the controller would say.
pub(crate) fn finding(remark: &Remark) -> Html {
    let (kind, word) = match remark.severity {
        Severity::Error => ("error", tr!("severity.error")),
        Severity::Warning => ("warning", tr!("severity.warning")),
        Severity::Note => ("note", tr!("severity.note")),
    };
    let role = (remark.severity == Severity::Error).then_some("alert");
    let would_be = remark.error_ids.map(|(error, sub)| {
        let codes = sub.map_or_else(|| error.to_string(), |sub| format!("{error}/{sub}"));
        tr!("finding.controller", codes = codes)
    });
    html! {
        <p class={classes!("finding", kind)} {role} data-rule={remark.rule.clone()}>
            <span class="finding-word">{ word }</span>
            { &remark.text }
            if let Some(would_be) = would_be {
                <span class="finding-code">{ would_be }</span>
            }
        </p>
    }
}
