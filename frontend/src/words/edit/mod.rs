//! Editing: typed text → draft → words → findings. Nothing here touches the page.

mod data_as;
mod draft;
mod kept;
mod number;
mod part;
mod paste;

pub use self::{
    data_as::DataAs,
    draft::{Draft, Edit, Fields},
    part::{Part, read_ip},
    paste::pasted,
};
