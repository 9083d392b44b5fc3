//! The activity bit over time: up when the exchange starts, down when it has ended.

use cipdeck_shared::engine::StatusBits;
use yew::prelude::*;

use crate::{pages::block::duration, store::Edge, words::i18n::tr};

/// A pulse: µs since the start of the exchange when it went up and, if it did, down.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
struct Pulse {
    up: u64,
    down: Option<u64>,
}

/// The newest pulse in words and as a drawing; nothing before the first exchange.
pub(super) fn activity(edges: &[Edge]) -> Html {
    let Some(pulse) = pulse(edges) else { return html! {} };
    let (path, words) = match pulse.down {
        Some(down) => ("M0 22H60V6H300V22H420", tr!("activity.both", time = duration(down - pulse.up))),
        None => ("M0 22H60V6H420", tr!("activity.up")),
    };
    html! {
        <figure class="activity" data-test="activity">
            <figcaption>{ "Management_Param[0].0 " }{ words.clone() }</figcaption>
            <svg viewBox="0 0 420 28" role="img" aria-label={words}>
                <path class="axis-lane on en" d={path} />
            </svg>
        </figure>
    }
}

/// The bit is 1 from EN to DN or ER.
fn pulse(edges: &[Edge]) -> Option<Pulse> {
    let is_up =
        |bits: StatusBits| bits.has(StatusBits::EN) && !bits.has(StatusBits::DN) && !bits.has(StatusBits::ER);
    let up = edges.iter().find(|(_, bits)| is_up(*bits))?.0;
    let down =
        edges.iter().find(|(at, bits)| *at >= up && (bits.has(StatusBits::DN) || bits.has(StatusBits::ER)));
    Some(Pulse { up, down: down.map(|(at, _)| *at) })
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_bit_rises_with_the_start_and_falls_with_the_end() {
        let edges = [
            (0, StatusBits(1)),
            (4, StatusBits(3)),
            (300, StatusBits(5)),
            (412, StatusBits(17)),
            (500, StatusBits(16)),
        ];
        assert_eq!(pulse(&edges), Some(Pulse { up: 0, down: Some(412) }));
        assert_eq!(pulse(&edges[..2]), Some(Pulse { up: 0, down: None }));
        assert_eq!(
            pulse(&[(0, StatusBits(StatusBits::EN | StatusBits::ER))]),
            None,
            "refused: it never rises"
        );
    }
}
