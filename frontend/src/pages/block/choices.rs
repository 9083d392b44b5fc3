//! Members that are one of a few words.

use cipdeck_shared::{
    config::{Channel, Profile},
    plan::Field,
};
use yew::prelude::*;

use super::{
    fields::{field_id, member_name},
    subject::Subject,
};
use crate::{editor::Edit, i18n::tr, kit::SelectField};

/// `Channel`
pub(super) fn channel(subject: &Subject, edit: &Callback<Edit>) -> Html {
    channel_field(subject.draft.config.channel, &edit.reform(Edit::Channel))
}

/// Whose limits apply.
pub(crate) fn channel_field(chosen: Channel, on_choice: &Callback<Channel>) -> Html {
    let words = |word: &'static str| match word {
        "controller" => tr!("form.channel_controller"),
        "monitor" => tr!("form.channel_monitor"),
        _ => tr!("form.channel_further", channel = word),
    };
    SelectField {
        id: "field-Channel".into(),
        name: "Channel".into(),
        label: "Channel".into(),
        value: String::from(chosen).into(),
        choices: CHANNELS.iter().map(|word| (*word, words(word))).collect(),
        readout: None,
        remarks: Vec::new(),
        on_choice: on_choice.reform(|value: String| Channel::try_from(value).unwrap_or_default()),
    }
    .draw()
}

/// As a configuration spells them.
const CHANNELS: [&str; 9] = [
    "controller",
    "controller2",
    "controller3",
    "controller4",
    "controller5",
    "controller6",
    "controller7",
    "controller8",
    "monitor",
];

/// `CipConnMode`
pub(super) fn mode(subject: &Subject, edit: &Callback<Edit>) -> Html {
    let field = Field::CipConnMode;
    SelectField {
        id: field_id(&field),
        name: field.to_string().into(),
        label: member_name(&field),
        value: subject.draft.text(&field).into(),
        choices: vec![("0", tr!("form.mode_0")), ("1", tr!("form.mode_1"))],
        readout: None,
        remarks: subject.remarks_of(&field),
        on_choice: edit.reform(|value| Edit::Number(Field::CipConnMode, value)),
    }
    .draw()
}

/// `Profile`
pub(super) fn profile(subject: &Subject, edit: &Callback<Edit>) -> Html {
    profile_field(subject.draft.config.profile, &edit.reform(Edit::Profile))
}

/// What kind of device the target is.
pub(crate) fn profile_field(chosen: Profile, on_choice: &Callback<Profile>) -> Html {
    SelectField {
        id: "field-Profile".into(),
        name: "Profile".into(),
        label: "Profile".into(),
        value: chosen.word().into(),
        choices: Profile::ALL.iter().map(|profile| (profile.word(), profile.word().into())).collect(),
        readout: Some(match chosen {
            Profile::Auto => tr!("profile.auto"),
            Profile::Generic => tr!("profile.generic"),
            Profile::Micro800 => tr!("profile.micro800"),
            Profile::Logix => tr!("profile.logix"),
            Profile::Omron => tr!("profile.omron"),
        }),
        remarks: Vec::new(),
        on_choice: on_choice.reform(|value: String| Profile::of_word(&value).unwrap_or_default()),
    }
    .draw()
}
