use std::cell::Cell;

use cipdeck_shared::api::Quality;

use super::*;

/// A store whose frames come when a test wants them.
fn store() -> (ValueStore, impl Fn()) {
    type Call = Box<dyn FnOnce()>;
    let asked: Rc<RefCell<Vec<Call>>> = Rc::default();
    let asks = asked.clone();
    let store = ValueStore::new(Rc::new(move |call| asks.borrow_mut().push(call)));
    let frame = move || {
        let calls = std::mem::take(&mut *asked.borrow_mut());
        assert!(calls.len() <= 1, "one frame is asked for once");
        for call in calls {
            call();
        }
    };
    (store, frame)
}

fn value(id: u32, number: f64) -> Newest {
    Newest {
        variable: VariableId(id),
        quality: Quality::Good,
        reason: None,
        text: number.to_string(),
        number: Some(number),
        kind: "REAL".to_owned(),
        age_ms: None,
    }
}

const GROUP: GroupId = GroupId(1);

#[test]
fn many_changes_in_a_frame_wake_a_row_once_and_the_others_never() {
    let (store, frame) = store();
    let woken = Rc::new([Cell::new(0), Cell::new(0)]);
    let watches = [0, 1].map(|place: u32| {
        let woken = woken.clone();
        let wake = move |()| {
            let count = &woken[place as usize];
            count.set(count.get() + 1);
        };
        store.watch(VariableId(place), Callback::from(wake))
    });
    for number in 0..10 {
        store.put(GROUP, vec![value(1, f64::from(number))], f64::from(number));
    }
    frame();
    assert_eq!((woken[0].get(), woken[1].get()), (0, 1));
    drop(watches);
    store.put(GROUP, vec![value(1, 0.0)], 0.0);
    frame();
    assert_eq!(woken[1].get(), 1, "nobody looks any more");
}

#[test]
fn the_range_grows_until_it_is_counted_anew() {
    let (store, _) = store();
    for number in [5.0, 1.0, 9.0, f64::NAN, 4.0] {
        store.put(GROUP, vec![value(1, number)], 0.0);
    }
    let range = || store.value(VariableId(1)).unwrap().range;
    assert_eq!(range(), Some((1.0, 9.0)));
    store.reset_ranges(GroupId(2));
    assert_eq!(range(), Some((1.0, 9.0)), "another group's");
    store.reset_ranges(GROUP);
    assert_eq!(range(), Some((4.0, 4.0)));
}

#[test]
fn numbers_are_kept_only_of_what_is_drawn() {
    let (store, _) = store();
    store.trace(&[VariableId(1)]);
    store.put(GROUP, vec![value(1, 1.0), value(2, 2.0)], 10.0);
    let mut stale = value(1, 1.0);
    stale.quality = Quality::Stale;
    store.put(GROUP, vec![stale], 20.0);
    let kept = |id| store.series(VariableId(id), |series| (series.at(15.0), series.at(25.0)));
    assert_eq!((kept(1), kept(2)), (Some((Some(1.0), None)), None), "a stale value is a gap");
    store.forget(GROUP);
    assert_eq!(store.value(VariableId(1)), None);
}
