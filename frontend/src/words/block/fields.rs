//! The fields of `Data_to_Send`: what people think in, each number in both radices and with its name.

use cipdeck_shared::{config::read_number, table, wire::ServiceCode};
use yew::prelude::*;

use super::subject::Subject;
use crate::{
    kit::{NumberFieldProps, SelectField, TextField, number_field},
    words::{
        edit::{DataAs, Edit, Part},
        i18n::tr,
    },
};

/// All fields that words of this form have.
pub(super) fn fields(subject: &Subject, edit: &Callback<Edit>) -> Html {
    let draft = &subject.draft;
    let form = draft.config.form();
    let field = |part: &Part| match part {
        Part::MessageType => message_type(subject, edit),
        Part::Ip => text(subject, edit, *part, None, "192.168.1.102"),
        Part::Members => text(subject, edit, *part, Some(members(subject)), "1 300"),
        Part::Path => text(subject, edit, *part, Some(tr!("data.path_hint")), "20 01 24 01 30 07"),
        Part::Data => html! { <>{ data_as(subject, edit) }{ data(subject, edit) }</> },
        _ => number(subject, edit, *part),
    };
    Part::ALL.iter().filter(|part| part.is_in(form, draft.raw_path)).map(field).collect()
}

fn id(part: Part) -> AttrValue {
    format!("part-{}", part.word()).into()
}

fn number(subject: &Subject, edit: &Callback<Edit>, part: Part) -> Html {
    let typed = subject.draft.part(part);
    let remarks = subject.remarks_of(part.word());
    let is_readable = remarks.iter().all(|remark| !remark.is_error());
    number_field(&NumberFieldProps {
        id: id(part),
        name: part.word().into(),
        label: part.word().into(),
        meaning: if is_readable { meaning(subject, part) } else { None },
        placeholder: matches!(part, Part::Instance | Part::Attribute).then_some(tr!("data.none")),
        text: typed.into(),
        remarks,
        on_text: edit.reform(move |text| Edit::Part(part, text)),
    })
}

fn text(
    subject: &Subject,
    edit: &Callback<Edit>,
    part: Part,
    readout: Option<AttrValue>,
    placeholder: &'static str,
) -> Html {
    TextField {
        id: id(part),
        name: part.word().into(),
        label: part.word().into(),
        text: subject.draft.part(part).into(),
        multiline: part == Part::Data,
        readout: readout.filter(|readout| !readout.is_empty()),
        placeholder,
        remarks: subject.remarks_of(part.word()),
        on_text: edit.reform(move |text| Edit::Part(part, text)),
    }
    .draw()
}

fn message_type(subject: &Subject, edit: &Callback<Edit>) -> Html {
    SelectField {
        id: id(Part::MessageType),
        name: Part::MessageType.word().into(),
        label: tr!("data.message_type"),
        value: subject.draft.part(Part::MessageType).into(),
        choices: vec![("0", tr!("form.mode_0")), ("1", tr!("form.mode_1"))],
        readout: None,
        remarks: subject.remarks_of(Part::MessageType.word()),
        on_choice: edit.reform(|value| Edit::Part(Part::MessageType, value)),
    }
    .draw()
}

fn data_as(subject: &Subject, edit: &Callback<Edit>) -> Html {
    let words = |it: DataAs| match it {
        DataAs::Bytes => tr!("data.as_bytes"),
        it => tr!("data.as_type", type_name = it.word()),
    };
    SelectField {
        id: "part-Data-as".into(),
        name: "Data_as".into(),
        label: tr!("data.as"),
        value: subject.draft.data_as.word().into(),
        choices: DataAs::ALL.iter().map(|it| (it.word(), words(*it))).collect(),
        readout: None,
        remarks: Vec::new(),
        on_choice: edit.reform(|value: String| Edit::DataAs(DataAs::of_word(&value).unwrap_or_default())),
    }
    .draw()
}

fn data(subject: &Subject, edit: &Callback<Edit>) -> Html {
    let draft = &subject.draft;
    let shown = draft.shown_data_as();
    let readout = match shown.read(&draft.part(Part::Data)) {
        Ok(data) if shown != draft.data_as => {
            tr!("data.not_of_type", count = data.len(), type_name = draft.data_as.word())
        }
        Ok(data) if shown == DataAs::Bytes => tr!("field.byte_count", count = data.len()),
        // How many there are says whether a comma has separated two.
        Ok(data) => {
            tr!("data.numbers", numbers = shown.count(&data), type_name = shown.word(), count = data.len())
        }
        Err(_) => AttrValue::default(),
    };
    let example = if shown == DataAs::Bytes { "00 00 0A 00" } else { "0 10" };
    text(subject, edit, Part::Data, Some(readout), example)
}

/// `1 = 0x01, 300 = 0x12C`
fn members(subject: &Subject) -> AttrValue {
    let text = subject.draft.part(Part::Members);
    let numbers = text.split([' ', ',', ';']).filter_map(|piece| read_number(piece).ok());
    let both: Vec<_> = numbers.map(|number| format!("{number} = 0x{number:02X}")).collect();
    if both.is_empty() { tr!("data.no_members") } else { both.join(", ").into() }
}

/// What a number means, beside its two radices.
fn meaning(subject: &Subject, part: Part) -> Option<AttrValue> {
    let number = |part| read_number(&subject.draft.part(part)).ok();
    let class = || number(Part::Class).and_then(|class| u16::try_from(class).ok());
    match part {
        Part::Service => {
            let code = u8::try_from(number(Part::Service)?).ok()?;
            // A path of bytes names its class as well.
            let class = class().or_else(|| class_of_plan(subject)).unwrap_or_default();
            Some(table::service(class, ServiceCode(code))?.name.into())
        }
        Part::Class => Some(table::class(class()?)?.name.into()),
        Part::Instance if number(Part::Instance).is_none() => Some(tr!("data.no_instance")),
        Part::Attribute if number(Part::Attribute).is_none() => Some(tr!("field.no_attribute")),
        Part::Attribute => {
            let instance = u32::try_from(number(Part::Instance)?).ok()?;
            let attribute = u16::try_from(number(Part::Attribute)?).ok()?;
            let names: Vec<_> =
                table::attribute(class()?, instance, attribute)?.iter().map(|it| it.name).collect();
            Some(names.join(", ").into())
        }
        _ => None,
    }
}

fn class_of_plan(subject: &Subject) -> Option<u16> {
    let path = subject.plan.as_ref()?.request().path();
    u16::try_from(path.logical(cipdeck_shared::wire::LogicalKind::Class)?).ok()
}
