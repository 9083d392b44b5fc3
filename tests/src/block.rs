//! Blocks as a client writes them in JSON, from the documents and not from the product's own types.

use serde_json::{Value, json};

/// Get_Attribute_Single of an attribute, once per run.
pub fn get(path: &str, class: u32, instance: u32, attribute: u32) -> Value {
    json!({
        "name": format!("get-{class}-{instance}-{attribute}"),
        "kind": "MSG_CIPGENERIC",
        "Channel": "controller",
        "AppCfg": { "Service": 14, "Class": class, "Instance": instance, "Attribute": attribute },
        "TargetCfg": { "Path": path },
    })
}

/// Reads the product name: Identity 1/1/7.
pub fn product_name(path: &str) -> Value {
    get(path, 1, 1, 7)
}

/// Set_Attribute_Single with data as hexadecimal text.
pub fn set(path: &str, class: u32, instance: u32, attribute: u32, data: &str) -> Value {
    let mut block = get(path, class, instance, attribute);
    block["name"] = json!(format!("set-{class}-{instance}-{attribute}"));
    block["AppCfg"]["Service"] = json!(16);
    block["ReqData"] = json!(data);
    block
}

/// The block with another member, named by a JSON pointer such as `/TargetCfg/UcmmTimeout`.
#[must_use]
pub fn with(mut block: Value, pointer: &str, value: impl Into<Value>) -> Value {
    let (parent, member) = pointer.rsplit_once('/').expect("a JSON pointer");
    let parent = block.pointer_mut(parent).unwrap_or_else(|| panic!("{pointer} has a parent"));
    parent[member] = value.into();
    block
}

/// Hexadecimal text as the relay writes it.
pub fn hex(bytes: &[u8]) -> String {
    bytes.iter().fold(String::new(), |text, byte| text + format!("{byte:02x}").as_str())
}

/// A SHORT_STRING as hexadecimal text.
pub fn short_string(text: &str) -> String {
    let length = u8::try_from(text.len()).expect("at most 255 characters");
    hex(&[&[length], text.as_bytes()].concat())
}
