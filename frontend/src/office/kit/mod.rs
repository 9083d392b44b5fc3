//! Small parts of the office's pages, beside those of the workbench.

mod answer;
mod confirm;
mod copy;
mod entry;

pub use self::{
    answer::{note, problem_note, waiting},
    confirm::Confirm,
    copy::CopyOnce,
    entry::{Entry, choice},
};
