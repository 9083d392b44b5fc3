//! Signing in and out, and set-up.

use axum::Json as Answer;
use axum::extract::{Request, State};
use axum::http::{HeaderValue, StatusCode, header};
use axum::response::IntoResponse;
use cipdeck_shared::api::{
    ActorKind, Caller as CallerView, PasswordChange, SessionState, SessionView, SetUp, SignIn,
};

use super::super::caller::Caller;
use super::super::extract::{Json, Peer};
use crate::access::{Known, SignedIn, no_cookie, session_cookie};
use crate::app::App;
use crate::error::ApiError;
use crate::tls::Tls;
use crate::wall_clock;

/// Who the caller is; also for somebody who is not signed in.
#[utoipa::path(
    get,
    path = "/session",
    tag = "access",
    responses((status = 200, description = "The caller", body = SessionView))
)]
pub(in crate::http) async fn show(State(app): State<App>, request: Request) -> Answer<SessionView> {
    Answer(view(&app, request.extensions().get::<Known>()))
}

/// Signs in.
#[utoipa::path(
    post,
    path = "/session",
    tag = "access",
    request_body = SignIn,
    extensions(("x-cipdeck-problems" = json!(["signed_out", "too_many"]))),
    responses((status = 200, description = "The caller", body = SessionView, headers(("set-cookie" = String, description = "The session"))))
)]
pub(in crate::http) async fn sign_in(
    State(app): State<App>,
    Peer(peer): Peer,
    old: Option<Caller>,
    Json(form): Json<SignIn>,
) -> Result<impl IntoResponse, ApiError> {
    let signed_in = app.access.sign_in(form, peer).await?;
    if let Some(Caller(old)) = old {
        app.access.sign_out(&old);
    }
    signed(&app, &signed_in)
}

/// Makes the first administrator and signs in.
#[utoipa::path(
    post,
    path = "/setup",
    tag = "access",
    request_body = SetUp,
    extensions(("x-cipdeck-problems" = json!(["conflict", "too_many"]))),
    responses((status = 200, description = "The caller", body = SessionView, headers(("set-cookie" = String, description = "The session"))))
)]
pub(in crate::http) async fn set_up(
    State(app): State<App>,
    Peer(peer): Peer,
    Json(form): Json<SetUp>,
) -> Result<impl IntoResponse, ApiError> {
    let signed_in = app.access.set_up(form, peer).await?;
    signed(&app, &signed_in)
}

/// Signs out.
#[utoipa::path(
    delete,
    path = "/session",
    tag = "access",
    responses((status = 204, description = "Signed out"))
)]
pub(in crate::http) async fn sign_out(State(app): State<App>, caller: Option<Caller>) -> impl IntoResponse {
    let mut kind = ActorKind::Person;
    if let Some(Caller(actor)) = caller {
        app.access.sign_out(&actor);
        kind = actor.kind();
    }
    (StatusCode::NO_CONTENT, [(header::SET_COOKIE, no_cookie(kind))])
}

/// Somebody is there: the session is not locked for being idle.
#[utoipa::path(
    post,
    path = "/session/active",
    tag = "access",
    responses((status = 204, description = "Noted"))
)]
pub(in crate::http) async fn active() -> StatusCode {
    StatusCode::NO_CONTENT
}

/// Changes one's own password.
#[utoipa::path(
    post,
    path = "/session/password",
    tag = "access",
    request_body = PasswordChange,
    extensions(("x-cipdeck-problems" = json!(["too_many"]))),
    responses((status = 204, description = "It is changed"))
)]
pub(in crate::http) async fn change_password(
    State(app): State<App>,
    Caller(actor): Caller,
    Json(change): Json<PasswordChange>,
) -> Result<StatusCode, ApiError> {
    app.access.change_password(change, &actor).await?;
    Ok(StatusCode::NO_CONTENT)
}

fn signed(app: &App, signed_in: &SignedIn) -> Result<impl IntoResponse + use<>, ApiError> {
    let cookie = HeaderValue::from_str(&session_cookie(&signed_in.secret))
        .map_err(|error| ApiError::Internal(error.to_string()))?;
    Ok(([(header::SET_COOKIE, cookie)], Answer(view(app, Some(&signed_in.known())))))
}

fn view(app: &App, known: Option<&Known>) -> SessionView {
    let caller = known.and_then(caller);
    let state = match caller {
        Some(_) => SessionState::SignedIn,
        None if *app.access.is_set_up().borrow() => SessionState::SignedOut,
        None => SessionState::SetUp,
    };
    let fingerprint = app.tls.as_ref().map(Tls::fingerprint);
    SessionView { state, caller, fingerprint, moves_to: app.moves_to.clone() }
}

fn caller(known: &Known) -> Option<CallerView> {
    let Known { actor, csrf } = known;
    let (life, kind) = (actor.life(), actor.kind());
    let name = match kind {
        // As the audit names them, but for what the kind says already.
        ActorKind::Token | ActorKind::ViewLink => actor.name().split_once(':').map_or("", |(_, name)| name),
        ActorKind::Person | ActorKind::Local | ActorKind::Relay => actor.name(),
    };
    Some(CallerView {
        name: name.to_owned(),
        kind,
        role: actor.role()?,
        csrf: csrf.clone(),
        ends_at: life.map(|life| wall_clock::of(life.ends_in_any_case())),
        idle_minutes: life.and_then(|life| life.idle_minutes()),
    })
}
