//! Programs in Python and Rust, as far as calls with constant arguments are written in them.

mod escape;
mod lexer;
mod value;

pub(super) use self::lexer::{Kind, Language, Token, tokens};
pub(super) use self::value::{Names, Value, groups, quoted, remember, value};
