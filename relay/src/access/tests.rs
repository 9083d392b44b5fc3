//! What a change does to those who act at that moment.

use std::net::{IpAddr, Ipv4Addr};
use std::time::Duration;

use axum::http::{HeaderMap, header};
use cipdeck_shared::api::{
    ActorKind, NewToken, NewUser, NewViewLink, PasswordChange, Role, SetUp, SignIn, UserChange,
};

use super::*;
use crate::actor::Actor;

const HERE: IpAddr = IpAddr::V4(Ipv4Addr::LOCALHOST);
const THERE: IpAddr = IpAddr::V4(Ipv4Addr::new(192, 0, 2, 1));
const PASSWORD: &str = "correct horse battery";

struct Relay {
    store: Store,
    audit: Audit,
    access: Access,
    admin: Actor,
}

impl Relay {
    /// With the administrator `root` and the engineer `anna`.
    async fn start() -> Self {
        let store = Store::open(None).await.unwrap();
        let audit = Audit::open(None).unwrap();
        let access = Access::open_cheaply(store.clone(), audit.clone(), None).await;
        let code = access.setup_code().unwrap();
        let admin = access.set_up(set_up(&code), HERE).await.unwrap().actor;
        let new = NewUser { name: "anna".to_owned(), role: Role::Engineer, password: PASSWORD.to_owned() };
        access.add_user(new, &admin).await.unwrap();
        Self { store, audit, access, admin }
    }

    async fn sign_in(&self, name: &str) -> SignedIn {
        self.access.sign_in(form(name, PASSWORD), HERE).await.unwrap()
    }

    async fn change(&self, name: &str, change: UserChange) -> Result<(), ApiError> {
        self.access.change_user(name, change, &self.admin).await.map(|_| ())
    }

    fn knows(&self, headers: &HeaderMap) -> Option<Actor> {
        self.access.known(headers, THERE).unwrap().map(|known| known.actor)
    }

    fn audit_text(&self) -> String {
        String::from_utf8(self.audit.memory().unwrap()).unwrap()
    }
}

fn set_up(code: &str) -> SetUp {
    SetUp { code: code.to_owned(), name: "root".to_owned(), password: PASSWORD.to_owned() }
}

fn form(name: &str, password: &str) -> SignIn {
    SignIn { name: name.to_owned(), password: password.to_owned() }
}

fn cookie(name: &str, secret: &str) -> HeaderMap {
    let mut headers = HeaderMap::new();
    headers.insert(header::COOKIE, format!("a=b; {name}={secret}").parse().unwrap());
    headers
}

fn session(secret: &str) -> HeaderMap {
    cookie("__Host-cipdeck", secret)
}

fn bearer(token: &str) -> HeaderMap {
    let mut headers = HeaderMap::new();
    headers.insert(header::AUTHORIZATION, format!("Bearer {token}").parse().unwrap());
    headers
}

#[tokio::test]
async fn the_code_makes_one_administrator() {
    let store = Store::open(None).await.unwrap();
    let access = Access::open_cheaply(store.clone(), Audit::open(None).unwrap(), None).await;
    let mut is_set_up = access.is_set_up();
    assert!(!*is_set_up.borrow_and_update());
    let code = access.setup_code().unwrap();
    assert_eq!(code.len(), 14, "{code}");
    let wrong = access.set_up(set_up("0000-0000-0000"), HERE).await;
    assert!(matches!(wrong, Err(ApiError::NotPermitted(_))));
    let waits = access.set_up(set_up(&code), HERE).await;
    assert!(matches!(waits, Err(ApiError::TooMany { .. })));
    tokio::time::pause();
    tokio::time::advance(Duration::from_secs(1)).await;
    tokio::time::resume();
    let typed = code.to_lowercase().replace('-', " ").replace('0', "o").replace('1', "l");
    let short = SetUp { password: "short".to_owned(), ..set_up(&typed) };
    assert!(matches!(access.set_up(short, HERE).await, Err(ApiError::Unreadable(_))));
    let signed_in = access.set_up(set_up(&typed), HERE).await.unwrap();
    assert_eq!((signed_in.actor.name(), signed_in.actor.role()), ("root", Some(Role::Admin)));
    is_set_up.changed().await.unwrap();
    assert!(*is_set_up.borrow());
    assert_eq!(access.setup_code(), None);
    assert!(matches!(access.set_up(set_up(&code), HERE).await, Err(ApiError::Conflict(_))));
    let again = Access::open_cheaply(store, Audit::open(None).unwrap(), None).await;
    assert_eq!(again.setup_code(), None, "there is an administrator in the database");
    again.sign_in(form("root", PASSWORD), HERE).await.unwrap();
}

#[tokio::test]
async fn only_the_right_password_of_an_enabled_user_signs_in() {
    let relay = Relay::start().await;
    let signed_in = relay.sign_in("anna").await;
    let known = relay.access.known(&session(&signed_in.secret), THERE).unwrap().unwrap();
    assert_eq!(
        (known.actor.name(), known.actor.kind(), known.actor.from()),
        ("anna", ActorKind::Person, "192.0.2.1")
    );
    assert_eq!(known.csrf, signed_in.known().csrf);
    assert!(known.actor.is_same(&signed_in.actor));
    let disabled = UserChange { disabled: Some(true), ..UserChange::default() };
    relay.change("anna", disabled).await.unwrap();
    let mut words = Vec::new();
    for (name, password) in [("anna", PASSWORD), ("root", "wrong"), ("nobody", PASSWORD), ("No Name!", "x")] {
        let Err(ApiError::SignedOut(why)) = relay.access.sign_in(form(name, password), HERE).await else {
            panic!("{name}")
        };
        words.push(why);
    }
    words.dedup();
    assert_eq!(words.len(), 1, "nobody learns what was wrong: {words:?}");
    let text = relay.audit_text();
    assert!(!text.contains("nobody") && !text.contains("No Name"), "it could be a password: {text}");
}

#[tokio::test]
async fn wrong_passwords_make_everybody_wait_but_who_was_here_before() {
    let relay = Relay::start().await;
    relay.sign_in("anna").await;
    let wrong = relay.access.sign_in(form("anna", "wrong"), THERE).await;
    assert!(matches!(wrong, Err(ApiError::SignedOut(_))));
    let Err(ApiError::TooMany { retry_after, .. }) =
        relay.access.sign_in(form("anna", PASSWORD), THERE).await
    else {
        panic!("right, but too early")
    };
    assert!(retry_after <= Duration::from_secs(1));
    relay.sign_in("anna").await;
}

#[tokio::test]
async fn a_session_ends_without_activity_and_in_any_case() {
    let relay = Relay::start().await;
    let (idle, active) = (relay.sign_in("anna").await, relay.sign_in("anna").await);
    tokio::time::pause();
    let minute = Duration::from_mins(1);
    for passed in 1..=14 {
        tokio::time::advance(minute).await;
        active.actor.touch();
        assert!(idle.actor.is_present(), "{passed} minutes");
    }
    // Looking is no activity.
    assert!(relay.knows(&session(&idle.secret)).is_some());
    tokio::time::advance(minute).await;
    assert!(relay.knows(&session(&idle.secret)).is_none(), "15 minutes");
    idle.actor.gone().await;
    for _ in 15..12 * 60 - 1 {
        active.actor.touch();
        tokio::time::advance(minute).await;
    }
    assert!(relay.knows(&session(&active.secret)).is_some(), "12 hours minus a minute");
    active.actor.touch();
    tokio::time::advance(minute).await;
    assert!(relay.knows(&session(&active.secret)).is_none(), "12 hours");
}

#[tokio::test]
async fn whoever_watches_with_an_ended_session_hears_so_within_a_second() {
    let relay = Relay::start().await;
    let signed_in = relay.sign_in("anna").await;
    tokio::time::pause();
    let begin = tokio::time::Instant::now();
    signed_in.actor.gone().await;
    let lasted = begin.elapsed();
    let idle = Duration::from_mins(15);
    assert!((idle..idle + Duration::from_secs(1)).contains(&lasted), "{lasted:?}");
    assert!(relay.audit_text().contains("session_ended"));
}

#[tokio::test]
async fn everything_that_takes_away_a_right_ends_sessions_or_changes_them_at_once() {
    let relay = Relay::start().await;
    let signed_in = relay.sign_in("anna").await;
    let role = |role| UserChange { role: Some(role), ..UserChange::default() };
    relay.change("anna", role(Role::Viewer)).await.unwrap();
    assert_eq!((signed_in.actor.role(), signed_in.actor.is_present()), (Some(Role::Viewer), true));
    for change in [
        UserChange { disabled: Some(true), ..UserChange::default() },
        UserChange { password: Some("another long password".to_owned()), ..UserChange::default() },
    ] {
        let back = UserChange {
            disabled: Some(false),
            password: Some(PASSWORD.to_owned()),
            ..UserChange::default()
        };
        relay.change("anna", back).await.unwrap();
        let signed_in = relay.sign_in("anna").await;
        assert!(relay.knows(&session(&signed_in.secret)).is_some());
        relay.change("anna", change).await.unwrap();
        assert!(!signed_in.actor.is_present());
        assert!(relay.knows(&session(&signed_in.secret)).is_none());
    }
    let back = UserChange { password: Some(PASSWORD.to_owned()), ..role(Role::Engineer) };
    relay.change("anna", back).await.unwrap();
    let signed_in = relay.sign_in("anna").await;
    let id = relay.access.sessions().iter().find(|entry| entry.name == "anna").unwrap().id;
    relay.access.end_session(id, &relay.admin).unwrap();
    assert!(!signed_in.actor.is_present() && relay.knows(&session(&signed_in.secret)).is_none());
    assert!(relay.access.end_session(id, &relay.admin).is_err());
    let signed_in = relay.sign_in("anna").await;
    relay.access.sign_out(&signed_in.actor);
    assert!(!signed_in.actor.is_present());
    let signed_in = relay.sign_in("anna").await;
    relay.access.remove_user("anna", &relay.admin).await.unwrap();
    assert_eq!((signed_in.actor.role(), signed_in.actor.is_present()), (None, false));
    let text = relay.audit_text();
    for event in ["user_changed", "password_changed", "session_ended", "sign_out", "user_deleted"] {
        assert!(text.contains(event), "{event}");
    }
}

#[tokio::test]
async fn ones_own_password_takes_the_old_one_and_ends_the_other_sessions() {
    let relay = Relay::start().await;
    let (one, other) = (relay.sign_in("anna").await, relay.sign_in("anna").await);
    let change = |old: &str, new: &str| PasswordChange { old: old.to_owned(), new: new.to_owned() };
    let refused = relay.access.change_password(change("wrong", "another long password"), &one.actor).await;
    assert!(matches!(refused, Err(ApiError::NotPermitted(_))));
    let waits = relay.access.change_password(change(PASSWORD, "another long password"), &one.actor).await;
    assert!(matches!(waits, Err(ApiError::TooMany { .. })), "a session is no way round the wait");
    tokio::time::pause();
    tokio::time::advance(Duration::from_secs(1)).await;
    tokio::time::resume();
    relay.access.change_password(change(PASSWORD, "another long password"), &one.actor).await.unwrap();
    assert!(one.actor.is_present() && !other.actor.is_present());
    let local = Actor::local(Role::Engineer, "127.0.0.1");
    assert!(relay.access.change_password(change("", "another long password"), &local).await.is_err());
    relay.access.sign_in(form("anna", "another long password"), HERE).await.unwrap();
}

#[tokio::test]
async fn the_last_administrator_stays() {
    let relay = Relay::start().await;
    for change in [
        UserChange { role: Some(Role::Engineer), ..UserChange::default() },
        UserChange { disabled: Some(true), ..UserChange::default() },
    ] {
        assert!(matches!(relay.change("root", change).await, Err(ApiError::Conflict(_))));
    }
    assert!(matches!(relay.access.remove_user("root", &relay.admin).await, Err(ApiError::Conflict(_))));
    let role = UserChange { role: Some(Role::Admin), ..UserChange::default() };
    relay.change("anna", role).await.unwrap();
    relay.access.remove_user("root", &relay.admin).await.unwrap();
    assert!(matches!(relay.access.remove_user("anna", &relay.admin).await, Err(ApiError::Conflict(_))));
}

#[tokio::test]
async fn a_user_has_at_most_16_sessions_and_the_oldest_ends() {
    let relay = Relay::start().await;
    let mut sessions = Vec::new();
    for _ in 0..17 {
        sessions.push(relay.sign_in("anna").await);
    }
    let present: Vec<_> = sessions.iter().map(|session| session.actor.is_present()).collect();
    assert_eq!(present, [vec![false], vec![true; 16]].concat());
    let anna = relay.access.users().into_iter().find(|user| user.name == "anna").unwrap();
    assert_eq!(anna.sessions, 16);
    assert!(relay.admin.is_present());
}

#[tokio::test]
async fn names_are_checked_and_taken_once() {
    let relay = Relay::start().await;
    let add = async |name: &str| {
        let new = NewUser { name: name.to_owned(), role: Role::Viewer, password: PASSWORD.to_owned() };
        relay.access.add_user(new, &relay.admin).await
    };
    for name in ["", "Anna", "an na", "token:x", "ä", &"x".repeat(65)] {
        assert!(matches!(add(name).await, Err(ApiError::Unreadable(_))), "{name}");
    }
    assert!(matches!(add("anna").await, Err(ApiError::Conflict(_))));
    add("a.b_c-9").await.unwrap();
}

#[tokio::test]
async fn a_token_acts_with_its_role_and_scope_until_it_ends() {
    let relay = Relay::start().await;
    let new = |name: &str, days| NewToken {
        name: name.to_owned(),
        role: Role::Operator,
        scope: vec![" 192.168.1.0/24 ".to_owned()],
        days,
    };
    let made = relay.access.make_token(new("nightly", 1), &relay.admin).await.unwrap();
    assert!(made.secret.starts_with("cdt_1_"), "{}", made.secret);
    let actor = relay.knows(&bearer(&made.secret)).unwrap();
    assert_eq!(
        (actor.name(), actor.kind(), actor.role()),
        ("token:nightly", ActorKind::Token, Some(Role::Operator))
    );
    assert_eq!(actor.scope(), ["192.168.1.0/24".parse().unwrap()]);
    assert!(relay.access.passes(PassKind::Token)[0].last_used.is_some());
    // Only whole, only its own, only as a token.
    let secret = made.secret.rsplit_once('_').unwrap().1;
    for wrong in [&made.secret[..69], &format!("cdt_2_{secret}"), secret, "cdt_1_", "", "x"] {
        let refused = relay.access.known(&bearer(wrong), "192.0.2.77".parse().unwrap());
        assert!(matches!(refused, Err(ApiError::SignedOut(_) | ApiError::TooMany { .. })), "{wrong}");
    }
    assert!(
        relay.knows(&session(secret)).is_none()
            && relay.knows(&cookie("__Host-cipdeck-view", secret)).is_none()
    );
    assert!(matches!(
        relay.access.make_token(new("nightly", 1), &relay.admin).await,
        Err(ApiError::Conflict(_))
    ));
    // It outlives the relay.
    let again = Access::open_cheaply(relay.store.clone(), relay.audit.clone(), None).await;
    let later = again.known(&bearer(&made.secret), THERE).unwrap().unwrap().actor;
    assert_eq!((later.role(), later.scope().len()), (Some(Role::Operator), 1));
    relay.access.revoke(PassKind::Token, 1, &relay.admin).await.unwrap();
    assert_eq!((actor.role(), actor.is_present()), (None, false));
    assert!(relay.access.known(&bearer(&made.secret), THERE).is_err());
    assert!(relay.access.revoke(PassKind::Token, 1, &relay.admin).await.is_err());
    let made = relay.access.make_token(new("nightly", 1), &relay.admin).await.unwrap();
    let actor = relay.knows(&bearer(&made.secret)).unwrap();
    tokio::time::pause();
    tokio::time::advance(Duration::from_secs(86_399)).await;
    assert!(actor.is_present());
    actor.gone().await;
    assert!(relay.access.known(&bearer(&made.secret), THERE).is_err());
}

#[tokio::test]
async fn a_token_that_makes_no_sense_is_not_made() {
    let relay = Relay::start().await;
    let good = NewToken { name: "x".to_owned(), role: Role::Viewer, scope: Vec::new(), days: 366 };
    for new in [
        NewToken { name: " ".to_owned(), ..good.clone() },
        NewToken { name: "x".repeat(65), ..good.clone() },
        NewToken { name: "a\nb".to_owned(), ..good.clone() },
        NewToken { role: Role::Admin, ..good.clone() },
        NewToken { scope: vec!["everywhere!".to_owned()], ..good.clone() },
        NewToken { scope: vec!["192.168.1.1\n10.0.0.0/8".to_owned()], ..good.clone() },
        NewToken { days: 0, ..good.clone() },
        NewToken { days: 367, ..good.clone() },
    ] {
        let refused = relay.access.make_token(new.clone(), &relay.admin).await;
        assert!(matches!(refused, Err(ApiError::Unreadable(_))), "{new:?}");
    }
    relay.access.make_token(good, &relay.admin).await.unwrap();
}

#[tokio::test]
async fn a_view_link_looks_until_it_is_revoked_and_outlives_a_restart() {
    let relay = Relay::start().await;
    let new = NewViewLink { name: "hall 3".to_owned(), hours: 24 };
    let made = relay.access.make_link(new, &relay.admin).await.unwrap();
    let lasts = relay.access.open_link(&made.secret, THERE).unwrap();
    assert!((86_390..=86_400).contains(&lasts.as_secs()), "{lasts:?}");
    let tablet = cookie("__Host-cipdeck-view", &made.secret);
    let actor = relay.knows(&tablet).unwrap();
    assert_eq!(
        (actor.name(), actor.kind(), actor.role()),
        ("view:hall 3", ActorKind::ViewLink, Some(Role::Viewer))
    );
    assert_eq!(actor.life().unwrap().idle_minutes(), None, "nobody touches a tablet on the wall");
    assert!(
        relay.knows(&session(&made.secret)).is_none()
            && relay.access.known(&bearer(&made.secret), THERE).is_err()
    );
    // Whoever has signed in on the tablet is that person.
    let anna = relay.sign_in("anna").await;
    let mut both = tablet.clone();
    both.append(header::COOKIE, format!("__Host-cipdeck={}", anna.secret).parse().unwrap());
    assert_eq!(relay.knows(&both).unwrap().name(), "anna");
    let again = Access::open_cheaply(relay.store.clone(), relay.audit.clone(), None).await;
    assert!(again.known(&tablet, THERE).unwrap().is_some());
    relay.access.revoke(PassKind::ViewLink, made.view.id, &relay.admin).await.unwrap();
    assert!(!actor.is_present() && relay.knows(&tablet).is_none());
    assert!(matches!(relay.access.open_link(&made.secret, HERE), Err(ApiError::SignedOut(_))));
}

#[tokio::test]
async fn local_access_is_for_this_machine_and_for_nobody_who_shows_something() {
    let access = Access::open_cheaply(
        Store::open(None).await.unwrap(),
        Audit::open(None).unwrap(),
        Some(Role::Engineer),
    )
    .await;
    let host = |host: &str| HeaderMap::from_iter([(header::HOST, host.parse().unwrap())]);
    let nothing = host("127.0.0.1:8818");
    let known = access.known(&nothing, HERE).unwrap().unwrap();
    assert_eq!((known.actor.kind(), known.actor.role()), (ActorKind::Local, Some(Role::Engineer)));
    assert!(access.known(&nothing, "::ffff:127.0.0.1".parse().unwrap()).unwrap().is_some());
    assert!(access.known(&nothing, THERE).unwrap().is_none());
    assert!(access.known(&bearer("cdt_1_x"), HERE).is_err(), "a wrong token is not made better");
    let mut left_over = session("left over");
    left_over.insert(header::HOST, "localhost:8818".parse().unwrap());
    assert!(access.known(&left_over, HERE).unwrap().is_some(), "cookies know no ports");
    // A tunnel that ends at this machine calls from loopback.
    for local in ["localhost", "LOCALHOST:80", "[::1]:8818", "[::1]", "127.0.0.1"] {
        assert!(access.known(&host(local), HERE).unwrap().is_some(), "{local}");
    }
    for elsewhere in ["deck.example.net", "localhost.example.net:8818", "192.0.2.17:8818", ""] {
        assert!(access.known(&host(elsewhere), HERE).unwrap().is_none(), "{elsewhere}");
    }
    for added in ["x-forwarded-for", "forwarded", "via"] {
        let mut headers = nothing.clone();
        headers.insert(added, "192.0.2.1".parse().unwrap());
        assert!(access.known(&headers, HERE).unwrap().is_none(), "{added}");
    }
}

#[tokio::test]
async fn nothing_that_opens_is_in_the_database_or_the_audit() {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("cipdeck.sqlite");
    let (store, audit) = (Store::open(Some(&path)).await.unwrap(), Audit::open(Some(folder.path())).unwrap());
    let access = Access::open_cheaply(store.clone(), audit, None).await;
    let code = access.setup_code().unwrap();
    let admin = access.set_up(set_up(&code), HERE).await.unwrap();
    let token = NewToken { name: "t".to_owned(), role: Role::Viewer, scope: Vec::new(), days: 1 };
    let token = access.make_token(token, &admin.actor).await.unwrap();
    let link = access.make_link(NewViewLink { name: "l".to_owned(), hours: 1 }, &admin.actor).await.unwrap();
    access.open_link(&link.secret, HERE).unwrap();
    store.close().await;
    drop(access);
    let csrf = admin.known().csrf.unwrap();
    let token_secret = token.secret.rsplit_once('_').unwrap().1;
    let secrets =
        [PASSWORD, &code, &code.replace('-', ""), &admin.secret, &csrf, token_secret, link.secret.as_str()];
    for file in std::fs::read_dir(folder.path()).unwrap() {
        let path = file.unwrap().path();
        let bytes = std::fs::read(&path).unwrap();
        for secret in secrets {
            let is_there = bytes.windows(secret.len()).any(|window| window == secret.as_bytes());
            assert!(!is_there, "{secret} is in {}", path.display());
        }
    }
}

/// Reproducible noise.
struct Noise(u64);

impl Noise {
    fn next(&mut self, below: usize) -> usize {
        // xorshift64*
        self.0 ^= self.0 >> 12;
        self.0 ^= self.0 << 25;
        self.0 ^= self.0 >> 27;
        let number = self.0.wrapping_mul(0x2545_F491_4F6C_DD1D) >> 33;
        usize::try_from(number).unwrap() % below
    }

    /// A text that differs from this one in one place, or in its length.
    fn change(&mut self, text: &str) -> String {
        let mut bytes = text.as_bytes().to_vec();
        let at = self.next(bytes.len());
        match self.next(4) {
            0 => bytes.truncate(at),
            1 => bytes.insert(at, b'a'),
            2 => drop(bytes.remove(at)),
            _ => bytes[at] = if bytes[at] == b'7' { b'1' } else { b'7' },
        }
        String::from_utf8(bytes).unwrap()
    }

    fn bytes(&mut self) -> Vec<u8> {
        (0..self.next(64)).map(|_| u8::try_from(self.next(256)).unwrap()).collect()
    }
}

#[tokio::test]
async fn half_a_million_random_log_ins_open_nothing() {
    let relay = Relay::start().await;
    let anna = relay.sign_in("anna").await;
    let new = NewToken { name: "t".to_owned(), role: Role::Viewer, scope: Vec::new(), days: 1 };
    let token = relay.access.make_token(new, &relay.admin).await.unwrap().secret;
    let link = NewViewLink { name: "l".to_owned(), hours: 1 };
    let link = relay.access.make_link(link, &relay.admin).await.unwrap().secret;
    let mut noise = Noise(20_261_122);
    let mut tried = 0;
    for number in 0..500_000_u32 {
        // From many places at once.
        let from = IpAddr::from((0xC000_0200 + number % 200).to_be_bytes());
        let headers = match number % 6 {
            0 => bearer(&noise.change(&token)),
            1 => session(&noise.change(&anna.secret)),
            2 => cookie("__Host-cipdeck-view", &noise.change(&link)),
            3 => {
                let mut headers = HeaderMap::new();
                for name in [header::AUTHORIZATION, header::COOKIE] {
                    if let Ok(value) = header::HeaderValue::from_bytes(&noise.bytes()) {
                        headers.insert(name, value);
                    }
                }
                headers
            }
            4 => {
                assert!(serde_json::from_slice::<SignIn>(&noise.bytes()).is_err());
                continue;
            }
            _ => {
                let name = if noise.next(2) == 0 { "anna".to_owned() } else { noise.change("anna") };
                let password = noise.change(PASSWORD);
                match relay.access.sign_in(form(&name, &password), from).await {
                    Err(ApiError::SignedOut(_)) => tried += 1,
                    Err(ApiError::TooMany { .. }) => {}
                    other => panic!("{name} {password}: {:?}", other.map(|signed_in| signed_in.actor)),
                }
                continue;
            }
        };
        let known = relay.access.known(&headers, from);
        assert!(!matches!(known, Ok(Some(_))), "{headers:?}");
        assert!(relay.access.open_link(&noise.change(&link), from).is_err());
    }
    assert!(tried < 5_000, "the others had to wait: {tried}");
    // Who was here before goes on, with what is right.
    relay.sign_in("anna").await;
    assert!(relay.knows(&session(&anna.secret)).is_some() && relay.knows(&bearer(&token)).is_some());
    let records = relay.audit_text().lines().count();
    assert!(records < 10_000, "nobody fills the disk with wrong attempts: {records}");
}
