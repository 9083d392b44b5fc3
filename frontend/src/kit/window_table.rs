//! A table of which only the visible rows exist: a thousand rows cost what forty cost.

use std::{ops::Range, rc::Rc};

use wasm_bindgen::{JsCast, closure::Closure};
use web_sys::{Element, HtmlElement, ResizeObserver};
use yew::prelude::*;

/// Rows that are rendered above and below the visible ones.
const OVERSCAN: usize = 8;

/// The rows to render, for a table that is scrolled to `top` in a view of `height`. All lengths in px.
pub fn window(top: i32, height: i32, row_height: u32, count: usize) -> Range<usize> {
    let rows =
        |px: i32| usize::try_from(px.max(0)).unwrap_or(0) / usize::try_from(row_height.max(1)).unwrap_or(1);
    let first = rows(top).min(count);
    let end = first.saturating_add(rows(height) + 2 + OVERSCAN).min(count);
    first.saturating_sub(OVERSCAN)..end
}

/// A windowed table.
#[derive(Clone, Debug, PartialEq, Properties)]
pub struct WindowTableProps<Id: PartialEq> {
    /// What the table shows.
    pub label: AttrValue,
    /// All rows in order.
    pub ids: Rc<[Id]>,
    /// Height of every row in px; the style sheet has to agree.
    pub row_height: u32,
    /// The header cells.
    pub header: Html,
    /// One row: its `aria-rowindex`, and which entry.
    pub row: Callback<(usize, Id), Html>,
}

/// Scrolls by itself; gives the rows their places with two spacers.
#[component]
pub fn WindowTable<Id: Copy + PartialEq + 'static>(props: &WindowTableProps<Id>) -> Html {
    let view = use_node_ref();
    let (above, below) = (use_node_ref(), use_node_ref());
    let place = use_state_eq(|| (0, 0));
    let shown = window(place.0, place.1, props.row_height, props.ids.len());
    let onscroll = {
        let (view, place) = (view.clone(), place.clone());
        Callback::from(move |_: Event| place.set(measure(&view)))
    };
    use_effect_with(view.clone(), {
        let place = place.clone();
        move |view| {
            place.set(measure(view));
            let measured = view.clone();
            let on_resize = Closure::<dyn Fn()>::new(move || place.set(measure(&measured)));
            let observer = ResizeObserver::new(on_resize.as_ref().unchecked_ref()).ok();
            if let Some((observer, element)) = observer.as_ref().zip(view.cast::<Element>()) {
                observer.observe(&element);
            }
            move || {
                if let Some(observer) = observer {
                    observer.disconnect();
                }
                drop(on_resize);
            }
        }
    });
    use_effect_with((shown.clone(), props.ids.len(), props.row_height), {
        let (above, below) = (above.clone(), below.clone());
        move |(shown, count, row_height)| {
            set_height(&above, shown.start, *row_height);
            set_height(&below, count - shown.end, *row_height);
        }
    });
    // One cell, however many columns: a narrow window hides some of them.
    let spacer = |key: &'static str, node: NodeRef| {
        html! {
            <tr {key} class="spacer" aria-hidden="true"><td><div ref={node} /></td></tr>
        }
    };
    let rows = shown.clone().filter_map(|index| {
        let id = *props.ids.get(index)?;
        // The header is row 1.
        Some(props.row.emit((index + 2, id)))
    });
    html! {
        <div class="window" ref={view} {onscroll} tabindex="0" role="region" aria-label={props.label.clone()}>
            <table class="table" aria-label={props.label.clone()} aria-rowcount={(props.ids.len() + 1).to_string()}>
                <thead><tr aria-rowindex="1">{ props.header.clone() }</tr></thead>
                <tbody>
                    { spacer("above", above) }
                    { for rows }
                    { spacer("below", below) }
                </tbody>
            </table>
        </div>
    }
}

fn measure(view: &NodeRef) -> (i32, i32) {
    view.cast::<Element>().map_or((0, 0), |view| (view.scroll_top(), view.client_height()))
}

/// Through the object model: the content security policy allows no style attributes.
fn set_height(node: &NodeRef, rows: usize, row_height: u32) {
    if let Some(element) = node.cast::<HtmlElement>() {
        let height = format!("{}px", rows * usize::try_from(row_height).unwrap_or(0));
        // A length in px is always accepted.
        let _ = element.style().set_property("height", &height);
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn only_visible_rows_and_a_few_more_are_rendered() {
        assert_eq!(window(0, 600, 30, 1_000), 0..30);
        assert_eq!(window(3_000, 600, 30, 1_000), 92..130);
        assert_eq!(window(29_400, 600, 30, 1_000), 972..1_000);
    }

    #[test]
    fn short_lists_and_odd_measures_stay_inside() {
        assert_eq!(window(0, 600, 30, 3), 0..3);
        assert_eq!(
            window(90_000, 600, 30, 10),
            2..10,
            "the list has become shorter than the scroll position"
        );
        assert_eq!(window(-5, -5, 0, 10), 0..10);
        assert_eq!(window(0, 0, 30, 0), 0..0);
    }
}
