//! Bytes → what they mean: a tree for the byte view and for printing, and typed values of a reply.
//!
//! Total: any bytes give a tree, and every byte is in exactly one leaf. What cannot be understood is a leaf that says
//! so ([`Node::error`]). What is only guessed is called a guess.

mod connection_manager;
mod frame;
mod message;
mod path;
mod tree;
mod value;
mod words;

pub use self::frame::frame;
pub use self::message::{reply, request};
pub use self::tree::Node;
pub use self::value::{Decoded, decode, decode_as, fields};
