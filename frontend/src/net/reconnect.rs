//! When to connect again: a machine without a socket and without a clock.

/// What the connection is doing.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Phase {
    /// Before the first try.
    #[default]
    Idle,
    /// A try is under way.
    Connecting,
    /// The relay talks to us.
    Online,
    /// The last try has failed; the next one is due after the wait.
    Waiting,
}

/// What happens to the connection.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Input {
    /// Start, or try now although the wait is not over.
    Try,
    /// The relay has said hello.
    Hello,
    /// The socket is closed, or could not be opened.
    Closed,
    /// The wait is over.
    Due,
    /// The relay does not want to talk to whoever is here: nobody is signed in, or they may not. Trying again would
    /// change nothing.
    Refused,
}

/// What to do.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Action {
    /// Open a socket.
    Open,
    /// Say [`Input::Due`] after so many milliseconds.
    Wait(u32),
}

/// The machine.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Reconnect {
    phase: Phase,
    failures: u32,
    was_online: bool,
}

impl Reconnect {
    /// Where it is.
    pub const fn phase(&self) -> Phase {
        self.phase
    }

    /// Whether there has ever been a relay. Without one the page speaks of none, not of a lost one.
    pub const fn was_online(&self) -> bool {
        self.was_online
    }

    /// One step.
    pub fn step(&mut self, input: Input) -> Option<Action> {
        match (self.phase, input) {
            (Phase::Idle, Input::Try) | (Phase::Waiting, Input::Try | Input::Due) => {
                self.phase = Phase::Connecting;
                Some(Action::Open)
            }
            (Phase::Connecting, Input::Hello) => {
                *self = Self { phase: Phase::Online, failures: 0, was_online: true };
                None
            }
            (Phase::Connecting | Phase::Online, Input::Closed) => {
                self.phase = Phase::Waiting;
                let wait = WAITS[usize::try_from(self.failures).unwrap_or(LAST).min(LAST)];
                self.failures += 1;
                Some(Action::Wait(wait))
            }
            (_, Input::Refused) => {
                *self = Self { was_online: self.was_online, ..Self::default() };
                None
            }
            _ => None,
        }
    }
}

/// ms. Short at first: a relay that is started again should be back before anybody reloads the page.
const WAITS: [u32; 5] = [250, 500, 1_000, 2_000, 5_000];
const LAST: usize = WAITS.len() - 1;

#[cfg(test)]
mod tests {
    use super::*;

    fn after(inputs: &[Input]) -> Reconnect {
        let mut machine = Reconnect::default();
        for input in inputs {
            machine.step(*input);
        }
        machine
    }

    #[test]
    fn waits_grow_to_five_seconds_and_start_again_after_a_hello() {
        let mut machine = after(&[Input::Try]);
        let mut waits = Vec::new();
        for _ in 0..7 {
            let Some(Action::Wait(wait)) = machine.step(Input::Closed) else { panic!("a wait") };
            waits.push(wait);
            assert_eq!(machine.step(Input::Due), Some(Action::Open));
        }
        assert_eq!(waits, [250, 500, 1_000, 2_000, 5_000, 5_000, 5_000]);
        machine.step(Input::Hello);
        assert_eq!(machine.step(Input::Closed), Some(Action::Wait(250)));
    }

    #[test]
    fn a_late_or_double_input_changes_nothing() {
        let online = after(&[Input::Try, Input::Hello]);
        for input in [Input::Try, Input::Due, Input::Hello] {
            let mut machine = online;
            assert_eq!((machine.step(input), machine), (None, online), "{input:?}");
        }
        let waiting = after(&[Input::Try, Input::Closed]);
        for input in [Input::Closed, Input::Hello] {
            let mut machine = waiting;
            assert_eq!((machine.step(input), machine), (None, waiting), "{input:?}");
        }
    }

    #[test]
    fn who_is_refused_does_not_come_back_by_itself() {
        let mut machine = after(&[Input::Try, Input::Hello]);
        assert_eq!(machine.step(Input::Refused), None);
        for late in [Input::Closed, Input::Due, Input::Hello] {
            assert_eq!((machine.step(late), machine.phase()), (None, Phase::Idle), "{late:?}");
        }
        assert_eq!(machine.step(Input::Try), Some(Action::Open), "a person who has signed in elsewhere");
    }

    #[test]
    fn a_person_may_cut_the_wait_short() {
        let mut machine = after(&[Input::Try, Input::Closed]);
        assert_eq!(machine.step(Input::Try), Some(Action::Open));
        assert!(!machine.was_online());
    }
}
