//! Who is here and what they may: seen in all documents.

mod banner;
mod refused;
mod who;

pub use self::{
    banner::write_banner,
    refused::{refused, sign_in_link},
    who::{role_word, who},
};
