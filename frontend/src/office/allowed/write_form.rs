//! One more write that operators may send.

use cipdeck_shared::api::NewAllowedWrite;
use yew::prelude::*;

use crate::office::{
    api, check,
    fetch::use_action,
    i18n::tr,
    kit::{Entry, problem_note},
};

#[derive(Clone, PartialEq, Properties)]
pub(super) struct WriteFormProps {
    pub(super) on_added: Callback<()>,
}

/// Target, service, class; instance and attribute may be left out.
#[component]
pub(super) fn WriteForm(props: &WriteFormProps) -> Html {
    let action = use_action();
    let (target, why) = (use_state(String::new), use_state(String::new));
    let (service, class) = (use_state(|| "16".to_owned()), use_state(String::new));
    let (instance, attribute) = (use_state(String::new), use_state(String::new));
    let tried = use_state(|| false);
    let read = (
        check::number(&service, 1, 127),
        check::number(&class, 0, 65_535),
        optional(&instance, u32::MAX),
        optional(&attribute, 65_535),
    );
    let missing = check::needed(&target);
    let onsubmit = {
        let (action, target, why, tried) = (action.clone(), target.clone(), why.clone(), tried.clone());
        let (read, is_named, on_added) = (read.clone(), missing.is_none(), props.on_added.clone());
        move |event: SubmitEvent| {
            event.prevent_default();
            tried.set(true);
            let ((Ok(service), Ok(class), Ok(instance), Ok(attribute)), true) = (read.clone(), is_named)
            else {
                return;
            };
            let new = NewAllowedWrite {
                target: target.trim().to_owned(),
                service: u8::try_from(service).unwrap_or_default(),
                class: u16::try_from(class).unwrap_or_default(),
                instance,
                attribute: attribute.and_then(|number| u16::try_from(number).ok()),
                note: why.trim().to_owned(),
            };
            let (on_added, tried) = (on_added.clone(), tried.clone());
            action.go(api::add_write(new), move |()| {
                tried.set(false);
                on_added.emit(());
            });
        }
    };
    let (service_read, class_read, instance_read, attribute_read) = read;
    let told = |problem: Option<AttrValue>| problem.filter(|_| *tried);
    html! { <>
        <form class="inline-form" {onsubmit}>
            { Entry::text("write-target", tr!("allowed.target"), &target).problem(told(missing)).draw() }
            { Entry::text("write-service", tr!("write.service"), &service).problem(service_read.err()).draw() }
            { Entry::text("write-class", tr!("allowed.class"), &class).problem(told(class_read.err())).draw() }
            { Entry::text("write-instance", tr!("allowed.instance"), &instance).hint(tr!("allowed.empty_any")).problem(instance_read.err()).draw() }
            { Entry::text("write-attribute", tr!("allowed.attribute"), &attribute).hint(tr!("allowed.empty_any")).problem(attribute_read.err()).draw() }
            { Entry::text("write-note", tr!("allowed.why"), &why).draw() }
            <button type="submit" class="button primary" disabled={action.is_busy()} data-test="add-write">{ tr!("allowed.add") }</button>
        </form>
        { problem_note(action.problem().as_ref()) }
    </> }
}

/// Nothing stands for any number.
fn optional(text: &str, biggest: u32) -> Result<Option<u32>, AttrValue> {
    if text.trim().is_empty() { Ok(None) } else { check::number(text, 0, biggest).map(Some) }
}
