//! How good a value is: always a word, a shape and a colour.

use cipdeck_shared::api::{DeviceStatus, HealthState, Quality};
use yew::prelude::*;

use super::i18n::tr;
use crate::kit::Shape;

/// What a row says of its value.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Mark {
    /// The group is off, or there is no connection that would say more.
    Off,
    /// As the relay says.
    Of(Quality),
}

impl Mark {
    fn look(self) -> (Shape, &'static str, AttrValue) {
        match self {
            Self::Off => (Shape::Ring, "ring", tr!("quality.off")),
            Self::Of(Quality::Waiting) => (Shape::Ring, "ring", tr!("quality.waiting")),
            Self::Of(Quality::Good) => (Shape::Tick, "tick", tr!("quality.good")),
            Self::Of(Quality::Stale) => (Shape::Half, "half", tr!("quality.stale")),
            Self::Of(Quality::Bad) => (Shape::Cross, "cross", tr!("quality.bad")),
        }
    }

    /// Word, shape and colour.
    pub(super) fn draw(self) -> Html {
        let (shape, class, word) = self.look();
        html! {
            <span class={classes!("state", class)}>
                { shape.draw() }
                <span class="state-word">{ word }</span>
            </span>
        }
    }
}

/// How a device is: a shape and a colour, and the word unless it is `short`. Not `live`: nobody knows.
pub(super) fn health_mark(status: Option<&DeviceStatus>, live: bool, short: bool) -> Html {
    let state = status.map(|status| status.health.state).filter(|_| live);
    let (shape, class) = match state {
        None | Some(HealthState::Idle) => (Shape::Ring, "ring"),
        Some(HealthState::Asking) => (Shape::Half, "half"),
        Some(HealthState::Good) => (Shape::Tick, "tick"),
        Some(HealthState::Fault) => (Shape::Dot, "half"),
        Some(HealthState::Lost | HealthState::Denied) => (Shape::Cross, "cross"),
    };
    let word = match state {
        None => tr!("health.unknown"),
        Some(state) => health_word(state),
    };
    html! {
        <span class={classes!("state", class)} title={short.then(|| word.clone())}>
            { shape.draw() }
            <span class={if short { "unseen" } else { "state-word" }}>{ word }</span>
        </span>
    }
}

fn health_word(state: HealthState) -> AttrValue {
    match state {
        HealthState::Idle => tr!("health.idle"),
        HealthState::Asking => tr!("health.asking"),
        HealthState::Good => tr!("health.good"),
        HealthState::Fault => tr!("health.fault"),
        HealthState::Lost => tr!("health.lost"),
        HealthState::Denied => tr!("health.denied"),
    }
}
