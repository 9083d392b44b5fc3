//! One more block: for which module, to which device, with which request to begin with.

use cipdeck_shared::{
    api::Role,
    config::{SendReq, SendReqForm},
    plan::words::Preset,
};
use web_sys::HtmlInputElement;
use yew::prelude::*;

use super::{
    desk::Desk,
    edit::read_ip,
    hooks::{use_desk, use_link},
    i18n::tr,
    route::{self, Page, link},
};
use crate::{
    hooks::{use_session, use_title},
    kit::describes,
    net::session,
};

/// Form, device, preset.
#[component]
pub(super) fn NewPage() -> Html {
    let desk = use_desk();
    use_link();
    use_session();
    use_title(&tr!("list.new"));
    let form = use_state_eq(|| SendReqForm::Etc100);
    let preset = use_state_eq(|| Preset::ALL.first().map(|preset| preset.id));
    let ip = use_state_eq(|| SIMULATED.to_owned());
    if !session::may(Role::may_edit) {
        return html! {
            <div class="empty"><h1>{ tr!("list.new") }</h1><p>{ tr!("may.not_edit") }</p><p>{ link(Page::All, "", html! { tr!("block.back") }) }</p></div>
        };
    }
    let wrong = read_ip(&ip).err();
    let oninput = {
        let ip = ip.clone();
        move |event: InputEvent| ip.set(event.target_unchecked_into::<HtmlInputElement>().value())
    };
    let onsubmit = {
        let (desk, form, preset, ip) = (desk, *form, *preset, read_ip(&ip));
        move |event: SubmitEvent| {
            event.prevent_default();
            if let Ok(ip) = ip {
                begin(&desk, form, preset.and_then(Preset::of_id), ip);
            }
        }
    };
    let form_choice = |it: SendReqForm| {
        let (words, hint) = match it {
            SendReqForm::Etc100 => ("etc100", tr!("new.etc100")),
            SendReqForm::Etc101 => ("etc101", tr!("new.etc101")),
            SendReqForm::DataExch => ("data-exch", tr!("new.data_exch")),
        };
        let onchange = {
            let form = form.clone();
            move |_: Event| form.set(it)
        };
        choice("form", words, *form == it, onchange, it.to_string().into(), hint)
    };
    let preset_choice = |it: Option<Preset>| {
        let (id, title) = it.map_or(("empty", tr!("new.empty")), |it| (it.id, it.title.into()));
        let chosen = it.map(|it| it.id);
        let onchange = {
            let preset = preset.clone();
            move |_: Event| preset.set(chosen)
        };
        choice("preset", id, *preset == chosen, onchange, title, AttrValue::default())
    };
    html! {
        <form class="new-block" {onsubmit} data-test="new-block">
            <p>{ link(Page::All, "back", html! { <>{ "‹ " }{ tr!("block.back") }</> }) }</p>
            <h1>{ tr!("list.new") }</h1>
            <fieldset class="choice-set forms"><legend>{ tr!("new.form") }</legend>{ for SendReqForm::ALL.into_iter().map(form_choice) }</fieldset>
            <div class="new-ip">
                <label for="new-ip">{ tr!("new.ip") }</label>
                <input id="new-ip" name="ip" class="input mono" value={(*ip).clone()} {oninput} autocomplete="off" spellcheck="false"
                    aria-invalid={wrong.is_some().then_some("true")} aria-describedby={describes("new-ip", &[], Some(&AttrValue::default()))} />
                <p class="hint" id="new-ip-readout">
                    if let Some(wrong) = &wrong {
                        <span class="finding error" role="alert">{ wrong }</span>
                    } else if *ip == SIMULATED {
                        { tr!("new.simulated") }
                    } else {
                        { tr!("new.ip_hint") }
                    }
                </p>
            </div>
            <fieldset class="choice-set presets"><legend>{ tr!("new.preset") }</legend>
                { for Preset::ALL.into_iter().map(Some).chain([None]).map(preset_choice) }
            </fieldset>
            <div class="new-do">
                <button type="submit" class="button primary" disabled={wrong.is_some()} data-test="create">{ tr!("new.do") }</button>
                <span class="hint">{ tr!("new.nothing_sent") }</span>
            </div>
        </form>
    }
}

/// The address of the built-in simulated device.
const SIMULATED: &str = "0.0.0.0";

fn choice(
    name: &'static str,
    id: &'static str,
    checked: bool,
    onchange: impl Fn(Event) + 'static,
    title: AttrValue,
    hint: AttrValue,
) -> Html {
    html! {
        <label class={classes!("choice", checked.then_some("chosen"))}>
            <input type="radio" {name} value={id} {checked} {onchange} data-test={format!("{name}-{id}")} />
            <span class="choice-title">{ title }</span>
            if !hint.is_empty() {
                <span class="choice-hint">{ hint }</span>
            }
        </label>
    }
}

/// Makes the block, and goes to it.
fn begin(desk: &Desk, form: SendReqForm, preset: Option<Preset>, ip: [u8; 4]) {
    let config = if let Some(preset) = preset {
        preset.block(form, ip)
    } else {
        let address = Preset::ALL.first().map(|any| any.block(form, ip).address).unwrap_or_default();
        SendReq { address, ..SendReq::new(form, &tr!("list.new_name")) }
    };
    let id = desk.add(config);
    route::go(Page::Block(id));
}
