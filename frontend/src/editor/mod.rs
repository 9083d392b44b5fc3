//! Editing: typed text → draft → configuration → findings. Nothing here touches the page.

mod draft;
mod drafts;
mod editable;
mod number;
mod remark;

pub use self::{
    draft::{Draft, Edit},
    drafts::{DraftStore, Keep, Keepable},
    editable::{Editable, Kind},
    number::{hexadecimal, number, other_radix},
    remark::Remark,
};
