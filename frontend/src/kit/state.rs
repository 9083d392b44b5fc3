//! The state of a block: always a word, a shape and a colour.

use cipdeck_shared::engine::Phase;
use yew::prelude::*;

use crate::i18n::tr;

/// A shape that can be told apart without its colour.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Shape {
    /// A ring: nothing going on.
    Ring,
    /// A dot: enabled.
    Dot,
    /// A half circle: waiting.
    Half,
    /// An arrow: sent.
    Arrow,
    /// A tick: done.
    Tick,
    /// A cross: failed.
    Cross,
}

impl Shape {
    /// The shape of a phase.
    pub const fn of(phase: Phase) -> Self {
        match phase {
            Phase::Idle => Self::Ring,
            Phase::Waiting => Self::Dot,
            Phase::Buffered | Phase::Connecting => Self::Half,
            Phase::Sent => Self::Arrow,
            Phase::Done => Self::Tick,
            Phase::Failed => Self::Cross,
        }
    }

    const fn class(self) -> &'static str {
        match self {
            Self::Ring => "ring",
            Self::Dot => "dot",
            Self::Half => "half",
            Self::Arrow => "arrow",
            Self::Tick => "tick",
            Self::Cross => "cross",
        }
    }

    /// The drawing, 12 by 12.
    pub fn draw(self) -> Html {
        let strokes = match self {
            Self::Ring => {
                html! { <circle cx="6" cy="6" r="3.5" fill="none" stroke="currentColor" stroke-width="1.5" /> }
            }
            Self::Dot => html! { <circle cx="6" cy="6" r="4" fill="currentColor" /> },
            Self::Half => html! { <>
                <circle cx="6" cy="6" r="4" fill="none" stroke="currentColor" stroke-width="1.5" />
                <path d="M6 2a4 4 0 0 1 0 8z" fill="currentColor" />
            </> },
            Self::Arrow => stroke("M1.5 6h8M6.5 2.5 10 6 6.5 9.5"),
            Self::Tick => stroke("M1.5 6.5 4.5 9.5 10.5 2.5"),
            Self::Cross => stroke("M2 2 10 10M10 2 2 10"),
        };
        html! {
            <svg class={classes!("shape", self.class())} viewBox="0 0 12 12" width="12" height="12" aria-hidden="true">
                { strokes }
            </svg>
        }
    }
}

fn stroke(path: &'static str) -> Html {
    html! { <path d={path} fill="none" stroke="currentColor" stroke-width="2" stroke-linecap="round" stroke-linejoin="round" /> }
}

/// The phase in words.
fn phase_word(phase: Phase) -> AttrValue {
    match phase {
        Phase::Idle => tr!("phase.idle"),
        Phase::Waiting => tr!("phase.waiting"),
        Phase::Buffered => tr!("phase.buffered"),
        Phase::Connecting => tr!("phase.connecting"),
        Phase::Sent => tr!("phase.sent"),
        Phase::Done => tr!("phase.done"),
        Phase::Failed => tr!("phase.failed"),
    }
}

/// Word, shape and colour of a phase; `short` leaves the word to screen readers.
pub fn state_mark(phase: Phase, short: bool) -> Html {
    let shape = Shape::of(phase);
    let word = phase_word(phase);
    html! {
        <span class={classes!("state", shape.class())} title={short.then(|| word.clone())}>
            { shape.draw() }
            <span class={if short { "unseen" } else { "state-word" }}>{ word }</span>
        </span>
    }
}
