//! Small components on native elements. None of them knows the relay.

mod bits;
mod check_field;
mod dialog;
mod field;
mod hex_view;
mod number_field;
mod scale;
mod select_field;
mod state;
mod switch;
mod text_field;
mod window_table;

pub use self::{
    bits::status_bits,
    check_field::CheckField,
    dialog::Dialog,
    field::{describes, field_row},
    hex_view::HexView,
    number_field::{NumberFieldProps, number_field},
    scale::{Scale, short},
    select_field::SelectField,
    state::{Shape, state_mark},
    switch::Switch,
    text_field::TextField,
    window_table::{WindowTable, WindowTableProps, window},
};
pub(crate) use self::{
    field::finding,
    hex_view::{Leaf, leaves},
};
