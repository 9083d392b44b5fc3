//! The function block: EN, EW, ST, ER, DN and CIPSTATUS, one step per input.
//!
//! Source: 2080-RM001D p. 179, 217, 221 and the message timing of FactoryTalk Design Workbench; decisions where
//! the manual is silent are in docs/ARCHITECTURE.md.

use alloc::sync::Arc;
use alloc::vec::Vec;

use super::failure::Failure;
use super::management::Words;
use super::status::{Cause, CauseKind, CipStatus, Phase, StatusBits};
use super::time::Instant;

/// What happens to a block.
#[derive(Clone, Debug, PartialEq, Eq)]
pub enum Input {
    /// IN goes TRUE.
    Rise,
    /// IN goes FALSE.
    Fall,
    /// The trigger starts a message that has to end before `deadline`.
    Trigger {
        /// The end of `UcmmTimeout`; it may be [`Instant::NEVER`].
        deadline: Instant,
    },
    /// A communication buffer has been allocated.
    BufferGranted,
    /// The target has to be connected first.
    ConnectStarted,
    /// The session is there.
    ConnectEnded,
    /// The request has been written.
    Written {
        /// The end of `ConnMsgTimeout`, which takes over from `UcmmTimeout` for a connected message.
        deadline: Option<Instant>,
    },
    /// A frame came in that does not answer the request.
    ReplyDropped,
    /// Completing the message closes the CIP connection.
    Closing {
        /// And with it the session.
        session: bool,
    },
    /// The device answered with success and this data.
    Succeeded {
        /// Reply data.
        data: Vec<u8>,
        /// Bytes that `ResData` holds.
        size: u16,
    },
    /// The message failed.
    Failed(Failure),
    /// `CtrlCfg.Cancel` goes TRUE.
    Cancel,
    /// Time has passed.
    Tick,
}

/// What the block asks for.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Effect {
    /// Put the message into the queue of its channel.
    Enqueue,
    /// The message has ended: give back its buffer, and forget it if it is still on its way.
    Release,
}

/// One function block instance.
#[derive(Clone, Debug, Default)]
pub struct MsgBlock {
    input: bool,
    q: bool,
    phase: Phase,
    status: CipStatus,
    res_data: Vec<u8>,
    cause: Option<Cause>,
    runs: u64,
    deadline: Instant,
    triggered_at: Instant,
    written_at: Option<Instant>,
    /// CIPCONN and EIPSESS, shown when the message has ended.
    closing: u16,
    /// Frames that came in and did not answer the request.
    dropped: u64,
    reply_us: Option<u64>,
    elapsed_us: Option<u64>,
}

impl MsgBlock {
    /// Takes one input. What does not fit the phase changes nothing.
    pub fn step(&mut self, input: Input, now: Instant) -> Option<Effect> {
        match (self.phase, input) {
            (_, Input::Rise) => {
                self.input = true;
                None
            }
            (phase, Input::Fall) => {
                self.input = false;
                if !phase.is_busy() {
                    self.clear(StatusBits::EN);
                }
                None
            }
            (phase, Input::Trigger { deadline }) if !phase.is_busy() => {
                self.reset(deadline, now);
                Some(Effect::Enqueue)
            }
            (Phase::Waiting, Input::BufferGranted) => {
                self.phase = Phase::Buffered;
                self.set(StatusBits::EW);
                None
            }
            (Phase::Buffered, Input::ConnectStarted) => {
                self.phase = Phase::Connecting;
                None
            }
            (Phase::Connecting, Input::ConnectEnded) => {
                self.phase = Phase::Buffered;
                None
            }
            (Phase::Buffered | Phase::Connecting, Input::Written { deadline }) => {
                self.phase = Phase::Sent;
                self.written_at = Some(now);
                self.deadline = deadline.unwrap_or(self.deadline);
                self.clear(StatusBits::EW);
                self.set(StatusBits::ST);
                None
            }
            // Written again after the target did not know the session: it cannot have acted before.
            (Phase::Sent, Input::Written { deadline }) => {
                self.written_at = Some(now);
                self.deadline = deadline.unwrap_or(self.deadline);
                None
            }
            (Phase::Sent, Input::ReplyDropped) => {
                self.dropped += 1;
                None
            }
            (Phase::Sent, Input::Closing { session }) => {
                self.closing = StatusBits::CIPCONN | if session { StatusBits::EIPSESS } else { 0 };
                None
            }
            (Phase::Sent, Input::Succeeded { data, size }) => Some(self.succeed(data, size, now)),
            (phase, Input::Failed(failure)) if phase.is_busy() => Some(self.fail(&failure, now)),
            (phase, Input::Cancel) if phase.is_busy() => Some(self.fail(&Failure::Cancelled, now)),
            (phase, Input::Tick) if phase.is_busy() && now >= self.deadline => {
                Some(self.fail(&Failure::Timeout, now))
            }
            _ => None,
        }
    }

    /// IN.
    pub const fn input(&self) -> bool {
        self.input
    }

    /// How far the message is.
    pub const fn phase(&self) -> Phase {
        self.phase
    }

    /// CIPSTATUS.
    pub const fn status(&self) -> CipStatus {
        self.status
    }

    /// When a busy message times out.
    pub fn deadline(&self) -> Option<Instant> {
        self.phase.is_busy().then_some(self.deadline).filter(|deadline| *deadline != Instant::NEVER)
    }

    /// Whether it has ended with an answer of the device itself, be it a refusal.
    pub(super) fn is_answered(&self) -> bool {
        let refused = |cause: &Cause| cause.what == CauseKind::RefusedByDevice && cause.by.is_none();
        self.q || self.cause.as_ref().is_some_and(refused)
    }

    /// When the message was triggered.
    pub const fn triggered_at(&self) -> Instant {
        self.triggered_at
    }

    /// Everything that the block itself knows: without the request, its place and its edges.
    pub fn view(&self) -> BlockView {
        BlockView {
            input: self.input,
            q: self.q,
            status: self.status,
            request: Arc::default(),
            res_data: self.res_data.clone(),
            phase: self.phase,
            position: 0,
            cause: self.cause.clone(),
            runs: self.runs,
            reply_us: self.reply_us,
            elapsed_us: self.elapsed_us,
            edges: Vec::new(),
            edges_dropped: 0,
            words: None,
        }
    }

    /// Trigger and retrigger clear Status, ResData, ResLength and Q.
    fn reset(&mut self, deadline: Instant, now: Instant) {
        *self = Self {
            input: self.input,
            phase: Phase::Waiting,
            status: CipStatus { status_bits: StatusBits(StatusBits::EN), ..CipStatus::default() },
            runs: self.runs,
            deadline,
            triggered_at: now,
            ..Self::default()
        };
    }

    fn succeed(&mut self, data: Vec<u8>, size: u16, now: Instant) -> Effect {
        self.reply_us = self.written_at.map(|written| now.micros_since(written));
        if data.len() > usize::from(size) {
            return self.fail(&Failure::TooSmall { length: data.len() }, now);
        }
        self.res_data = data;
        self.q = true;
        self.clear(StatusBits::ST);
        self.set(StatusBits::DN);
        self.end(Phase::Done, now)
    }

    /// EN, EW and ST freeze as they are.
    fn fail(&mut self, failure: &Failure, now: Instant) -> Effect {
        if failure.is_answer() {
            self.reply_us = self.written_at.map(|written| now.micros_since(written));
        }
        let (error_id, sub_error_id, ext_error_id) = failure.error_ids(self.phase);
        let status_bits = self.status.status_bits;
        self.status = CipStatus { error: true, error_id, sub_error_id, ext_error_id, status_bits };
        let cause = failure.cause(self.phase);
        self.cause =
            Some(if *failure == Failure::Timeout { cause.after_dropping(self.dropped) } else { cause });
        self.set(StatusBits::ER);
        self.end(Phase::Failed, now)
    }

    fn end(&mut self, phase: Phase, now: Instant) -> Effect {
        self.phase = phase;
        self.set(self.closing);
        self.runs += 1;
        self.elapsed_us = Some(now.micros_since(self.triggered_at));
        if !self.input {
            self.clear(StatusBits::EN);
        }
        Effect::Release
    }

    const fn set(&mut self, bit: u16) {
        self.status.status_bits.0 |= bit;
    }

    const fn clear(&mut self, bit: u16) {
        self.status.status_bits.0 &= !bit;
    }
}

/// A snapshot of a block.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub struct BlockView {
    /// IN.
    pub input: bool,
    /// Q.
    pub q: bool,
    /// CIPSTATUS.
    pub status: CipStatus,
    /// Message router bytes of the message that everything here is about; empty before the first trigger.
    pub request: Arc<[u8]>,
    /// Reply data.
    pub res_data: Vec<u8>,
    /// How far the message is.
    pub phase: Phase,
    /// Place in the queue: 1 is next; 0 is not queued.
    pub position: usize,
    /// What happened, on an error.
    pub cause: Option<Cause>,
    /// How many times the block has ended with DN or ER.
    pub runs: u64,
    /// µs from the written request to the decoded reply.
    pub reply_us: Option<u64>,
    /// µs from trigger to DN or ER.
    pub elapsed_us: Option<u64>,
    /// µs since the trigger, and the bits from then on.
    pub edges: Vec<(u64, StatusBits)>,
    /// Edges that were left out.
    pub edges_dropped: u64,
    /// Of a SEND_REQ or DATA_EXCH, from its first start on; [`Management`](super::Management) shows them.
    pub words: Option<Arc<Words>>,
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::engine::failure::ConnectError;
    use crate::engine::status::CauseKind;
    use crate::wire::{EncapsulationStatus, GeneralStatus};
    use alloc::string::String;
    use alloc::vec;

    const DEADLINE: Instant = Instant(3_000_000);
    const WRITTEN: Input = Input::Written { deadline: None };
    const TRIGGER: Input = Input::Trigger { deadline: DEADLINE };

    fn reply(length: usize) -> Input {
        Input::Succeeded { data: vec![7; length], size: 490 }
    }

    fn refused() -> Input {
        Input::Failed(Failure::RefusedByDevice(GeneralStatus::PathDestinationUnknown, vec![0x1234, 2]))
    }

    fn after(inputs: &[Input]) -> MsgBlock {
        let mut block = MsgBlock::default();
        for (index, input) in inputs.iter().enumerate() {
            block.step(input.clone(), Instant(index as u64 * 10));
        }
        block
    }

    /// One row per line of the timing tables: the inputs, then the bits and the phase.
    #[test]
    fn the_timing_tables_hold_row_by_row() {
        use Input::{BufferGranted, Cancel, ConnectEnded, ConnectStarted, Fall, Rise};
        let sent = [Rise, TRIGGER, BufferGranted, WRITTEN];
        let with = |more: &[Input]| [&sent[..], more].concat();
        let rows: [(&str, Vec<Input>, u16, Phase); 24] = [
            ("step 1: the rung is TRUE: EN, all others 0", vec![Rise, TRIGGER], 1, Phase::Waiting),
            ("step 2: a buffer is acquired: EW", vec![Rise, TRIGGER, BufferGranted], 3, Phase::Buffered),
            (
                "making a session is not sending",
                vec![Rise, TRIGGER, BufferGranted, ConnectStarted],
                3,
                Phase::Connecting,
            ),
            (
                "a session is not the message",
                vec![Rise, TRIGGER, BufferGranted, ConnectStarted, ConnectEnded],
                3,
                Phase::Buffered,
            ),
            ("step 3: sending: EW falls, ST rises", sent.to_vec(), 5, Phase::Sent),
            ("step 4: the reply: ST falls, DN rises", with(&[reply(2)]), 17, Phase::Done),
            ("step 5: the rung is FALSE: EN falls", with(&[reply(2), Fall]), 16, Phase::Done),
            ("a CIP error freezes EN and ST", with(&[refused()]), 13, Phase::Failed),
            ("then the rung is FALSE: EN falls", with(&[refused(), Fall]), 12, Phase::Failed),
            ("cancel in the wait queue", vec![Rise, TRIGGER, Cancel], 9, Phase::Failed),
            ("cancel with a buffer", vec![Rise, TRIGGER, BufferGranted, Cancel], 11, Phase::Failed),
            (
                "cancel while connecting",
                vec![Rise, TRIGGER, BufferGranted, ConnectStarted, Cancel],
                11,
                Phase::Failed,
            ),
            ("cancel after sending", with(&[Cancel]), 13, Phase::Failed),
            ("cancel after the end is nothing", with(&[reply(2), Cancel]), 17, Phase::Done),
            ("cancel when idle is nothing", vec![Cancel], 0, Phase::Idle),
            ("a rung that is FALSE early keeps EN until the end", with(&[Fall]), 5, Phase::Sent),
            ("and then only DN is left", with(&[Fall, reply(2)]), 16, Phase::Done),
            ("or only ER and ST", with(&[Fall, refused()]), 12, Phase::Failed),
            ("FALSE before a buffer: EN stays", vec![Rise, TRIGGER, Fall], 1, Phase::Waiting),
            ("a rising edge while busy is ignored", with(&[Fall, Rise, TRIGGER]), 5, Phase::Sent),
            ("retrigger from DN clears all", with(&[reply(2), Fall, Rise, TRIGGER]), 1, Phase::Waiting),
            ("retrigger from ER clears all", with(&[refused(), Fall, Rise, TRIGGER]), 1, Phase::Waiting),
            ("a period elapsed while IN is TRUE retriggers", with(&[reply(2), TRIGGER]), 1, Phase::Waiting),
            ("a reply to nobody is nothing", vec![Rise, TRIGGER, reply(2)], 1, Phase::Waiting),
        ];
        for (name, inputs, bits, phase) in rows {
            let block = after(&inputs);
            assert_eq!((block.status.status_bits.0, block.phase), (bits, phase), "{name}");
        }
    }

    #[test]
    fn failures_have_the_numbers_of_the_manual_and_a_cause() {
        use Input::{BufferGranted, ConnectStarted, Rise};
        let waiting = vec![Rise, TRIGGER];
        let buffered = [&waiting[..], &[BufferGranted]].concat();
        let connecting = [&buffered[..], &[ConnectStarted]].concat();
        let sent = [&buffered[..], &[WRITTEN]].concat();
        let unreachable = Failure::NotConnected(ConnectError::Unreachable, String::new());
        let rows = [
            ("no buffer in time", waiting.clone(), None, 55, 112, 9, CauseKind::Timeout, false),
            ("no connection in time", connecting.clone(), None, 55, 113, 11, CauseKind::Timeout, false),
            (
                "the target was busy all the time",
                buffered.clone(),
                None,
                55,
                114,
                11,
                CauseKind::Timeout,
                false,
            ),
            ("no reply in time", sent.clone(), None, 55, 115, 13, CauseKind::Timeout, true),
            ("unreachable", connecting.clone(), Some(unreachable), 210, 0, 11, CauseKind::Unreachable, false),
            (
                "the session is refused",
                connecting,
                Some(Failure::SessionRefused(EncapsulationStatus::InsufficientMemory)),
                55,
                113,
                11,
                CauseKind::SessionRefused,
                false,
            ),
            (
                "an encapsulation status",
                sent.clone(),
                Some(Failure::EncapsulationStatus(EncapsulationStatus(8))),
                69,
                65,
                13,
                CauseKind::EncapsulationStatus,
                true,
            ),
            ("the target closes", sent.clone(), Some(Failure::Closed), 55, 115, 13, CauseKind::Closed, true),
            ("too many sessions", buffered, Some(Failure::Limit), 209, 0, 11, CauseKind::Limit, false),
            (
                "not permitted",
                waiting,
                Some(Failure::NotPermitted(String::new())),
                217,
                0,
                9,
                CauseKind::NotPermitted,
                false,
            ),
            ("cancelled", sent, Some(Failure::Cancelled), 217, 0, 13, CauseKind::Cancelled, true),
        ];
        for (name, inputs, failure, error_id, sub_error_id, bits, what, may_have_acted) in rows {
            let mut block = after(&inputs);
            let effect = match failure {
                Some(failure) => block.step(Input::Failed(failure), Instant(100)),
                None => block.step(Input::Tick, DEADLINE),
            };
            assert_eq!(effect, Some(Effect::Release), "{name}");
            let status = block.status;
            assert!(status.error, "{name}");
            assert_eq!(
                (status.error_id, status.sub_error_id, status.status_bits.0),
                (error_id, sub_error_id, bits),
                "{name}"
            );
            let cause = block.cause.unwrap();
            assert_eq!((cause.what, cause.may_have_acted), (what, may_have_acted), "{name}");
        }
    }

    #[test]
    fn the_deadline_itself_is_too_late_and_a_moment_before_is_not() {
        let mut block = after(&[Input::Rise, TRIGGER]);
        assert_eq!(block.step(Input::Tick, Instant(DEADLINE.0 - 1)), None);
        assert_eq!(block.step(Input::Tick, DEADLINE), Some(Effect::Release));
    }

    #[test]
    fn a_refusal_keeps_every_status_word() {
        let block = after(&[Input::Rise, TRIGGER, Input::BufferGranted, WRITTEN, refused()]);
        assert_eq!(
            (block.status.error_id, block.status.sub_error_id, block.status.ext_error_id),
            (224, 5, 0x1234)
        );
        assert_eq!(block.cause.unwrap().additional, [0x1234, 2]);
    }

    #[test]
    fn a_reply_that_does_not_fit_is_an_error_although_the_device_has_acted() {
        let mut block = after(&[Input::Rise, TRIGGER, Input::BufferGranted, WRITTEN]);
        block.step(Input::Succeeded { data: vec![0; 5], size: 4 }, Instant(100));
        assert_eq!((block.status.error_id, block.status.sub_error_id, block.q), (33, 48, false));
        assert!(block.res_data.is_empty() && block.cause.unwrap().has_acted);
    }

    #[test]
    fn success_sets_q_and_a_retrigger_clears_it() {
        let mut block = after(&[Input::Rise, TRIGGER, Input::BufferGranted, WRITTEN, reply(2)]);
        assert_eq!((block.q, &block.res_data[..], block.runs), (true, &[7, 7][..], 1));
        assert_eq!((block.reply_us, block.elapsed_us), (Some(10), Some(30)));
        assert_eq!(block.step(TRIGGER, Instant(100)), Some(Effect::Enqueue));
        assert_eq!((block.q, block.res_data.len(), block.elapsed_us), (false, 0, None));
    }
}
