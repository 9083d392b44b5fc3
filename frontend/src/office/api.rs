//! What the office asks of the relay, beside lists, which `fetch` reads.

use cipdeck_shared::api::{
    NewAllowedTarget, NewAllowedWrite, NewToken, NewUser, NewViewLink, PasswordChange, ReadOnly, SetUp,
    SignIn, TokenCreated, UserChange, ViewLinkCreated,
};
use cipdeck_shared::config::Block;
use gloo_net::http::Method;
use serde::Serialize;

use crate::net::rest::{self, Answered};

/// Makes the first administrator.
pub async fn set_up(set_up: SetUp) -> Answered<()> {
    send(Method::POST, "setup", &set_up).await
}

/// Signs in.
pub async fn sign_in(sign_in: SignIn) -> Answered<()> {
    send(Method::POST, "session", &sign_in).await
}

/// Changes one's own password.
pub async fn change_password(change: PasswordChange) -> Answered<()> {
    send(Method::POST, "session/password", &change).await
}

/// Makes a user.
pub async fn add_user(user: NewUser) -> Answered<()> {
    send(Method::POST, "users", &user).await
}

/// Changes a user.
pub async fn change_user(name: String, change: UserChange) -> Answered<()> {
    send(Method::PATCH, &format!("users/{name}"), &change).await
}

/// Makes a token.
pub async fn add_token(token: NewToken) -> Answered<TokenCreated> {
    rest::parse(&rest::ask(Method::POST, "tokens", Some(rest::json(&token)?)).await?)
}

/// Makes a view link.
pub async fn add_view_link(link: NewViewLink) -> Answered<ViewLinkCreated> {
    rest::parse(&rest::ask(Method::POST, "view-links", Some(rest::json(&link)?)).await?)
}

/// Allows a target.
pub async fn add_target(target: NewAllowedTarget) -> Answered<()> {
    send(Method::POST, "allow/targets", &target).await
}

/// Allows a write.
pub async fn add_write(write: NewAllowedWrite) -> Answered<()> {
    send(Method::POST, "allow/writes", &write).await
}

/// Turns the read-only switch on.
pub async fn set_read_only() -> Answered<()> {
    send(Method::PUT, "read-only", &ReadOnly { read_only: true }).await
}

/// Changes a block.
pub async fn replace_block(block: Block) -> Answered<Block> {
    let resource = format!("blocks/{}", block.id);
    rest::parse(&rest::ask(Method::PUT, &resource, Some(rest::json(&block)?)).await?)
}

/// Removes, ends or revokes what is at an address.
pub async fn remove(resource: String) -> Answered<()> {
    rest::ask(Method::DELETE, &resource, None).await.map(|_| ())
}

async fn send(method: Method, resource: &str, body: &impl Serialize) -> Answered<()> {
    rest::ask(method, resource, Some(rest::json(body)?)).await.map(|_| ())
}
