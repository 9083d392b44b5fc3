//! What the relay says of the devices, as it says it.
//!
//! | module | job |
//! | --- | --- |
//! | `heard` | its messages |
//! | `values` | the newest value of each variable |
//! | `tree` | devices and groups in their order |
//! | `plant` | the tree, what the devices say of themselves, and the connection to the relay |
//! | `hooks` | how components learn of it |

mod heard;
mod hooks;
mod plant;
mod tree;
mod values;

pub use self::{
    heard::Newest,
    hooks::{use_device_status, use_frames, use_plant, use_tree, use_value, use_watched},
    plant::{Known, Plant},
    tree::Tree,
    values::{Shown, ValueStore},
};
