use std::sync::Arc;
use std::time::Duration;

use cipdeck_shared::api::{NewAllowedTarget, NewAllowedWrite};
use cipdeck_shared::config::{BlockId, MsgCipGeneric, Profile, Target};
use cipdeck_shared::plan::MessagePlan;
use tokio::time::{Instant, advance};

use super::*;
use crate::actor::{Actor, Life, Limits, Standing};
use crate::audit::Audit;

const DEVICE: &str = "4,10.0.0.1";
const BLOCK: BlockId = BlockId(1);

fn policy(targets: &[&str]) -> Policy {
    let policy = Policy::new(None, Audit::open(None).unwrap(), 0);
    for target in targets {
        policy.lists.add_target(None, &allowed(target)).unwrap();
    }
    policy
}

fn allowed(target: &str) -> NewAllowedTarget {
    NewAllowedTarget { target: (*target).to_owned(), note: String::new() }
}

fn config(path: &str, service: i64) -> MsgCipGeneric {
    let mut config = MsgCipGeneric::product_name(path);
    let app = &mut config.app_cfg;
    (app.service, app.class, app.instance, app.attribute) = (service, 4, 150, 3);
    config
}

fn sending(config: &MsgCipGeneric) -> Sending {
    let (plan, findings) = MessagePlan::parse(config);
    Sending::from(&plan.unwrap_or_else(|| panic!("{findings:?}")))
}

fn read(path: &str) -> Sending {
    sending(&config(path, 0x0E))
}

fn write(path: &str) -> Sending {
    let mut config = config(path, 0x10);
    config.req_data = "01".to_owned();
    sending(&config)
}

struct Person {
    actor: Actor,
    standing: Arc<Standing>,
    life: Arc<Life>,
}

fn person(role: Role) -> Person {
    let limits = Limits { idle: None, absolute: Duration::from_hours(12) };
    let (standing, life) = (Arc::new(Standing::new(Some(role))), Arc::new(Life::begin(1, limits)));
    let actor =
        Actor::in_session("anna", ActorKind::Person, "10.0.0.9", Arc::clone(&standing), Arc::clone(&life));
    Person { actor, standing, life }
}

/// Asks at the command.
fn ask(
    policy: &Policy,
    actor: &Actor,
    sending: &Sending,
    confirmed: Option<&Confirmed>,
) -> Result<(), Denied> {
    ask_shot(policy, actor, sending, confirmed, (None, None))
}

fn ask_shot(
    policy: &Policy,
    actor: &Actor,
    sending: &Sending,
    confirmed: Option<&Confirmed>,
    (shot, earlier): (Option<u64>, Option<u64>),
) -> Result<(), Denied> {
    let repeats = sending.is_cyclic;
    let (sending, now) = (Some(sending), Instant::now());
    permit(policy, &Question { sending, revision: 1, actor, confirmed, shot, earlier, repeats, now })
}

#[tokio::test]
async fn nothing_is_reached_that_is_not_on_the_list() {
    let engineer = person(Role::Engineer).actor;
    let empty = policy(&[]);
    assert!(matches!(ask(&empty, &engineer, &read(DEVICE), None), Err(Denied::Target(_))));
    assert_eq!(ask(&empty, &engineer, &read("0,0"), None), Ok(()), "the built-in device is no target");
    let policy = policy(&["10.0.0.1", "10.0.0.2 via 1,0"]);
    for (path, is_allowed) in [
        ("4,10.0.0.1", true),
        ("4,10.0.0.1:2222", false),
        ("4,10.0.0.1,1,0", false),
        ("4,10.0.0.2,1,0", true),
        ("4,10.0.0.2,1,1", false),
        ("4,10.0.0.2", false),
        ("4,10.0.0.3", false),
        ("4,device", false),
    ] {
        assert_eq!(ask(&policy, &engineer, &read(path), None).is_ok(), is_allowed, "{path}");
    }
}

#[tokio::test]
async fn a_route_inside_of_a_request_is_a_route() {
    let engineer = person(Role::Engineer).actor;
    // Unconnected_Send as the user's own service: Identity of slot 3, and the route 1,3 behind it.
    let mut config = config(DEVICE, 0x52);
    (config.app_cfg.class, config.app_cfg.instance, config.app_cfg.attribute) = (6, 1, 0);
    config.req_data = "05 9d 08 00 0e 03 20 01 24 01 30 07 01 00 01 03".to_owned();
    let sending = sending(&config);
    assert_eq!(sending.access, cipdeck_shared::table::Access::Read, "{:?}", sending.effects);
    assert!(matches!(ask(&policy(&["10.0.0.1"]), &engineer, &sending, None), Err(Denied::Target(_))));
    let both = policy(&["10.0.0.1", "10.0.0.1 via 1,3"]);
    assert_eq!(ask(&both, &engineer, &sending, None), Ok(()));
}

/// The operators' list is about the device that it names, not about what can be reached through it.
#[tokio::test]
async fn a_listed_write_is_not_listed_behind_another_route() {
    let policy = policy(&["10.0.0.1 via *"]);
    policy.lists.add_write(None, &set_150("10.0.0.1")).unwrap();
    let mut packet = config(DEVICE, 0x0A);
    (packet.app_cfg.class, packet.app_cfg.instance, packet.app_cfg.attribute) = (2, 1, 0);
    let write = "10 03 20 04 24 96 30 03 01";
    packet.req_data = format!("01 00 04 00 {write}");
    policy.open_window(&person(Role::Engineer).actor, None).unwrap();
    let confirmed = policy.hypothetical(1);
    let operator = person(Role::Operator).actor;
    assert_eq!(ask(&policy, &operator, &sending(&packet), confirmed.as_ref()), Ok(()));
    packet.req_data = format!("01 00 04 00 52 02 20 06 24 01 05 9d 09 00 {write} 00 01 00 01 03");
    let wrapped = sending(&packet);
    assert_eq!(wrapped.access, cipdeck_shared::table::Access::Write, "{:?}", wrapped.effects);
    let answer = ask(&policy, &operator, &wrapped, confirmed.as_ref());
    assert!(matches!(answer, Err(Denied::NotOnList(_))), "{answer:?}");
}

fn set_150(target: &str) -> NewAllowedWrite {
    NewAllowedWrite {
        target: target.to_owned(),
        service: 0x10,
        class: 4,
        instance: Some(150),
        attribute: None,
        note: String::new(),
    }
}

#[tokio::test]
async fn the_relay_s_own_machine_and_other_special_addresses_have_to_be_named() {
    let engineer = person(Role::Engineer).actor;
    let everything = policy(&["0.0.0.0/0:* via *", "127.0.0.0/8:*"]);
    for path in
        ["4,127.0.0.1", "4,127.1.2.3", "4,169.254.169.254", "4,224.0.0.1", "4,255.255.255.255", "4,0.0.0.0"]
    {
        let answer = ask(&everything, &engineer, &read(path), None);
        assert!(matches!(answer, Err(Denied::Special(..))), "{path}: {answer:?}");
    }
    assert_eq!(ask(&everything, &engineer, &read("4,192.168.1.1"), None), Ok(()));
    let named = policy(&["127.0.0.1:*"]);
    assert_eq!(ask(&named, &engineer, &read("4,127.0.0.1:2222"), None), Ok(()));
    named.lists.listens_on("127.0.0.1:8818".parse().unwrap());
    let own = read("4,127.0.0.1:8818");
    assert!(matches!(ask(&named, &engineer, &own, None), Err(Denied::Special(_, "the relay itself"))));
    named.lists.add_target(None, &allowed("127.0.0.1:8818")).unwrap();
    assert_eq!(ask(&named, &engineer, &own, None), Ok(()), "named with its very port");
}

#[tokio::test]
async fn a_name_stands_for_the_addresses_that_it_had_first_and_never_for_this_machine() {
    let lists = policy(&["plc.local"]).lists;
    let ip = |text: &str| text.parse().unwrap();
    assert!(matches!(lists.pin("plc.local", 44_818, vec![ip("127.0.0.1")]), Err(Denied::Special(..))));
    assert!(matches!(lists.pin("plc.local", 44_818, vec![ip("::ffff:127.0.0.1")]), Err(Denied::Special(..))));
    let mixed = vec![ip("169.254.1.1"), ip("10.0.0.7")];
    assert_eq!(lists.pin("PLC.local", 44_818, mixed).unwrap(), [ip("10.0.0.7")]);
    // Whoever answers for the name now, says something else.
    assert_eq!(lists.pin("plc.local", 44_818, vec![ip("10.0.0.8")]).unwrap(), [ip("10.0.0.7")]);
    assert_eq!(lists.pinned("plc.LOCAL"), Some(vec![ip("10.0.0.7")]));
    lists.add_target(None, &allowed("10.0.0.9")).unwrap();
    assert_eq!(lists.pinned("plc.local"), None, "a changed list is a reason to look again");
}

#[tokio::test]
async fn what_a_name_stands_for_at_one_port_may_be_the_relay_at_another() {
    let lists = policy(&["plc.local:*"]).lists;
    lists.listens_on("10.0.0.5:8818".parse().unwrap());
    let both = || vec!["10.0.0.5".parse().unwrap(), "10.0.0.7".parse().unwrap()];
    assert_eq!(lists.pin("plc.local", 44_818, both()).unwrap(), both());
    assert_eq!(lists.pin("plc.local", 8_818, both()).unwrap(), both()[1..]);
}

/// A block says itself what kind of device it is for: the way that is left out then is not the one that was allowed.
#[tokio::test]
async fn the_kind_of_device_is_no_way_to_another_one() {
    let engineer = person(Role::Engineer).actor;
    let mut config = config("4,10.0.0.1,1,0", 0x0E);
    let behind = policy(&["10.0.0.1 via 1,0"]);
    let directly = policy(&["10.0.0.1"]);
    for profile in [Profile::Auto, Profile::Generic, Profile::Logix, Profile::Omron] {
        config.profile = profile;
        assert_eq!(ask(&behind, &engineer, &sending(&config), None), Ok(()), "{profile:?}");
    }
    config.profile = Profile::Micro800;
    let answer = ask(&behind, &engineer, &sending(&config), None);
    assert!(matches!(answer, Err(Denied::Target(_))), "it is sent to the first device itself: {answer:?}");
    assert_eq!(ask(&directly, &engineer, &sending(&config), None), Ok(()));
}

/// A list can say what may be written, not what may be hidden.
#[tokio::test]
async fn a_listed_service_that_carries_others_allows_none_of_them() {
    let policy = policy(&["10.0.0.1 via *"]);
    for (service, class) in [(0x52, 6), (0x0A, 2)] {
        let rule =
            NewAllowedWrite { service, class, instance: None, attribute: None, ..set_150("10.0.0.1 via *") };
        policy.lists.add_write(None, &rule).unwrap();
    }
    policy.open_window(&person(Role::Engineer).actor, None).unwrap();
    let confirmed = policy.hypothetical(1);
    let operator = person(Role::Operator).actor;
    // What cannot be read: a route with an object behind it, an offset that goes back.
    for (service, class, data) in [
        (0x52, 6, "01 fa 0a 00 10 03 20 04 24 64 30 03 01 00 02 00 01 00 24 00"),
        (0x0A, 2, "02 00 06 00 06 00 10 03 20 04 24 64 30 03 01 00"),
    ] {
        let mut config = config(DEVICE, service);
        (config.app_cfg.class, config.app_cfg.instance, config.app_cfg.attribute) = (class, 1, 0);
        config.req_data = data.to_owned();
        let answer = ask(&policy, &operator, &sending(&config), confirmed.as_ref());
        assert!(matches!(answer, Err(Denied::NotOnList(_))), "{service:#x}: {answer:?}");
    }
}

#[tokio::test]
async fn roles_send_what_they_may() {
    let policy = policy(&["10.0.0.1"]);
    let listed = set_150("10.0.0.1");
    let window = person(Role::Engineer);
    policy.open_window(&window.actor, None).unwrap();
    let confirmed = policy.hypothetical(1);
    let answer = |role, sending: &Sending| ask(&policy, &person(role).actor, sending, confirmed.as_ref());
    for role in [Role::Operator, Role::Engineer, Role::Admin] {
        assert_eq!(answer(role, &read(DEVICE)), Ok(()), "{role:?}");
    }
    assert_eq!(answer(Role::Viewer, &read(DEVICE)), Err(Denied::OnlyLooks));
    assert_eq!(answer(Role::Viewer, &write(DEVICE)), Err(Denied::OnlyLooks));
    assert_eq!(answer(Role::Admin, &write(DEVICE)), Err(Denied::NeverWrites(Role::Admin)));
    assert_eq!(answer(Role::Engineer, &write(DEVICE)), Ok(()));
    assert!(matches!(answer(Role::Operator, &write(DEVICE)), Err(Denied::NotOnList(_))));
    policy.lists.add_write(None, &listed).unwrap();
    assert_eq!(answer(Role::Operator, &write(DEVICE)), Ok(()));
    let mut other = config(DEVICE, 0x10);
    (other.app_cfg.instance, other.req_data) = (151, "01".to_owned());
    assert!(matches!(answer(Role::Operator, &sending(&other)), Err(Denied::NotOnList(_))));
    let vendor = sending(&config(DEVICE, 0x4B));
    assert!(matches!(answer(Role::Operator, &vendor), Err(Denied::NotOnList(_))), "unknown is a write");
    assert_eq!(answer(Role::Engineer, &vendor), Ok(()));
}

#[tokio::test]
async fn a_block_that_resumes_never_writes() {
    let policy = policy(&["10.0.0.1"]);
    policy.open_window(&person(Role::Engineer).actor, None).unwrap();
    assert_eq!(ask(&policy, &Actor::relay(), &read(DEVICE), None), Ok(()));
    let confirmed = policy.hypothetical(1);
    let answer = ask(&policy, &Actor::relay(), &write(DEVICE), confirmed.as_ref());
    assert!(matches!(answer, Err(Denied::NeverWrites(_))), "{answer:?}");
}

#[tokio::test]
async fn a_token_is_limited_to_its_scope_and_ends_with_itself() {
    let policy = policy(&["10.0.0.0/24"]);
    let limits = Limits { idle: None, absolute: Duration::from_mins(1) };
    let (standing, life) = (Arc::new(Standing::new(Some(Role::Operator))), Arc::new(Life::begin(1, limits)));
    let scope = vec!["10.0.0.1".parse().unwrap()];
    let token = Actor::with_token("nightly", "", standing, Arc::clone(&life), scope);
    assert_eq!(ask(&policy, &token, &read(DEVICE), None), Ok(()));
    assert_eq!(ask(&policy, &token, &read("4,10.0.0.2"), None), Err(Denied::OutOfScope));
    assert!(matches!(policy.open_window(&token, None), Err(OpenError::Window(NotOpened::NotAllowed))));
    life.end();
    assert_eq!(ask(&policy, &token, &read(DEVICE), None), Err(Denied::Gone), "even for a read");
}

#[tokio::test(start_paused = true)]
async fn a_write_needs_an_open_window_and_the_revision_that_was_seen() {
    let policy = policy(&["10.0.0.1"]);
    let owner = person(Role::Engineer);
    let engineer = person(Role::Engineer).actor;
    let write = write(DEVICE);
    assert_eq!(ask(&policy, &engineer, &write, None), Err(Denied::NoWindow));
    policy.open_window(&owner.actor, Some(10)).unwrap();
    assert!(matches!(policy.open_window(&engineer, None), Err(OpenError::Window(NotOpened::AlreadyOpen(_)))));
    assert_eq!(ask(&policy, &engineer, &write, None), Err(Denied::NotConfirmed));
    let other = policy.hypothetical(2);
    let answer = ask(&policy, &engineer, &write, other.as_ref());
    assert_eq!(answer, Err(Denied::Changed { confirmed: 2, current: 1 }));
    let confirmed = policy.hypothetical(1);
    assert_eq!(ask(&policy, &engineer, &write, confirmed.as_ref()), Ok(()));
    // Closed and opened again: what was confirmed in one window does not hold in the next.
    policy.close_window(&engineer);
    assert_eq!(ask(&policy, &engineer, &write, confirmed.as_ref()), Err(Denied::NoWindow));
    policy.open_window(&owner.actor, Some(10)).unwrap();
    assert_eq!(ask(&policy, &engineer, &write, confirmed.as_ref()), Err(Denied::OtherWindow));
    let confirmed = policy.hypothetical(1);
    advance(Duration::from_mins(10)).await;
    assert_eq!(
        ask(&policy, &engineer, &write, confirmed.as_ref()),
        Err(Denied::NoWindow),
        "its time is over"
    );
}

#[tokio::test]
async fn the_window_ends_with_its_owner() {
    for end in [|owner: &Person| owner.life.end(), |owner: &Person| owner.standing.set(Some(Role::Viewer))] {
        let policy = policy(&["10.0.0.1"]);
        let owner = person(Role::Engineer);
        policy.open_window(&owner.actor, None).unwrap();
        let confirmed = policy.hypothetical(1);
        let engineer = person(Role::Engineer).actor;
        assert_eq!(ask(&policy, &engineer, &write(DEVICE), confirmed.as_ref()), Ok(()));
        end(&owner);
        assert_eq!(ask(&policy, &engineer, &write(DEVICE), confirmed.as_ref()), Err(Denied::NoWindow));
        assert_eq!(policy.write_state().window, None);
    }
}

#[tokio::test]
async fn whoever_lost_the_right_writes_no_more_while_their_reads_go_on() {
    let policy = policy(&["10.0.0.1"]);
    let window = person(Role::Engineer);
    policy.open_window(&window.actor, None).unwrap();
    let confirmed = policy.hypothetical(1);
    let gone = person(Role::Engineer);
    gone.life.end();
    let shot = (Some(5), Some(4));
    let mut cyclic = config(DEVICE, 0x10);
    (cyclic.req_data, cyclic.ctrl_cfg.trigger_type) = ("01".to_owned(), 100);
    let answer = ask_shot(&policy, &gone.actor, &sending(&cyclic), confirmed.as_ref(), shot);
    assert_eq!(answer, Err(Denied::Gone));
    assert_eq!(ask_shot(&policy, &gone.actor, &read(DEVICE), None, shot), Ok(()));
    gone.standing.set(Some(Role::Viewer));
    assert_eq!(ask_shot(&policy, &gone.actor, &read(DEVICE), None, shot), Err(Denied::OnlyLooks));
    gone.standing.set(None);
    assert_eq!(ask_shot(&policy, &gone.actor, &read(DEVICE), None, shot), Err(Denied::Gone));
}

#[tokio::test(start_paused = true)]
async fn a_write_is_never_late_and_never_twice() {
    let policy = policy(&["10.0.0.1"]);
    let engineer = person(Role::Engineer).actor;
    policy.open_window(&engineer, None).unwrap();
    let confirmed = policy.hypothetical(1);
    let ask = |shot| ask_shot(&policy, &engineer, &write(DEVICE), confirmed.as_ref(), shot);
    assert_eq!(ask((Some(7), None)), Ok(()));
    assert_eq!(ask((Some(7), Some(7))), Ok(()), "the same message, whose session was lost");
    assert_eq!(ask((Some(8), Some(7))), Err(Denied::Twice));
    advance(GOOD_FOR).await;
    assert_eq!(ask((Some(7), None)), Err(Denied::Late));
    assert_eq!(ask((Some(7), Some(7))), Err(Denied::Late), "also on another connection");
}

#[tokio::test(start_paused = true)]
async fn a_ticket_is_good_once_for_one_person_one_block_and_not_for_long() {
    let policy = policy(&["10.0.0.1"]);
    let engineer = person(Role::Engineer).actor;
    let offer = Offer { revision: 3, request: Arc::from([0x10]), old: None, new: None };
    let give = || policy.offer(&engineer, BLOCK, &offer, None).map(|offered| offered.ticket);
    assert_eq!(give().unwrap_err(), Denied::NoWindow);
    policy.open_window(&engineer, None).unwrap();
    let ticket = give().unwrap();
    let stranger = Actor::local(Role::Engineer, "");
    let redeem =
        |ticket: &str, actor: &Actor, block| policy.redeem(ticket, actor, block).map(|it| it.revision);
    assert_eq!(redeem(&ticket, &stranger, BLOCK), Err(Denied::NoTicket));
    assert_eq!(redeem(&ticket, &engineer, BlockId(2)), Err(Denied::NoTicket));
    assert_eq!(redeem(&ticket[1..], &engineer, BLOCK), Err(Denied::NoTicket));
    assert_eq!(redeem(&ticket, &engineer, BLOCK), Ok(3));
    assert_eq!(redeem(&ticket, &engineer, BLOCK), Err(Denied::Used));
    let late = give().unwrap();
    advance(GOOD_FOR).await;
    assert_eq!(redeem(&late, &engineer, BLOCK), Err(Denied::Late));
}

#[tokio::test]
async fn the_switch_stops_writes_and_only_writes_until_somebody_is_at_the_machine() {
    let folder = tempfile::tempdir().unwrap();
    let policy = Policy::new(Some(folder.path()), Audit::open(None).unwrap(), 0);
    policy.lists.add_target(None, &allowed("10.0.0.1")).unwrap();
    let engineer = person(Role::Engineer).actor;
    policy.open_window(&engineer, None).unwrap();
    let confirmed = policy.hypothetical(1);
    policy.stop_writing(&engineer).unwrap();
    assert_eq!(ask(&policy, &engineer, &write(DEVICE), confirmed.as_ref()), Err(Denied::ReadOnly));
    assert_eq!(ask(&policy, &engineer, &read(DEVICE), None), Ok(()));
    assert_eq!(policy.open_window(&engineer, None), Err(OpenError::Denied(Denied::ReadOnly)));
    assert!(policy.write_state().read_only && policy.write_state().window.is_none());
    std::fs::remove_file(folder.path().join("read-only")).unwrap();
    assert_eq!(policy.open_window(&engineer, None), Ok(()));
}

#[tokio::test(start_paused = true)]
async fn the_switch_at_the_machine_closes_the_window_and_what_was_confirmed_in_it() {
    let folder = tempfile::tempdir().unwrap();
    let policy = Arc::new(Policy::new(Some(folder.path()), Audit::open(None).unwrap(), 0));
    policy.lists.add_target(None, &allowed("10.0.0.1")).unwrap();
    let engineer = person(Role::Engineer).actor;
    policy.open_window(&engineer, None).unwrap();
    let confirmed = policy.hypothetical(1);
    std::fs::write(folder.path().join("read-only"), "").unwrap();
    let mut news = policy.watch();
    let stop = tokio_util::sync::CancellationToken::new();
    let keeper = tokio::spawn(Arc::clone(&policy).keep(stop.clone()));
    tokio::time::timeout(Duration::from_secs(5), news.changed()).await.unwrap().unwrap();
    std::fs::remove_file(folder.path().join("read-only")).unwrap();
    assert_eq!(ask(&policy, &engineer, &write(DEVICE), confirmed.as_ref()), Err(Denied::NoWindow));
    policy.open_window(&engineer, None).unwrap();
    assert_eq!(ask(&policy, &engineer, &write(DEVICE), confirmed.as_ref()), Err(Denied::OtherWindow));
    stop.cancel();
    keeper.await.unwrap();
}

#[tokio::test]
async fn the_switch_stops_writes_also_when_the_disk_takes_nothing() {
    let folder = tempfile::tempdir().unwrap();
    let policy = Policy::new(Some(&folder.path().join("gone")), Audit::open(None).unwrap(), 0);
    let engineer = person(Role::Engineer).actor;
    policy.open_window(&engineer, None).unwrap();
    policy.stop_writing(&engineer).unwrap_err();
    assert!(policy.write_state().read_only && policy.write_state().window.is_none());
    assert_eq!(policy.open_window(&engineer, None), Err(OpenError::Denied(Denied::ReadOnly)));
}

#[tokio::test(start_paused = true)]
async fn a_target_gets_so_many_messages_a_second_and_the_others_theirs() {
    let policy = Policy::new(None, Audit::open(None).unwrap(), 2);
    policy.lists.add_target(None, &allowed("10.0.0.0/24")).unwrap();
    let engineer = person(Role::Engineer).actor;
    let send = |path| ask_shot(&policy, &engineer, &read(path), None, (Some(1), None));
    assert_eq!((send(DEVICE), send(DEVICE)), (Ok(()), Ok(())));
    assert!(matches!(send(DEVICE), Err(Denied::TooMany { limit: 2, .. })));
    assert_eq!(send("4,10.0.0.2"), Ok(()), "one target cannot starve another");
    assert_eq!(ask(&policy, &engineer, &read(DEVICE), None), Ok(()), "a question is no message");
    advance(Duration::from_secs(1)).await;
    assert_eq!(send(DEVICE), Ok(()));
    assert!(matches!(read(DEVICE).target, Target::Network(_)));
}
