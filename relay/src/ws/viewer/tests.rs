use std::convert::Infallible;

use cipdeck_shared::api::{ActorKind, Answer, ProblemCode, Role, WriteState};
use cipdeck_shared::config::{BlockId, MsgCipGeneric};
use futures_util::stream;
use tokio::sync::mpsc;
use tokio::task::JoinHandle;
use tokio::time::timeout;
use tokio_util::sync::PollSender;

use super::*;
use crate::actor::{Life, Limits, Standing};
use crate::audit::Audit;
use crate::draft::Draft;
use crate::history::Recorder;
use crate::permit::permit;
use crate::runner::Guard;
use crate::store::Store;

/// A viewer's end of a socket that is made of channels.
struct Page {
    to: mpsc::Sender<Result<Message, Infallible>>,
    from: mpsc::Receiver<Message>,
    blocks: Blocks,
    policy: Arc<Policy>,
    actor: Actor,
    life: Arc<Life>,
    stop: CancellationToken,
    serving: JoinHandle<()>,
}

impl Page {
    /// Opened, with hello and the first snapshot taken.
    async fn open() -> Self {
        let mut page = Self::of(Role::Engineer).await;
        assert!(matches!(page.next().await, ServerMessage::Hello { protocol: 2, .. }));
        assert!(matches!(page.next().await, ServerMessage::Access(WriteState { window: None, .. })));
        let ServerMessage::Snapshot { seq: 1, .. } = page.next().await else { panic!("a snapshot") };
        page
    }

    /// Somebody with a session of this role.
    async fn of(role: Role) -> Self {
        let policy = Arc::new(Policy::new(None, Audit::open(None).unwrap(), 0));
        let store = Store::open(None).await.unwrap();
        let guard = Guard::new(Arc::clone(&policy), permit);
        let blocks = Blocks::open(store, Arc::clone(&policy), guard, Recorder::default()).await.unwrap();
        let limits = Limits { idle: None, absolute: Duration::from_mins(1) };
        let (standing, life) = (Arc::new(Standing::new(Some(role))), Arc::new(Life::begin(1, limits)));
        let actor = Actor::in_session("anna", ActorKind::Person, "", standing, Arc::clone(&life));
        let (to, frames) = mpsc::channel(1);
        let (sink, from) = mpsc::channel(1);
        let sink = PollSender::new(sink);
        let stream = stream::unfold(frames, async |mut frames: mpsc::Receiver<_>| {
            Some((frames.recv().await?, frames))
        });
        let stream = Box::pin(stream);
        let stop = CancellationToken::new();
        let seat = Seat {
            actor: actor.clone(),
            blocks: blocks.clone(),
            policy: Arc::clone(&policy),
            stop: stop.clone(),
        };
        let serving = tokio::spawn(serve(sink, stream, seat, |never| match *never {}));
        Self { to, from, blocks, policy, actor, life, stop, serving }
    }

    async fn say(&mut self, text: impl Into<String>) {
        self.to.send(Ok(Message::Text(text.into().into()))).await.unwrap();
    }

    async fn frame(&mut self) -> Message {
        timeout(Duration::from_secs(5), self.from.recv())
            .await
            .expect("a message in time")
            .expect("an open socket")
    }

    async fn next(&mut self) -> ServerMessage {
        let Message::Text(text) = self.frame().await else { panic!("text") };
        serde_json::from_str(&text).unwrap()
    }

    async fn answer(&mut self) -> (String, Answer) {
        loop {
            if let ServerMessage::Answer { id, answer } = self.next().await {
                return (id, *answer);
            }
        }
    }

    async fn create(&self, config: MsgCipGeneric) -> BlockId {
        self.blocks
            .create(&self.actor, Draft { id: None, revision: None, config: config.into() })
            .await
            .unwrap()
            .id
    }

    async fn problem(&mut self) -> (String, ProblemCode) {
        match self.answer().await {
            (id, Answer::Problem(problem)) => (id, problem.code),
            (_, Answer::Status(status)) => panic!("{status:?}"),
        }
    }
}

#[tokio::test]
async fn a_run_is_answered_under_its_id_and_everybody_sees_it() {
    let mut page = Page::open().await;
    let id = page.create(MsgCipGeneric::product_name("0,0")).await;
    let ServerMessage::Changes { seq: 2, blocks, .. } = page.next().await else { panic!("changes") };
    assert_eq!(blocks[0].id, id);
    page.say(format!(r#"{{"type":"run","id":"c1","block":"{id}"}}"#)).await;
    let (mut is_answered, mut is_seen) = (false, false);
    while !(is_answered && is_seen) {
        match page.next().await {
            ServerMessage::Answer { id, answer } => {
                let Answer::Status(status) = *answer else { panic!("{answer:?}") };
                assert_eq!((id.as_str(), status.status.status_bits.0), ("c1", 17));
                is_answered = true;
            }
            ServerMessage::Changes { statuses, .. } => {
                is_seen |= statuses.iter().any(|status| status.q && status.last.is_some());
            }
            other => panic!("{other:?}"),
        }
    }
}

#[tokio::test]
async fn what_cannot_be_carried_out_is_told_why() {
    let mut page = Page::open().await;
    for (text, id, code) in [
        ("{", "", ProblemCode::Unreadable),
        (r#"{"type":"run"}"#, "", ProblemCode::Unreadable),
        (r#"{"type":"dance","id":"c1"}"#, "c1", ProblemCode::Unreadable),
        (r#"{"type":"run","id":"c2","block":"b9"}"#, "c2", ProblemCode::NotFound),
    ] {
        page.say(text).await;
        assert_eq!(page.problem().await, (id.to_owned(), code), "{text}");
    }
    let mut config = MsgCipGeneric::product_name("0,0");
    let app = &mut config.app_cfg;
    (app.service, app.class, app.instance, app.attribute) = (16, 4, 150, 3);
    config.req_data = "00".repeat(32);
    let id = page.create(config).await;
    page.say(format!(r#"{{"type":"run","id":"c3","block":"{id}"}}"#)).await;
    assert_eq!(page.problem().await, ("c3".to_owned(), ProblemCode::NotPermitted));
    page.policy.open_window(&page.actor, None).unwrap();
    let ticket = page.blocks.offer(&page.actor, id, 1).await.unwrap().ticket;
    for (command, is_done) in [("c4", true), ("c5", false)] {
        page.say(format!(r#"{{"type":"run","id":"{command}","block":"{id}","ticket":"{ticket}"}}"#)).await;
        let (answered, answer) = page.answer().await;
        assert_eq!((answered.as_str(), matches!(answer, Answer::Status(_))), (command, is_done), "once");
    }
    page.to.send(Ok(Message::Binary(vec![1].into()))).await.unwrap();
    assert_eq!(page.problem().await.1, ProblemCode::Unreadable);
}

#[tokio::test]
async fn an_oversize_message_closes_with_1009() {
    let mut page = Page::open().await;
    page.say(" ".repeat(MAX_MESSAGE + 1)).await;
    let Message::Close(Some(frame)) = page.frame().await else { panic!("a close frame") };
    assert_eq!(frame.code, 1009);
    drop(page.to);
    page.serving.await.unwrap();
}

#[tokio::test]
async fn somebody_who_is_locked_out_hears_so_and_nothing_more() {
    let mut page = Page::open().await;
    page.life.end();
    let Message::Close(Some(frame)) = page.frame().await else { panic!("a close frame") };
    assert_eq!(frame.code, 4401);
    drop(page.to);
    page.serving.await.unwrap();
}

#[tokio::test]
async fn a_viewer_hears_of_the_write_window_and_cannot_command() {
    let mut page = Page::of(Role::Viewer).await;
    let engineer = Actor::local(Role::Engineer, "");
    let id = page.blocks.create(&engineer, draft()).await.unwrap().id;
    page.policy.open_window(&engineer, None).unwrap();
    loop {
        if let ServerMessage::Access(WriteState { window: Some(window), .. }) = page.next().await {
            break assert_eq!(window.owner, "local");
        }
    }
    for command in ["run", "cancel"] {
        page.say(format!(r#"{{"type":"{command}","id":"c1","block":"{id}"}}"#)).await;
        assert_eq!(page.problem().await.1, ProblemCode::NotPermitted, "{command}");
    }
    page.say(format!(r#"{{"type":"in","id":"c1","block":"{id}","IN":false}}"#)).await;
    assert_eq!(page.problem().await.1, ProblemCode::NotPermitted);
}

fn draft() -> Draft {
    Draft { id: None, revision: None, config: MsgCipGeneric::product_name("0,0").into() }
}

#[tokio::test]
async fn stopping_says_so() {
    let mut page = Page::open().await;
    page.stop.cancel();
    let Message::Close(Some(frame)) = page.frame().await else { panic!("a close frame") };
    assert_eq!(frame.code, 1001);
    drop(page.to);
    page.serving.await.unwrap();
}

#[tokio::test]
async fn changes_come_at_most_every_50_ms_and_a_slow_viewer_gets_the_newest_only() {
    let mut page = Page::open().await;
    let id = page.create(MsgCipGeneric::product_name("0,0")).await;
    page.next().await;
    let begin = Instant::now();
    // Nobody reads meanwhile: the channel holds one message, then the relay waits.
    for _ in 0..200 {
        page.blocks.run(&page.actor, id, None).await.unwrap();
    }
    let elapsed = begin.elapsed();
    let mut messages = 0;
    loop {
        messages += 1;
        let ServerMessage::Changes { statuses, .. } = page.next().await else { panic!("changes") };
        assert_eq!(statuses.len(), 1);
        assert!(statuses[0].edges.len() <= 16);
        if statuses[0].runs == 200 && !statuses[0].input {
            break;
        }
    }
    let most = elapsed.as_millis() / PAUSE.as_millis() + 3;
    assert!(messages <= most.min(4), "{messages} messages in {elapsed:?}");
}

#[tokio::test(start_paused = true)]
async fn a_viewer_that_reads_nothing_is_left_behind() {
    let page = Page::of(Role::Viewer).await;
    // Time passes by itself while everybody waits.
    page.serving.await.unwrap();
}

#[tokio::test]
async fn a_hundred_thousand_random_frames_of_a_viewer_move_nothing() {
    let page = Page::of(Role::Viewer).await;
    let id = page.blocks.create(&Actor::local(Role::Engineer, ""), draft()).await.unwrap().id;
    let Page { to, mut from, blocks, serving, .. } = page;
    let heard = tokio::spawn(async move {
        let mut refused = 0;
        while let Some(frame) = from.recv().await {
            let Message::Text(text) = frame else { panic!("closed: {frame:?}") };
            assert!(!text.contains(r#""type":"answer""#) || text.contains(r#""problem""#), "{text}");
            refused += usize::from(text.contains(r#""type":"answer""#));
        }
        refused
    });
    let commands = [
        format!(r#"{{"type":"run","id":"c1","block":"{id}"}}"#),
        format!(r#"{{"type":"in","id":"c2","block":"{id}","IN":true,"ticket":"0123"}}"#),
        format!(r#"{{"type":"cancel","id":"c3","block":"{id}"}}"#),
    ];
    let mut state = 20_261_122_u64;
    let mut noise = |below: usize| {
        state = state.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1_442_695_040_888_963_407);
        usize::try_from(state >> 33).unwrap() % below
    };
    for _ in 0..100_000 {
        let mut bytes = commands[noise(commands.len())].clone().into_bytes();
        for _ in 0..noise(4) {
            let at = noise(bytes.len());
            bytes[at] = b" \"{}[]:,0aen\\\xff"[noise(14)];
        }
        bytes.truncate(1 + noise(2 * bytes.len()));
        let frame = match String::from_utf8(bytes) {
            Ok(text) => Message::Text(text.into()),
            Err(error) => Message::Binary(error.into_bytes().into()),
        };
        to.send(Ok(frame)).await.unwrap();
    }
    drop(to);
    serving.await.unwrap();
    assert!(heard.await.unwrap() > 20_000, "whoever asks is told");
    let status = blocks.status(id).unwrap();
    assert_eq!((status.runs, status.input), (0, false));
}
