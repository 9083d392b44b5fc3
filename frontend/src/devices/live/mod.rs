//! What the relay says of the devices, as it says it.
//!
//! | module | job |
//! | --- | --- |
//! | [`newest`] | a value, as far as it is shown |
//! | [`values`] | the newest value of each variable |
//! | [`tree`] | devices and groups in their order |
//! | [`plant`] | the tree, what the devices say of themselves, and the connection to the relay |
//! | [`hooks`] | how components learn of it |

mod hooks;
mod newest;
mod plant;
mod tree;
mod values;

pub use self::{
    hooks::{use_device_status, use_frames, use_plant, use_tree, use_value, use_watched},
    newest::Newest,
    plant::Plant,
    tree::Tree,
    values::{Shown, ValueStore},
};
