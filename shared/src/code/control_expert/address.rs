//! Addresses as programs write them.

use alloc::format;
use alloc::string::{String, ToString};

use crate::config::PlcAddress;

/// Where a communication module stands that an address does not place.
const ANYWHERE: &str = "0.0.0";

/// An address that a block can have, and what is to be said if it is not as written. `ADDM` takes the name of a network
/// instead of rack, module and channel, or leaves out the channel or all of them (Control Expert help D-SA-0023454); a dot
/// before the brace is in the help of ADDMX (D-SE-0019648).
pub(super) fn readable(text: String) -> (String, Option<String>) {
    if text.parse::<PlcAddress>().is_ok() {
        return (text, None);
    }
    let Some((module, device)) = text.split_once('{') else { return (text, None) };
    let (function, place) = module.split_once('\'').unwrap_or(("", module));
    let trimmed = place.trim().trim_end_matches('.');
    let is_number = |part: &str| !part.is_empty() && part.bytes().all(|byte| byte.is_ascii_digit());
    let count = trimmed.split('.').filter(|part| is_number(part)).count();
    let (known, words) = match count {
        3 => (trimmed.to_string(), None),
        2 => (format!("{trimmed}.0"), Some("the Address has no channel: 0 is taken".to_string())),
        _ => {
            let place = if trimmed.is_empty() {
                "the Address names no module".to_string()
            } else {
                format!("where {trimmed} is connected is not in the Address")
            };
            (ANYWHERE.to_string(), Some(format!("{place}: {ANYWHERE} stands for rack, module and channel")))
        }
    };
    let quote = if function.is_empty() { "" } else { "'" };
    let candidate = format!("{function}{quote}{known}{{{device}");
    if candidate.parse::<PlcAddress>().is_ok() { (candidate, words) } else { (text, None) }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn every_form_of_addm_names_the_device() {
        for (written, read, is_told) in [
            ("ADDM('0.1.0{10.0.0.6}UNC.CIP')", "ADDM('0.1.0{10.0.0.6}UNC.CIP')", false),
            ("ADDM('0.1{10.0.0.6}UNC.CIP')", "ADDM('0.1.0{10.0.0.6}UNC.CIP')", true),
            ("ADDM('{10.0.0.6}CON.CIP')", "ADDM('0.0.0{10.0.0.6}CON.CIP')", true),
            ("ADDM('Ethernet_1{10.0.0.6}UNC.CIP')", "ADDM('0.0.0{10.0.0.6}UNC.CIP')", true),
            ("ADDMX('0.0.3.{10.0.0.6}UNC.CIP')", "ADDMX('0.0.3{10.0.0.6}UNC.CIP')", false),
            ("ADDR('{1.4}0.2.0.10.0.0.6')", "ADDR('{1.4}0.2.0.10.0.0.6')", false),
            // Modbus is another message.
            ("ADDM('0.1.0{10.0.0.6}TCP.MBS')", "ADDM('0.1.0{10.0.0.6}TCP.MBS')", false),
            ("ADDM('Ethernet_1{10.0.0.6}')", "ADDM('Ethernet_1{10.0.0.6}')", false),
            ("ADDM('SYS')", "ADDM('SYS')", false),
        ] {
            let (address, told) = readable(written.to_string());
            assert_eq!((address.as_str(), told.is_some()), (read, is_told), "{written}");
        }
    }
}
