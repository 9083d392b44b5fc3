//! Programs in Python and Rust, as far as calls with constant arguments are written in them.

mod lexer;
mod value;

pub(super) use self::lexer::{Kind, Language, Token, tokens};
pub(super) use self::value::{MAX_GROUP, Names, Value, groups, quoted, value};
