//! `/api/v1/session`, `/setup`, `/users`, `/sessions`, `/tokens`, `/view-links`: who may call.

pub(super) mod passes;
pub(super) mod session;
pub(super) mod users;
pub(super) mod view;

#[cfg(test)]
mod tests;
