//! Tags: what controllers call their variables, which types these have, and how three families of controllers lay
//! values out in bytes.
//!
//! | module | job |
//! | --- | --- |
//! | [`TagName`] | `Program:Main.Motor[3].Speed` ↔ path |
//! | [`Type`] | `REAL`, `DINT[10]`, `STRUCT{speed: REAL; run: BOOL}`: text, size, where members lie |
//! | [`Value`] | a value of such a type; bytes, JSON and text, each in both directions |
//! | [`TagData`] | what stands before the bytes of a value |
//! | [`request`] | Read Tag, Write Tag and their relatives |
//! | [`DataFields`] | the data of any other message, field by field |
//! | [`View`] | how a person sees a number: scaled, with a unit, in words |
//!
//! Sources: Omron W506 8-4 to 8-7 (NJ/NX), pycomm3 (Logix), pylogix and libplctag (Micro800).

mod data;
mod decode;
mod dialect;
mod elementary;
mod encode;
mod fields;
mod kind;
mod layout;
mod name;
mod read_type;
mod read_value;
pub mod request;
mod value;
mod view;
mod words;

pub use self::data::{LOGIX_STRING, STRUCTURE, TagData, TagHead};
pub use self::dialect::Dialect;
pub use self::elementary::{Elementary, Form};
pub use self::fields::{DataField, DataFields, FieldKind};
pub use self::kind::{Dimension, Dimensions, Member, Place, Structure, Type};
pub use self::layout::Layout;
pub use self::name::{NameError, Step, TagName};
pub use self::read_type::{TypeError, Types};
pub use self::value::{Value, ValueError};
pub use self::view::{Display, Scale, View};
pub use self::words::{is_about_the_tag, refusal};
