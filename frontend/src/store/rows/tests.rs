use std::cell::Cell;

use cipdeck_shared::config::MsgCipGeneric;

use super::*;

/// A store whose frames the test draws.
fn store() -> (RowStore, Rc<dyn Fn() -> usize>) {
    let asked = Rc::new(RefCell::new(Vec::<Box<dyn FnOnce()>>::new()));
    let frames = asked.clone();
    let store = RowStore::new(Rc::new(move |flush| asked.borrow_mut().push(flush)));
    let draw = move || {
        let flushes = std::mem::take(&mut *frames.borrow_mut());
        let count = flushes.len();
        for flush in flushes {
            flush();
        }
        count
    };
    (store, Rc::new(draw))
}

fn block(number: u32, revision: u64, path: &str) -> Block {
    Block { id: BlockId(number), revision, config: MsgCipGeneric::product_name(path).into() }
}

fn status(number: u32, runs: u64) -> BlockStatus {
    BlockStatus { runs, ..idle(DeckId::Stored(BlockId(number))) }
}

fn counter() -> (Rc<Cell<usize>>, Callback<()>) {
    let count = Rc::new(Cell::new(0));
    let counted = count.clone();
    (count, Callback::from(move |()| counted.set(counted.get() + 1)))
}

#[test]
fn many_changes_wake_a_row_once_per_frame_and_its_neighbour_never() {
    let (store, draw) = store();
    store.snapshot(vec![block(1, 1, "0,0"), block(2, 1, "0,0")], vec![]);
    draw();
    let ((one, wake_one), (two, wake_two)) = (counter(), counter());
    let _one = store.watch(DeckId::Stored(BlockId(1)), wake_one);
    let _two = store.watch(DeckId::Stored(BlockId(2)), wake_two);
    for runs in 1..=100 {
        store.changes(vec![status(1, runs)], vec![], &[]);
    }
    assert_eq!(one.get(), 0, "nothing is drawn before the frame");
    assert_eq!(draw(), 1, "one frame is asked for");
    assert_eq!((one.get(), two.get()), (1, 0));
    assert_eq!(store.row(DeckId::Stored(BlockId(1))).unwrap().status.runs, 100);
}

#[test]
fn a_snapshot_replaces_stored_blocks_and_keeps_new_ones() {
    let (store, draw) = store();
    let new = DeckId::New(1);
    store.put_new(new, MsgCipGeneric::product_name("0,0").into());
    store.snapshot(vec![block(1, 1, "0,0"), block(2, 1, "0,0")], vec![status(1, 5)]);
    store.snapshot(vec![block(2, 4, "0,0"), block(3, 1, "0,0")], vec![]);
    draw();
    assert_eq!(store.ids().as_ref(), [DeckId::Stored(BlockId(2)), DeckId::Stored(BlockId(3)), new]);
    assert_eq!(store.row(DeckId::Stored(BlockId(2))).unwrap().revision, 4);
}

#[test]
fn an_answer_that_was_overtaken_does_not_bring_back_an_older_revision() {
    let (store, _) = store();
    store.put_stored(block(1, 3, "4,10.0.0.3"));
    store.put_stored(block(1, 2, "4,10.0.0.2"));
    let row = store.row(DeckId::Stored(BlockId(1))).unwrap();
    assert_eq!((row.revision, row.config.target_text()), (3, "4,10.0.0.3"));
}

#[test]
fn the_list_of_ids_stays_the_same_while_only_values_change() {
    let (store, draw) = store();
    store.snapshot(vec![block(1, 1, "0,0")], vec![]);
    draw();
    let (count, wake) = counter();
    let _watch = store.watch_ids(wake);
    let before = store.ids();
    store.changes(vec![status(1, 1)], vec![block(1, 2, "4,10.0.0.1")], &[]);
    draw();
    assert!(Rc::ptr_eq(&before, &store.ids()));
    assert_eq!(count.get(), 0);
    store.changes(vec![], vec![], &[BlockId(1)]);
    draw();
    assert_eq!((count.get(), store.ids().len()), (1, 0));
}
