//! Reads the texts a moment after they have changed.

use std::rc::Rc;

use cipdeck_shared::code::import;
use gloo_timers::callback::Timeout;
use yew::prelude::*;

use super::desk::{Deed, Desk, Source};

/// ms without a change before a text is read.
const PAUSE_MS: u32 = 250;

/// The same for a text of which reading takes a while.
const LONG_PAUSE_MS: u32 = 800;

/// Bytes of such a text.
const LONG: usize = 100 * 1024;

/// One text after the other, so that a hundred files do not stop the page.
#[hook]
pub(super) fn use_reading(desk: &UseReducerHandle<Desk>) {
    let next = desk.sources.iter().find(|source| source.is_stale);
    let next = next.map(|source| (source.key, source.text.clone(), source.dialect, pause(source)));
    let dispatcher = desk.dispatcher();
    use_effect_with(next, move |next| {
        let timer = next.clone().map(|(key, text, dialect, pause)| {
            Timeout::new(pause, move || {
                let imported = Rc::new(import(&text, dialect));
                dispatcher.dispatch(Deed::Read(key, text, dialect, imported));
            })
        });
        move || drop(timer)
    });
}

/// Nobody types into a file that was not read before.
fn pause(source: &Source) -> u32 {
    match (source.file.is_some() && source.imported.is_none(), source.text.len()) {
        (true, _) => 0,
        (false, 0..LONG) => PAUSE_MS,
        (false, _) => LONG_PAUSE_MS,
    }
}
