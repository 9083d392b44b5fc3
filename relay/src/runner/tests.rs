use cipdeck_shared::api::Role;
use cipdeck_shared::config::{MsgCipGeneric, write_hex};
use cipdeck_shared::engine::{CauseKind, Phase, StatusBits};

use super::*;
use crate::actor::Actor;
use crate::audit::Audit;
use crate::client::Nobody;
use crate::permit::{Order, permit};

const BLOCK: BlockId = BlockId(1);

fn policy() -> Arc<Policy> {
    Arc::new(Policy::new(None, Audit::open(None).unwrap(), 0))
}

fn engineer() -> Actor {
    Actor::local(Role::Engineer, "127.0.0.1")
}

fn plan(config: &MsgCipGeneric) -> MessagePlan {
    MessagePlan::parse(config).0.unwrap()
}

fn name_of_the_demo_device() -> MessagePlan {
    plan(&MsgCipGeneric::product_name("0,0"))
}

/// Sets 32 bytes of the demo device's output assembly.
fn write(byte: u8) -> MessagePlan {
    let mut config = MsgCipGeneric::product_name("0,0");
    let app = &mut config.app_cfg;
    (app.service, app.class, app.instance, app.attribute) = (16, 4, 150, 3);
    config.req_data = format!("{byte:02x}").repeat(32);
    plan(&config)
}

/// What the output assembly holds.
async fn output(runner: &Runner) -> String {
    let mut config = MsgCipGeneric::product_name("0,0");
    let app = &mut config.app_cfg;
    (app.class, app.instance, app.attribute) = (4, 150, 3);
    let reader = BlockId(99);
    runner.put(reader, "", 1, Ok(plan(&config)));
    write_hex(&runner.run(reader, Some(Order::read(engineer()))).await.unwrap().view.res_data)
}

#[tokio::test]
async fn a_run_is_answered_with_done_before_in_falls() {
    let runner = Runner::unguarded(Arc::new(Nobody), None);
    runner.put(BLOCK, "", 1, Ok(name_of_the_demo_device()));
    let ended = runner.run(BLOCK, None).await.unwrap();
    assert_eq!(ended.view.status.status_bits, StatusBits(StatusBits::EN | StatusBits::DN), "{ended:?}");
    assert!(ended.view.q && ended.view.input);
    assert_eq!(ended.exchange.request[..], [0x0E, 3, 0x20, 1, 0x24, 1, 0x30, 7]);
    assert!(ended.exchange.request_frame.is_some() && ended.exchange.response_frame.is_some());
    let view = runner.view(BLOCK).unwrap();
    assert_eq!((view.input, view.phase), (false, Phase::Done));
    runner.stop().await;
    assert_eq!(runner.run(BLOCK, None).await.unwrap_err(), Refused::Unavailable);
}

/// Twin of the next test: together they show that the gate alone keeps the write from the device.
#[tokio::test]
async fn a_write_that_nobody_confirmed_never_reaches_the_device() {
    let runner = Runner::guarded(Arc::new(Nobody), Guard::new(policy(), permit));
    let (before, status) = write_past_the_command_check(&runner).await;
    assert_eq!(status.phase, Phase::Failed);
    let cause = status.cause.unwrap();
    assert_eq!(cause.what, CauseKind::NotPermitted);
    assert!(cause.detail.unwrap().contains("open a write window"));
    assert_eq!(output(&runner).await, before);
}

#[tokio::test]
async fn without_the_gate_the_same_write_would_reach_the_device() {
    // The command is refused as always; only what stands before the wire lets everything pass.
    let gate: Gate =
        |policy, question| if question.shot.is_some() { Ok(()) } else { permit(policy, question) };
    let runner = Runner::guarded(Arc::new(Nobody), Guard::new(policy(), gate));
    let (before, status) = write_past_the_command_check(&runner).await;
    assert_eq!(status.phase, Phase::Done);
    assert_ne!(output(&runner).await, before);
}

/// Triggers a write in the engine itself, as a faulty or a future entry point would.
async fn write_past_the_command_check(runner: &Runner) -> (String, BlockView) {
    let before = output(runner).await;
    let order = || Some(Order::read(engineer()));
    assert_eq!(runner.run(BLOCK, order()).await.unwrap_err(), Refused::UnknownBlock);
    // A harmless command, and then the block is another one.
    runner.put(BLOCK, "", 1, Ok(name_of_the_demo_device()));
    runner.run(BLOCK, order()).await.unwrap();
    runner.put(BLOCK, "", 2, Ok(write(0xA5)));
    assert!(matches!(runner.run(BLOCK, order()).await, Err(Refused::NotPermitted(_))));
    let (sender, ended) = oneshot::channel();
    runner.0.with(|state, now| {
        let shot = state.engine.run(BLOCK, now).unwrap();
        state.runs.insert((BLOCK, shot), sender);
    });
    ended.await.unwrap();
    (before, runner.view(BLOCK).unwrap())
}

#[tokio::test]
async fn a_confirmed_write_is_sent_and_a_changed_one_has_to_be_confirmed_again() {
    let policy = policy();
    policy.open_window(&engineer(), None).unwrap();
    let confirmed = |revision| Some(Order { actor: engineer(), confirmed: policy.hypothetical(revision) });
    let runner = Runner::guarded(Arc::new(Nobody), Guard::new(Arc::clone(&policy), permit));
    runner.put(BLOCK, "", 1, Ok(write(0x11)));
    assert!(runner.run(BLOCK, confirmed(1)).await.unwrap().view.q);
    assert_eq!(output(&runner).await, "11".repeat(32));
    runner.put(BLOCK, "", 2, Ok(write(0x22)));
    assert!(matches!(runner.run(BLOCK, confirmed(1)).await, Err(Refused::NotPermitted(_))));
    assert!(matches!(runner.set_in(BLOCK, true, confirmed(1)), Err(Refused::NotPermitted(_))));
    assert_eq!(output(&runner).await, "11".repeat(32));
}

#[tokio::test]
async fn a_silent_target_times_out_and_a_cancelled_one_ends_at_once() {
    let listener = tokio::net::TcpListener::bind("127.0.0.1:0").await.unwrap();
    let path = format!("4,127.0.0.1:{}", listener.local_addr().unwrap().port());
    let mut config = MsgCipGeneric::product_name(&path);
    config.target_cfg.ucmm_timeout = 250;
    let runner = Runner::unguarded(Arc::new(Nobody), None);
    runner.put(BLOCK, "", 1, Ok(plan(&config)));
    let status = runner.run(BLOCK, None).await.unwrap().view;
    assert_eq!((status.status.error_id, status.status.sub_error_id), (55, 113), "{status:?}");

    config.target_cfg.ucmm_timeout = 10_000;
    runner.put(BLOCK, "", 2, Ok(plan(&config)));
    let run = runner.run(BLOCK, None);
    let cancel = async {
        assert!(matches!(runner.run(BLOCK, None).await, Err(Refused::Busy)));
        runner.cancel(BLOCK).unwrap();
    };
    let (ended, ()) = tokio::join!(run, cancel);
    assert_eq!(ended.unwrap().view.status.error_id, 217);
}

#[tokio::test]
async fn deleting_a_running_block_answers_its_run() {
    let listener = tokio::net::TcpListener::bind("127.0.0.1:0").await.unwrap();
    let path = format!("4,127.0.0.1:{}", listener.local_addr().unwrap().port());
    let runner = Runner::unguarded(Arc::new(Nobody), None);
    runner.put(BLOCK, "", 1, Ok(plan(&MsgCipGeneric::product_name(&path))));
    let (ended, ()) = tokio::join!(runner.run(BLOCK, None), async { runner.remove(BLOCK) });
    assert_eq!(ended.unwrap().view.status.error_id, 217);
    assert_eq!(runner.view(BLOCK), None);
}

#[tokio::test]
async fn stopping_unregisters_the_session() {
    use tokio::io::AsyncReadExt;
    let listener = tokio::net::TcpListener::bind("127.0.0.1:0").await.unwrap();
    let path = format!("4,127.0.0.1:{}", listener.local_addr().unwrap().port());
    let runner = Runner::unguarded(Arc::new(Nobody), None);
    runner.put(BLOCK, "", 1, Ok(plan(&MsgCipGeneric::product_name(&path))));
    let device = async {
        let (stream, _) = listener.accept().await.unwrap();
        let heard = Arc::new(Mutex::new(Vec::new()));
        let (mut relay, mut sim) = (stream, connect::built_in(connect::built_in_device(), Clock::start()));
        let ear = Arc::clone(&heard);
        let copying = async move {
            let (mut from, mut to) = ([0; 4096], [0; 4096]);
            loop {
                tokio::select! {
                    n = relay.read(&mut from) => match n { Ok(0) | Err(_) => return, Ok(n) => {
                        lock(&ear).extend_from_slice(&from[..n]);
                        tokio::io::AsyncWriteExt::write_all(&mut sim, &from[..n]).await.unwrap();
                    }},
                    n = sim.read(&mut to) => match n { Ok(0) | Err(_) => return, Ok(n) => {
                        tokio::io::AsyncWriteExt::write_all(&mut relay, &to[..n]).await.unwrap();
                    }},
                }
            }
        };
        copying.await;
        std::mem::take(&mut *lock(&heard))
    };
    let commands = async {
        assert!(runner.run(BLOCK, None).await.unwrap().view.q);
        runner.stop().await;
    };
    let (heard, ()) = tokio::join!(device, commands);
    let last = &heard[heard.len() - 24..];
    assert_eq!(last[..2], [0x66, 0], "UnRegisterSession is the last frame");
}

#[tokio::test]
async fn a_panic_in_one_connection_is_survived() {
    use std::sync::atomic::{AtomicBool, Ordering};
    static HAS_PANICKED: AtomicBool = AtomicBool::new(false);
    let gate: Gate = |policy, question| {
        assert!(question.shot.is_none() || HAS_PANICKED.swap(true, Ordering::SeqCst), "on purpose, once");
        permit(policy, question)
    };
    let runner = Runner::guarded(Arc::new(Nobody), Guard::new(policy(), gate));
    runner.put(BLOCK, "", 1, Ok(name_of_the_demo_device()));
    assert!(runner.run(BLOCK, Some(Order::read(engineer()))).await.unwrap().view.q);
    assert!(HAS_PANICKED.load(Ordering::SeqCst));
    runner.stop().await;
}
