//! Follows a listing while the relay makes it.

use std::rc::Rc;

use cipdeck_shared::{
    api::{BrowsePage, BrowseRequest, BrowseStep, BrowsedSymbol, BrowsedType, Problem},
    config::DeviceId,
};
use gloo_timers::callback::Timeout;
use yew::{platform::spawn_local, prelude::*};

use crate::{devices::api, office::query::query, store::Shelf};

/// What is known until now.
#[derive(Clone, Debug, PartialEq)]
pub(super) struct Listing {
    pub(super) step: BrowseStep,
    pub(super) reason: Option<String>,
    pub(super) requests: u64,
    pub(super) expected: Option<usize>,
    pub(super) symbols: Rc<Vec<BrowsedSymbol>>,
    /// The members of structures that were opened, by the structure's key.
    pub(super) types: Rc<Shelf<String, Rc<BrowsedType>>>,
    /// The addresses whose members are shown.
    pub(super) open: Rc<Shelf<String, ()>>,
    /// Why the relay does not say more.
    pub(super) problem: Option<Rc<Problem>>,
    /// Why the members that somebody wanted to see are not there.
    pub(super) unknown: Option<Rc<Problem>>,
    pub(super) cancel: Callback<()>,
    pub(super) again: Callback<()>,
    /// Shows or hides the members of an address with this structure.
    pub(super) members: Callback<(String, String)>,
}

#[derive(Clone, Default, PartialEq)]
struct State {
    page: Option<Rc<BrowsePage>>,
    symbols: Rc<Vec<BrowsedSymbol>>,
    problem: Option<Rc<Problem>>,
    /// Counts the answers: one may say the same as the one before.
    round: u32,
}

/// ms between two questions.
const ROUND_MS: u32 = 250;

/// Asks the device anew, and then the relay for what has come.
#[hook]
pub(super) fn use_listing(device: DeviceId) -> Listing {
    let state = use_state(State::default);
    let types = use_state(Rc::<Shelf<String, Rc<BrowsedType>>>::default);
    let open = use_state(Rc::<Shelf<String, ()>>::default);
    // Why the members of a structure are not known.
    let unknown = use_state(|| None::<Rc<Problem>>);
    let (asked, next) = (use_state(|| 0_u32), use_state(|| None::<usize>));
    use_effect_with((device, *asked), {
        let (state, next) = (state.clone(), next.clone());
        move |(device, _)| {
            let device = *device;
            state.set(State::default());
            next.set(None);
            spawn_local(async move {
                match api::browse(device, BrowseRequest::default()).await {
                    Ok(()) => next.set(Some(0)),
                    Err(problem) => state.set(State { problem: Some(Rc::new(problem)), ..State::default() }),
                }
            });
            move || {
                spawn_local(async move {
                    // Nobody looks any more; ended already is ended as well.
                    let _ = api::end_browse(device).await;
                });
            }
        }
    });
    // Each answer asks for the next one, after a moment.
    use_effect_with((*next, state.clone()), {
        let next = next.clone();
        move |(from, state)| {
            let runs = state
                .page
                .as_ref()
                .is_none_or(|page| page.state == BrowseStep::Running || page.next < page.found);
            let wait = from.filter(|_| runs && state.problem.is_none()).map(|from| {
                let state = state.clone();
                Timeout::new(ROUND_MS, move || {
                    spawn_local(async move {
                        match api::get::<BrowsePage>(format!("devices/{device}/browse?from={from}")).await {
                            Ok(page) => {
                                let mut symbols = (*state.symbols).clone();
                                symbols.extend(page.symbols.iter().cloned());
                                next.set(Some(page.next));
                                let round = state.round + 1;
                                state.set(State {
                                    page: Some(Rc::new(page)),
                                    symbols: Rc::new(symbols),
                                    problem: None,
                                    round,
                                });
                            }
                            Err(problem) => {
                                state.set(State { problem: Some(Rc::new(problem)), ..(*state).clone() });
                            }
                        }
                    });
                })
            });
            move || drop(wait)
        }
    });
    let cancel = Callback::from(move |()| {
        spawn_local(async move {
            // What becomes of it is in the next page.
            let _ = api::end_browse(device).await;
        });
    });
    let again = Callback::from({
        let asked = asked.clone();
        move |()| asked.set(*asked + 1)
    });
    let members = {
        let (types, open, unknown) = (types.clone(), open.clone(), unknown.clone());
        Callback::from(move |(address, structure): (String, String)| {
            let mut changed = (**open).clone();
            if changed.remove(&address).is_none() {
                changed.insert(address, ());
            }
            open.set(Rc::new(changed));
            if types.get(&structure).is_some() {
                return;
            }
            let (types, unknown) = (types.clone(), unknown.clone());
            spawn_local(async move {
                let of = query(&[("of", &structure)]);
                match api::get::<BrowsedType>(format!("devices/{device}/browse/type{of}")).await {
                    Ok(found) => {
                        let mut more = (**types).clone();
                        more.insert(structure, Rc::new(found));
                        types.set(Rc::new(more));
                        unknown.set(None);
                    }
                    Err(problem) => unknown.set(Some(Rc::new(problem))),
                }
            });
        })
    };
    let page = state.page.as_deref();
    Listing {
        step: page.map_or(BrowseStep::Idle, |page| page.state),
        reason: page.and_then(|page| page.reason.clone()),
        requests: page.map_or(0, |page| page.requests),
        expected: page.and_then(|page| page.expected),
        symbols: state.symbols.clone(),
        types: (*types).clone(),
        open: (*open).clone(),
        problem: state.problem.clone(),
        unknown: (*unknown).clone(),
        cancel,
        again,
        members,
    }
}
