//! Who is here and what they may: seen in all documents.

mod banner;
mod follow;
mod refused;
mod who;

pub use self::{
    banner::{window_obstacle, write_banner},
    follow::use_writing,
    refused::{refused, sign_in_link},
    who::{role_word, who},
};
