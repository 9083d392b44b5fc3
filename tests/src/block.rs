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

/// Digits of the number of [`numbered`].
const DIGITS: u32 = 8;

/// Reads a list of Identity attributes, Get_Attribute_List, that is a number below 6561: the answer names its request.
pub fn numbered(path: &str, number: u32) -> Value {
    let digits = (0..DIGITS).map(|place| number / 3_u32.pow(place) % 3 + 1);
    let list = digits.fold(String::new(), |list, attribute| list + format!("{attribute:02x}00").as_str());
    let mut block = get(path, 1, 1, 0);
    block["name"] = json!(format!("number-{number}"));
    block["AppCfg"]["Service"] = json!(3);
    block["ReqData"] = json!(format!("{DIGITS:02x}00{list}"));
    block
}

/// The number of the request that this `ResData` answers, if it is of [`numbered`].
pub fn number_of(data: &Value) -> Option<u32> {
    // UINT count, then attribute, status and value: UINTs, all of them.
    let text = data.as_str()?.strip_prefix(&format!("{DIGITS:02x}00"))?;
    (0..DIGITS).try_rfold(0, |number, place| {
        let at = 12 * usize::try_from(place).ok()?;
        let attribute: u32 = text.get(at..at + 2)?.parse().ok()?;
        Some(number * 3 + attribute.checked_sub(1)?)
    })
}

/// Over a class 3 connection.
#[must_use]
pub fn connected(block: Value) -> Value {
    with(with(block, "/TargetCfg/CipConnMode", 1), "/Profile", "generic")
}

/// Set_Attribute_Single with data as hexadecimal text.
pub fn set(path: &str, class: u32, instance: u32, attribute: u32, data: &str) -> Value {
    let mut block = get(path, class, instance, attribute);
    block["name"] = json!(format!("set-{class}-{instance}-{attribute}"));
    block["AppCfg"]["Service"] = json!(16);
    block["ReqData"] = json!(data);
    block
}

/// A SEND_REQ for a TSX ETC 100: the address names the device, `192.168.1.102` or with a TCP port.
pub fn send_req(device: &str, words: &str) -> Value {
    words_block("SEND_REQ", &format!("ADDR('0.2.0.{device}')"), words)
}

/// A SEND_REQ for a TSX ETC 101: the device is in words 1 and 2.
pub fn send_req_etc101(words: &str) -> Value {
    with(words_block("SEND_REQ", "ADDR('0.4.0')", words), "/Dialect", "ETC101")
}

/// A DATA_EXCH, `UNC` or `CON`.
pub fn data_exch(device: &str, mode: &str, words: &str) -> Value {
    words_block("DATA_EXCH", &format!("ADDMX('0.2.0{{{device}}}{mode}.CIP')"), words)
}

fn words_block(kind: &str, address: &str, words: &str) -> Value {
    json!({
        "name": format!("words of {kind}"),
        "kind": kind,
        "Address": address,
        "Data_to_Send": words,
        "Management_Param": [0, 0, 30, 2 * words.split(' ').count()],
    })
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
