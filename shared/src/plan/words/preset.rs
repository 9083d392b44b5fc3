//! Messages to begin with, for a block of any form.
//!
//! Sources: Identity: ODVA; Modbus object: Schneider EIO0000001601 p. 67.

use alloc::string::ToString;
use core::net::Ipv4Addr;

use crate::config::{SendReq, SendReqForm, bytes_of, words_of, write_words};

use super::split::head;

/// A named request.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Preset {
    /// Stable; also the block's name.
    pub id: &'static str,
    /// English.
    pub title: &'static str,
    /// What the data of the request is, as a layout.
    pub req_layout: &'static str,
    /// What the data of the reply is, as a layout; empty where it is known by its attribute.
    pub res_layout: &'static str,
    /// Service, path size, path, data.
    request: &'static [u8],
}

const START: &str = "start: UINT; quantity: UINT";

impl Preset {
    /// All of them.
    pub const ALL: [Self; 6] = [
        Self {
            id: "identity-name",
            title: "Identity: product name",
            req_layout: "",
            res_layout: "",
            request: &[0x0E, 3, 0x20, 1, 0x24, 1, 0x30, 7],
        },
        Self {
            id: "identity-serial",
            title: "Identity: serial number",
            req_layout: "",
            res_layout: "",
            request: &[0x0E, 3, 0x20, 1, 0x24, 1, 0x30, 6],
        },
        Self {
            id: "identity-all",
            title: "Identity: all attributes",
            req_layout: "",
            res_layout: "",
            request: &[0x01, 2, 0x20, 1, 0x24, 1],
        },
        Self {
            id: "modbus-read",
            title: "Modbus object: read holding registers 0 to 9",
            req_layout: START,
            res_layout: "register: INT[10]",
            request: &[0x4E, 2, 0x20, 0x44, 0x24, 1, 0, 0, 10, 0],
        },
        Self {
            id: "modbus-write",
            title: "Modbus object: write 1234 into holding register 100",
            req_layout: "start: UINT; quantity: UINT; register: INT[1]",
            res_layout: "",
            request: &[0x50, 2, 0x20, 0x44, 0x24, 1, 100, 0, 1, 0, 0xD2, 0x04],
        },
        Self {
            id: "tcpip-config",
            title: "TCP/IP object: interface configuration",
            req_layout: "",
            res_layout: "",
            request: &[0x0E, 3, 0x20, 0xF5, 0x24, 1, 0x30, 5],
        },
    ];

    /// By its name.
    pub fn of_id(id: &str) -> Option<Self> {
        Self::ALL.into_iter().find(|preset| preset.id == id)
    }

    /// The request as a block for a device, through a module in position 2 of rack 0.
    pub fn block(self, form: SendReqForm, ip: [u8; 4]) -> SendReq {
        let mut config = SendReq::new(form, self.id);
        let device = Ipv4Addr::from(ip);
        config.address = match form {
            SendReqForm::Etc100 => alloc::format!("ADDR('0.2.0.{device}')"),
            SendReqForm::Etc101 => "ADDR('0.2.0')".to_string(),
            SendReqForm::DataExch => alloc::format!("ADDMX('0.2.0{{{device}}}UNC.CIP')"),
        };
        let bytes = [&bytes_of(&head(form, 0, ip)), self.request].concat();
        config.data_to_send = write_words(&words_of(&bytes));
        if let (Some(length), Ok(bytes)) = (config.management_param.get_mut(3), bytes.len().try_into()) {
            *length = bytes;
        }
        (config.req_layout, config.res_layout) = (self.req_layout.to_string(), self.res_layout.to_string());
        config
    }
}
