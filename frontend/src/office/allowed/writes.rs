//! Writes that operators may send.

use cipdeck_shared::{
    api::{AllowedWrite, NewAllowedWrite, Role},
    table,
    wire::ServiceCode,
};
use yew::prelude::*;

use crate::{
    net::session,
    office::{
        allowed::write_form::WriteForm,
        fetch::use_fetched,
        i18n::tr,
        kit::{Confirm, note, waiting},
    },
};

/// The list, and a form for one more.
#[component]
pub(super) fn Writes() -> Html {
    let writes = use_fetched::<Vec<AllowedWrite>>("allow/writes".to_owned());
    let asked = use_state(|| None::<(u64, String)>);
    let may = session::may(Role::may_manage);
    let on_close = {
        let (asked, reload) = (asked.clone(), writes.reload.clone());
        Callback::from(move |removed: bool| {
            asked.set(None);
            if removed {
                reload.emit(());
            }
        })
    };
    let line = |entry: &AllowedWrite| {
        let (asked, write) = (asked.clone(), &entry.write);
        let of = entry.id.map(|id| (id, object(write)));
        html! {
            <tr key={format!("{:?} {} {}", entry.id, write.target, object(write))} data-test="allowed-write">
                <th scope="row" class="mono">{ &write.target }</th>
                <td>{ service(write) }</td>
                <td>{ object(write) }</td>
                <td>{ &write.note }</td>
                <td class="actions">{ match of {
                    None => html! { <span class="quiet">{ tr!("allowed.fixed") }</span> },
                    Some(of) if may => html! {
                        <button type="button" class="tool" onclick={move |_: MouseEvent| asked.set(Some(of.clone()))}>{ tr!("allowed.remove") }</button>
                    },
                    Some(_) => html! {},
                } }</td>
            </tr>
        }
    };
    html! {
        <section class="panel">
            <h2>{ tr!("allowed.writes") }</h2>
            { note(tr!("allowed.writes_lead")) }
            { waiting(&writes) }
            if let Some(all) = &writes.data {
                if all.is_empty() {
                    { note(tr!("allowed.no_writes")) }
                } else {
                    <div class="scroll"><table class="listing" aria-label={tr!("allowed.writes")}>
                        <thead><tr>
                            <th scope="col">{ tr!("allowed.target") }</th><th scope="col">{ tr!("write.service") }</th>
                            <th scope="col">{ tr!("write.path") }</th><th scope="col">{ tr!("allowed.why") }</th><th></th>
                        </tr></thead>
                        <tbody>{ for all.iter().map(line) }</tbody>
                    </table></div>
                }
            }
            if may {
                <WriteForm on_added={writes.reload.clone()} />
            }
            if let Some((id, name)) = &*asked {
                <Confirm
                    title={tr!("allowed.remove_title")} text={tr!("allowed.remove_write", name = name)}
                    answer={tr!("allowed.remove")} resource={format!("allow/writes/{id}")} {on_close}
                />
            }
        </section>
    }
}

fn service(write: &NewAllowedWrite) -> String {
    let name = table::service(write.class, ServiceCode(write.service)).map_or("", |entry| entry.name);
    format!("{0} = 0x{0:02X} {name}", write.service)
}

fn object(write: &NewAllowedWrite) -> String {
    let any = |number: Option<u32>| {
        number.map_or_else(|| tr!("allowed.any").to_string(), |number| number.to_string())
    };
    let name = table::class(write.class).map_or("", |entry| entry.name);
    tr!(
        "write.object",
        class = write.class,
        name = name,
        instance = any(write.instance),
        attribute = any(write.attribute.map(u32::from))
    )
    .to_string()
}
