//! Fields of the form, bound to the members of a configuration.

use cipdeck_shared::{plan::Field, table, wire::ServiceCode};
use yew::prelude::*;

use super::subject::Subject;
use crate::{
    editor::{Edit, number},
    i18n::tr,
    kit::{CheckField, NumberFieldProps, number_field},
};

/// The id of a field's input: `field-AppCfg-MemberId-1`.
pub(super) fn field_id(field: &Field) -> AttrValue {
    let name: String =
        field.to_string().chars().map(|c| if c.is_ascii_alphanumeric() { c } else { '-' }).collect();
    format!("field-{}", name.trim_end_matches('-')).into()
}

/// The manual's own name: the last part of the path.
pub(super) fn member_name(field: &Field) -> AttrValue {
    let name = field.to_string();
    name.rsplit('.').next().unwrap_or(&name).to_owned().into()
}

/// A number member.
pub(super) fn number_member(subject: &Subject, edit: &Callback<Edit>, field: Field) -> Html {
    number_field(&NumberFieldProps {
        id: field_id(&field),
        name: field.to_string().into(),
        label: member_name(&field),
        text: subject.draft.text(&field).into(),
        meaning: meaning(subject, &field),
        placeholder: (field == Field::ReqLength).then_some(tr!("field.all")),
        remarks: subject.remarks_of(&field),
        on_text: edit.reform(move |text| Edit::Number(field.clone(), text)),
    })
}

/// A BOOL member.
pub(super) fn flag_member(subject: &Subject, edit: &Callback<Edit>, field: Field) -> Html {
    let config = &subject.draft.config;
    let (checked, readout) = match field {
        Field::Resume => (config.resume, tr!("field.resume")),
        Field::ConnClose => (config.target_cfg.conn_close, tr!("field.conn_close")),
        _ => (config.ctrl_cfg.cancel, tr!("field.cancel")),
    };
    let (id, name, label) = (field_id(&field), field.to_string().into(), member_name(&field));
    let remarks = subject.remarks_of(&field);
    let on_change = edit.reform(move |on| Edit::Flag(field.clone(), on));
    CheckField { id, name, label, checked, readout, remarks, on_change }.draw()
}

/// What a number means, beside its two radices.
fn meaning(subject: &Subject, field: &Field) -> Option<AttrValue> {
    let config = &subject.draft.config;
    // An unreadable text means nothing, whatever was readable before it.
    if subject.remarks_of(field).iter().any(crate::editor::Remark::is_error) {
        return None;
    }
    let value = number(config, field);
    let class = u16::try_from(config.app_cfg.class).ok();
    match (field, value?) {
        (Field::Service, code) => {
            let entry = table::service(class?, ServiceCode(u8::try_from(code).ok()?))?;
            Some(entry.name.into())
        }
        (Field::Class, _) => Some(table::class(class?)?.name.into()),
        (Field::Attribute, 0) => Some(tr!("field.no_attribute")),
        (Field::Attribute, attribute) => {
            let instance = u32::try_from(config.app_cfg.instance).ok()?;
            let fields = table::attribute(class?, instance, u16::try_from(attribute).ok()?)?;
            let names: Vec<_> = fields.iter().map(|field| field.name).collect();
            Some(names.join(", ").into())
        }
        (Field::TriggerType, 0) => Some(tr!("field.once")),
        (Field::TriggerType, 1) => Some(tr!("field.fast")),
        (Field::TriggerType, ms) => Some(tr!("field.every", ms = ms)),
        (Field::UcmmTimeout, 0) => Some(tr!("field.default_ms", ms = 3_000)),
        (Field::ConnMsgTimeout, 0) => Some(tr!("field.connected_default_ms", ms = 10_000)),
        (Field::ConnMsgTimeout, _) => Some(tr!("field.connected_ms")),
        (Field::KeepAlive, 0) => Some(tr!("field.no_keep_alive")),
        (Field::KeepAlive, _) => Some(tr!("field.keep_alive")),
        (Field::UcmmTimeout, _) => Some(tr!("field.ms")),
        (Field::ReqLength | Field::ResDataSize, _) => Some(tr!("field.bytes")),
        _ => None,
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn ids_are_made_of_the_names_in_json() {
        assert_eq!(field_id(&Field::MemberId(1)), "field-AppCfg-MemberId-1");
        assert_eq!(field_id(&Field::Service), "field-AppCfg-Service");
        assert_eq!(member_name(&Field::MemberId(1)), "MemberId[1]");
    }
}
