//! The small components in a real browser: labels, findings, radices, the window of a table.
#![cfg(target_arch = "wasm32")]
#![allow(clippy::unwrap_used, reason = "a test may fail")]

mod page;

use std::{cell::Cell, rc::Rc};

use cipdeck_frontend::{
    editor::Remark,
    kit::{NumberFieldProps, WindowTable, WindowTableProps, number_field},
    store::DeckId,
};
use cipdeck_shared::plan::Severity;
use page::{find, render, text, try_find, type_into};
use wasm_bindgen_test::{wasm_bindgen_test, wasm_bindgen_test_configure};
use yew::{Callback, Html, component, html};

wasm_bindgen_test_configure!(run_in_browser);

#[component]
fn NumberField(props: &NumberFieldProps) -> Html {
    number_field(props)
}

fn service(text: &str, remarks: Vec<Remark>, on_text: Callback<String>) -> NumberFieldProps {
    NumberFieldProps {
        id: "field-service".into(),
        name: "AppCfg.Service".into(),
        label: "Service".into(),
        text: text.to_owned().into(),
        meaning: Some("Get_Attribute_Single".into()),
        placeholder: None,
        remarks,
        on_text,
    }
}

fn error(words: &str) -> Remark {
    Remark {
        field: "AppCfg.Service".into(),
        severity: Severity::Error,
        rule: "out_of_range".into(),
        text: words.into(),
        error_ids: Some((33, Some(50))),
    }
}

#[wasm_bindgen_test]
async fn a_number_is_shown_in_both_radices_with_its_name() {
    let decimal = render::<NumberField>(service("14", vec![], Callback::noop())).await;
    assert_eq!(text(&decimal, "#field-service-readout"), "= 0x0E  Get_Attribute_Single");
    let hex = render::<NumberField>(service("0x0E", vec![], Callback::noop())).await;
    assert_eq!(text(&hex, "#field-service-readout"), "= 14  Get_Attribute_Single");
}

#[wasm_bindgen_test]
async fn a_field_has_its_label_and_points_at_its_finding() {
    let root =
        render::<NumberField>(service("300", vec![error("300 is outside 1 to 127")], Callback::noop())).await;
    assert_eq!(text(&root, "label[for=field-service]"), "Service");
    let input = find(&root, "#field-service");
    assert_eq!(input.get_attribute("aria-invalid").as_deref(), Some("true"));
    let described = input.get_attribute("aria-describedby").unwrap();
    assert!(described.split(' ').all(|id| try_find(&root, &format!("#{id}")).is_some()), "{described}");
    assert!(text(&root, "#field-service-finding [role=alert]").contains("300 is outside 1 to 127"));
    assert!(text(&root, "#field-service-finding").contains("33/50"));
}

#[wasm_bindgen_test]
async fn a_field_without_findings_points_at_none() {
    let root = render::<NumberField>(service("14", vec![], Callback::noop())).await;
    let input = find(&root, "#field-service");
    assert_eq!(input.get_attribute("aria-describedby").as_deref(), Some("field-service-readout"));
    assert!(!input.has_attribute("aria-invalid"));
}

#[wasm_bindgen_test]
async fn what_is_typed_is_told() {
    let heard = Rc::new(std::cell::RefCell::new(String::new()));
    let hear = heard.clone();
    let root =
        render::<NumberField>(service("14", vec![], Callback::from(move |text| *hear.borrow_mut() = text)))
            .await;
    type_into(&root, "#field-service", "1x").await;
    assert_eq!(*heard.borrow(), "1x");
}

#[wasm_bindgen_test]
async fn a_thousand_rows_are_a_few_in_the_document() {
    let rendered = Rc::new(Cell::new(0));
    let count = rendered.clone();
    let row = Callback::from(move |(index, id): (usize, DeckId)| {
        count.set(count.get() + 1);
        html! { <tr key={id.to_string()} aria-rowindex={index.to_string()}><td>{ id.to_string() }</td></tr> }
    });
    let ids: Rc<[DeckId]> = (1..=1_000).map(DeckId::New).collect();
    let header = html! { <th>{ "Name" }</th> };
    let props = WindowTableProps { label: "Blocks".into(), ids, row_height: 32, header, row };
    let root = render::<WindowTable<DeckId>>(props).await;
    let table = find(&root, "table");
    assert_eq!(table.get_attribute("aria-rowcount").as_deref(), Some("1001"), "the header counts");
    let rows = root.query_selector_all("tr[aria-rowindex]").unwrap().length();
    assert!(rows < 60, "{rows} rows in the document");
    assert_eq!(text(&root, "tr[aria-rowindex='2'] td"), "new-1");
}
