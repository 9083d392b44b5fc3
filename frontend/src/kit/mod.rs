//! Small components on native elements. None of them knows the relay.

mod bits;
mod check_field;
mod dialog;
mod field;
mod hex_view;
mod number_field;
mod select_field;
mod state;
mod switch;
mod text_field;
mod window_table;

pub use self::{
    bits::Bits,
    check_field::CheckField,
    dialog::Dialog,
    field::{FieldRow, describes},
    hex_view::HexView,
    number_field::{NumberField, NumberFieldProps},
    select_field::SelectField,
    state::{Shape, StateMark},
    switch::Switch,
    text_field::TextField,
    window_table::{WindowTable, WindowTableProps, window},
};
