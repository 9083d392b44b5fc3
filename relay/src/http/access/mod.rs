//! `/api/v1/session`, `/setup`, `/users`, `/sessions`, `/tokens`, `/view-links`: who may call.

mod passes;
mod session;
mod users;
mod view;

pub(super) use self::passes::{links, make_link, make_token, revoke_link, revoke_token, tokens};
pub(super) use self::session::{active, change_password, set_up, show, sign_in, sign_out};
pub(super) use self::users::{add, change, end_session, list, remove, sessions};
pub(super) use self::view::open;

#[cfg(test)]
mod tests;
