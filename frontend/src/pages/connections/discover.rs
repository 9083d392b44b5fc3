//! Who is on the network: asked once, listed, and made a block by one click.

use std::net::Ipv4Addr;

use cipdeck_shared::{
    api::{DiscoverRequest, Discovered, DiscoveredDevice, Problem, ProblemCode},
    config::{MsgCipGeneric, read_number},
    plan::Severity,
};
use yew::{platform::spawn_local, prelude::*};

use crate::{
    editor::Remark,
    hooks::{use_link, use_workbench},
    i18n::{rule_text, tr},
    kit::{NumberFieldProps, TextField, number_field},
    net::rest,
    route::{self, Route},
    workbench::Workbench,
};

/// What was typed, and what came of it.
#[derive(Clone, Default)]
struct Panel {
    addresses: String,
    timeout: Option<String>,
    asking: bool,
    answer: Option<Result<Discovered, Problem>>,
}

/// Closed until somebody wants it.
#[component]
pub(crate) fn Discover() -> Html {
    let bench = use_workbench();
    use_link();
    let update = use_force_update();
    let panel = use_mut_ref(Panel::default);
    let change = {
        let panel = panel.clone();
        Callback::from(move |change: Box<dyn FnOnce(&mut Panel)>| {
            change(&mut panel.borrow_mut());
            update.force_update();
        })
    };
    let now = panel.borrow().clone();
    let (request, remarks) = read(&now);
    let online = bench.relay().is_online();
    let can_ask = online && !now.asking && remarks.is_empty();
    let onsubmit = {
        let change = change.clone();
        move |event: SubmitEvent| {
            event.prevent_default();
            if can_ask {
                ask(change.clone(), request.clone());
            }
        }
    };
    html! {
        <details class="discover" data-test="discover">
            <summary class="button">{ tr!("discover.title") }</summary>
            <form {onsubmit}>
                <p class="hint">{ tr!("discover.sends") }</p>
                { fields(&now, &remarks, &change) }
                <p class="discover-do">
                    <button type="submit" class="button primary" disabled={!can_ask} data-test="discover-do">{ tr!("discover.do") }</button>
                    <span class="quiet" role="status">
                        { match (online, now.asking) {
                            (false, _) => tr!("discover.needs_relay"),
                            (true, true) => tr!("discover.asking"),
                            (true, false) => AttrValue::default(),
                        } }
                    </span>
                </p>
            </form>
            // Always there: with one child more or less the form would be made anew, and the focus lost.
            <div>{ now.answer.as_ref().map(|answer| answered(&bench, answer)) }</div>
        </details>
    }
}

type Change = Callback<Box<dyn FnOnce(&mut Panel)>>;

fn ask(change: Change, request: DiscoverRequest) {
    change.emit(Box::new(|panel| (panel.asking, panel.answer) = (true, None)));
    spawn_local(async move {
        let answer = rest::discover(&request).await;
        change.emit(Box::new(|panel| (panel.asking, panel.answer) = (false, Some(answer))));
    });
}

fn fields(now: &Panel, remarks: &[Remark], change: &Change) -> Html {
    let of = |field: &'static str| remarks.iter().filter(move |remark| remark.field == field).cloned();
    let addresses = TextField {
        id: "discover-addresses".into(),
        name: ADDRESSES.into(),
        label: tr!("discover.addresses"),
        text: now.addresses.clone().into(),
        multiline: false,
        readout: Some(tr!("discover.addresses_hint")),
        placeholder: "192.168.1.100, 192.168.2.255",
        remarks: of(ADDRESSES).chain(refused(now)).collect(),
        on_text: change
            .reform(|text| Box::new(|panel: &mut Panel| (panel.addresses, panel.answer) = (text, None)) as _),
    };
    let timeout = NumberFieldProps {
        id: "discover-timeout".into(),
        name: TIMEOUT.into(),
        label: tr!("discover.timeout"),
        text: now.timeout.clone().unwrap_or_else(|| DEFAULT_MS.to_string()).into(),
        meaning: Some(tr!("field.ms")),
        placeholder: None,
        remarks: of(TIMEOUT).collect(),
        on_text: change.reform(|text| Box::new(|panel: &mut Panel| panel.timeout = Some(text)) as _),
    };
    html! { <>{ addresses.draw() }{ number_field(&timeout) }</> }
}

/// An address that only the relay knows to be wrong, such as the broadcast address of another network.
fn refused(now: &Panel) -> Option<Remark> {
    match &now.answer {
        Some(Err(problem)) if problem.code == ProblemCode::Unreadable => {
            Some(wrong(ADDRESSES, problem.code.word(), problem.detail.clone()))
        }
        _ => None,
    }
}

fn wrong(field: &str, rule: &str, text: String) -> Remark {
    let (field, rule) = (field.to_owned(), rule.to_owned());
    Remark { field, severity: Severity::Error, rule, text, error_ids: None }
}

const ADDRESSES: &str = "addresses";
const TIMEOUT: &str = "timeout_ms";

/// What the relay takes: docs/REST.md, Discovery.
const DEFAULT_MS: i64 = 1_000;
const MIN_MS: i64 = 100;
const MAX_MS: i64 = 10_000;

/// The request, and what is wrong with it.
fn read(panel: &Panel) -> (DiscoverRequest, Vec<Remark>) {
    let mut remarks = Vec::new();
    let mut remark = |field: &str, rule: &str, text: String| remarks.push(wrong(field, rule, text));
    let separated = panel.addresses.split(|c: char| c == ',' || c == ';' || c.is_ascii_whitespace());
    let addresses: Vec<_> = separated.filter(|text| !text.is_empty()).map(str::to_owned).collect();
    if let Some(bad) = addresses.iter().find(|text| !is_address(text)) {
        remark(ADDRESSES, "bad_address", tr!("discover.bad_address", text = bad).to_string());
    }
    let typed = panel.timeout.as_deref().map_or(Ok(DEFAULT_MS), read_number);
    match typed {
        Ok(value) if !(MIN_MS..=MAX_MS).contains(&value) => {
            let arguments = [("value", value), ("min", MIN_MS), ("max", MAX_MS)];
            let arguments = arguments.map(|(name, value)| (name, value.to_string()));
            remark(TIMEOUT, "out_of_range", rule_text("out_of_range", &arguments));
        }
        Ok(_) => {}
        Err(_) => remark(TIMEOUT, "unreadable_number", rule_text("unreadable_number", &[])),
    }
    let timeout_ms = typed.ok().and_then(|ms| u64::try_from(ms).ok());
    let addresses = (!addresses.is_empty()).then_some(addresses);
    (DiscoverRequest { addresses, timeout_ms }, remarks)
}

/// An IPv4 address, with or without a UDP port.
fn is_address(text: &str) -> bool {
    let (ip, port) = text.split_once(':').map_or((text, None), |(ip, port)| (ip, Some(port)));
    let is_port = |port: &str| port.parse::<u16>().is_ok_and(|port| port != 0);
    ip.parse::<Ipv4Addr>().is_ok() && port.is_none_or(is_port)
}

fn answered(bench: &Workbench, answer: &Result<Discovered, Problem>) -> Html {
    let discovered = match answer {
        // Said at its field.
        Err(problem) if problem.code == ProblemCode::Unreadable => return html! {},
        Err(problem) => {
            let text = tr!("discover.failed", why = problem.detail);
            return html! { <p class="finding error" role="alert" data-test="discover-problem">{ text }</p> };
        }
        Ok(discovered) => discovered,
    };
    let error = |error: &String| html! { <p class="finding warning">{ error }</p> };
    html! { <>
        { for discovered.errors.iter().map(error) }
        if discovered.devices.is_empty() {
            <p class="warning-text" data-test="nobody">{ tr!("discover.nobody") }</p>
        } else {
            <div class="devices"><table class="device-table">
                <thead><tr>{ for [
                    tr!("discover.address"), tr!("discover.name"), tr!("discover.vendor"), tr!("discover.revision"),
                    tr!("discover.serial"), tr!("discover.status"), AttrValue::default(),
                ].into_iter().map(|words| html! { <th scope="col">{ words }</th> }) }</tr></thead>
                <tbody>{ for discovered.devices.iter().map(|device| line(bench, device)) }</tbody>
            </table></div>
        }
    </> }
}

fn line(bench: &Workbench, device: &DiscoveredDevice) -> Html {
    let make = {
        let (bench, config) = (bench.clone(), block(device));
        move |_: MouseEvent| route::go(Route::Block(bench.add(config.clone())))
    };
    html! {
        <tr data-test="device">
            <td class="mono">{ format!("{}:{}", device.address, device.port) }</td>
            <th scope="row">{ &device.name }</th>
            <td>{ &device.vendor }<br /><span class="quiet">{ &device.device_type }{ ", " }{ device.product_code }</span></td>
            <td class="mono">{ &device.revision }</td>
            <td class="mono">{ &device.serial }</td>
            <td>{ &device.state }<br /><span class="quiet">{ &device.status }</span></td>
            <td><button type="button" class="button" onclick={make}>{ tr!("list.new") }</button></td>
        </tr>
    }
}

/// A first message to a device: it reads the product name.
fn block(device: &DiscoveredDevice) -> MsgCipGeneric {
    let path = match device.port {
        44_818 => format!("4,{}", device.address),
        port => format!("4,{}:{port}", device.address),
    };
    let mut config = MsgCipGeneric::product_name(&path);
    // 64 characters are the most, and a number may have to follow.
    let name: String = device.name.trim().chars().take(60).collect();
    if !name.is_empty() {
        config.name = name;
    }
    config
}

#[cfg(test)]
mod tests {
    use super::*;

    fn typed(addresses: &str, timeout: Option<&str>) -> (DiscoverRequest, Vec<String>) {
        let (addresses, timeout) = (addresses.to_owned(), timeout.map(str::to_owned));
        let (request, remarks) = read(&Panel { addresses, timeout, ..Panel::default() });
        (request, remarks.iter().map(|remark| format!("{} {}", remark.field, remark.rule)).collect())
    }

    #[test]
    fn addresses_and_time_are_read_or_found_fault_with() {
        let (request, remarks) = typed("10.0.0.1, 10.0.0.255:44818\n10.0.0.7", Some("500"));
        assert_eq!((request.addresses.unwrap().len(), request.timeout_ms, remarks.len()), (3, Some(500), 0));
        assert_eq!(typed(" ", None), (DiscoverRequest { addresses: None, timeout_ms: Some(1_000) }, vec![]));
        for (addresses, timeout, remark) in [
            ("10.0.0.256", None, "addresses bad_address"),
            ("10.0.0.1:0", None, "addresses bad_address"),
            ("drive-3", None, "addresses bad_address"),
            ("", Some("99"), "timeout_ms out_of_range"),
            ("", Some("10001"), "timeout_ms out_of_range"),
            ("", Some("1 s"), "timeout_ms unreadable_number"),
        ] {
            assert_eq!(typed(addresses, timeout).1, [remark], "{addresses} {timeout:?}");
        }
    }

    #[test]
    fn a_device_becomes_a_block_that_reads_its_name() {
        let mut device = DiscoveredDevice {
            address: "10.0.0.1".to_owned(),
            port: 44_818,
            vendor: String::new(),
            vendor_id: 1,
            device_type: String::new(),
            device_type_id: 2,
            product_code: 3,
            revision: String::new(),
            status: String::new(),
            status_word: 0,
            serial: String::new(),
            name: "PowerFlex 525 ".to_owned(),
            state: String::new(),
            state_code: 3,
            announced: None,
        };
        let config = block(&device);
        assert_eq!((config.name.as_str(), config.target_cfg.path.as_str()), ("PowerFlex 525", "4,10.0.0.1"));
        (device.port, device.name) = (44_820, String::new());
        let config = block(&device);
        assert_eq!(
            (config.name.as_str(), config.target_cfg.path.as_str()),
            ("product-name", "4,10.0.0.1:44820")
        );
    }
}
