//! Structured Text of IEC 61131-3, as far as messages are written in it, for every vendor.
//!
//! | | |
//! | --- | --- |
//! | [`tokens`] | text → [`Token`]s with their place; what is no token is remarked |
//! | [`Script`] | text → [`Item`]s: declarations, assignments, calls; what is none of them is remarked |
//! | [`Memory`] | what each variable holds at an item, after the initial values and the assignments before it |
//!
//! Names are compared without case: [`Reference::key`], [`Memory`] and keywords are in lower case. The conditions
//! of IF, CASE, FOR, WHILE and REPEAT are noted and left out; what is inside is read as if it stood alone.
//!
//! ```ignore
//! let script = Script::read(text);
//! let mut memory = Memory::new(&script);
//! for (index, item) in script.items.iter().enumerate() {
//!     if let Statement::Call(call) = &item.statement && call.is("SEND_REQ") {
//!         let words = call.argument(2, "Data_to_Send").and_then(|argument| argument.value.as_ref()?.reference());
//!         let third = memory.value("tab_gest[2]"); // as assigned before this call, or initially
//!     }
//!     memory.step(index, item);
//! }
//! ```

mod constant;
mod declaration;
mod grammar;
mod input;
mod literal;
mod memory;
mod reading;
mod roots;
mod script;
mod syntax;
mod token;

#[cfg(test)]
mod tests;

pub(super) use self::literal::{Literal, quoted};
pub(super) use self::memory::Memory;
pub(super) use self::reading::Reading;
pub(super) use self::roots::{left_over, roots};
pub(super) use self::script::{Item, Script};
pub(super) use self::syntax::{Call, Declaration, Declared, Expression, Reference, Statement, Step};
pub(super) use self::token::{Lexeme, Place, tokens};
