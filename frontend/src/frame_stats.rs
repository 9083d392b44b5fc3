//! How much script the live view costs per frame, for the budget.
//!
//! `cipdeckFrameStats()` in the browser's console gives `{frames, mean, p95, max, last}`: milliseconds of script per
//! animation frame in which rows changed, over the last 600 such frames. Counted are the messages that arrived since the
//! frame before (reading JSON, taking it into the store), waking the components and rendering them.

use std::{cell::RefCell, collections::VecDeque, fmt, rc::Rc};

use wasm_bindgen::JsValue;
use yew::platform::spawn_local;

use crate::{browser, store::AskForFrame};

/// A handle to the numbers. Clones are the same.
#[derive(Clone, Default)]
pub struct FrameStats(Rc<RefCell<Numbers>>);

#[derive(Default)]
struct Numbers {
    /// ms spent since the last frame.
    spent: f64,
    frames: u64,
    newest: VecDeque<f64>,
}

impl FrameStats {
    /// ms of script that belong to the next frame.
    pub fn spend(&self, ms: f64) {
        self.0.borrow_mut().spent += ms;
    }

    /// Frames of the browser, each measured until what it has woken is rendered.
    pub fn ask_for_frame(&self) -> AskForFrame {
        let stats = self.clone();
        Rc::new(move |flush| {
            let stats = stats.clone();
            browser::before_next_frame(Box::new(move || {
                let start = browser::now_ms();
                flush();
                // Comes after the renders, which were put into the same queue before it.
                spawn_local(async move { stats.end_frame(browser::now_ms() - start) });
            }));
        })
    }

    /// Lets scripts of the page ask for the numbers.
    pub fn offer(&self) {
        let stats = self.clone();
        browser::offer("cipdeckFrameStats", move || stats.report());
    }

    fn end_frame(&self, ms: f64) {
        let mut numbers = self.0.borrow_mut();
        let all = ms + std::mem::take(&mut numbers.spent);
        numbers.frames += 1;
        numbers.newest.push_back(all);
        if numbers.newest.len() > KEPT {
            numbers.newest.pop_front();
        }
    }

    fn report(&self) -> JsValue {
        let numbers = self.0.borrow();
        let summary = summary(numbers.newest.iter().copied());
        let last = numbers.newest.back().copied().unwrap_or(0.0);
        let object = js_sys::Object::new();
        #[expect(clippy::cast_precision_loss, reason = "a count of frames")]
        let frames = numbers.frames as f64;
        for (name, value) in [
            ("frames", frames),
            ("mean", summary.mean),
            ("p95", summary.p95),
            ("max", summary.max),
            ("last", last),
        ] {
            // A plain object takes every property.
            let _ = js_sys::Reflect::set(&object, &name.into(), &value.into());
        }
        object.into()
    }
}

impl fmt::Debug for FrameStats {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "FrameStats({} frames)", self.0.borrow().frames)
    }
}

#[derive(Debug, Default, PartialEq)]
struct Summary {
    mean: f64,
    p95: f64,
    max: f64,
}

fn summary(values: impl Iterator<Item = f64>) -> Summary {
    let mut sorted: Vec<f64> = Vec::new();
    for value in values {
        // A few hundred values, seldom: a sort of their own would be 4 kB of the page.
        sorted.insert(sorted.partition_point(|other| other.total_cmp(&value).is_lt()), value);
    }
    let Some(max) = sorted.last().copied() else { return Summary::default() };
    #[expect(clippy::cast_precision_loss, reason = "a few hundred values")]
    let mean = sorted.iter().sum::<f64>() / sorted.len() as f64;
    let p95 = sorted.get(sorted.len() * 95 / 100).copied().unwrap_or(max);
    Summary { mean, p95, max }
}

/// Frames that are remembered.
const KEPT: usize = 600;

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_summary_is_of_all_values() {
        let summary = summary((1..=100).map(f64::from));
        assert_eq!(summary, Summary { mean: 50.5, p95: 96.0, max: 100.0 });
        assert_eq!(super::summary(std::iter::empty()), Summary::default());
    }
}
