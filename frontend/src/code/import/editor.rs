//! The field for code: a native text field over a sheet with line numbers, colours and marks. Only the lines in sight
//! are drawn, so that a text may be long.

use std::{ops::Range, rc::Rc};

use cipdeck_shared::plan::Severity;
use web_sys::{HtmlElement, HtmlTextAreaElement};
use yew::prelude::*;

use super::super::{i18n::tr, lines::Lines, sheet::ink};

/// A line that something is said about.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Mark {
    /// From 1.
    pub line: usize,
    /// The worst that is said.
    pub severity: Severity,
}

/// A wish to see a line. A new one each time, also for the same line.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Wish {
    /// From 1; 0 = none.
    pub line: usize,
    /// Counts the wishes.
    pub number: u32,
}

/// The field.
#[derive(Clone, Debug, PartialEq, Properties)]
pub struct CodeEditorProps {
    /// What is in it.
    pub text: Rc<str>,
    /// The same as lines.
    pub lines: Rc<Lines>,
    /// Sorted by their lines.
    pub marks: Rc<[Mark]>,
    /// The line to show.
    pub wish: Wish,
    /// Hears every change.
    pub on_text: Callback<String>,
}

/// Both layers have the same letters at the same places; those of the field are transparent.
#[component]
pub fn CodeEditor(props: &CodeEditorProps) -> Html {
    let field = use_node_ref();
    let view = use_state_eq(View::default);
    let look = {
        let (field, view) = (field.clone(), view.setter());
        move || {
            if let Some(field) = field.cast::<HtmlElement>() {
                view.set(View {
                    top: field.scroll_top(),
                    left: field.scroll_left(),
                    height: field.client_height(),
                });
            }
        }
    };
    use_effect_with(props.text.clone(), {
        let look = look.clone();
        move |_| look()
    });
    use_effect_with(props.wish, {
        let (field, lines, text) = (field.clone(), props.lines.clone(), props.text.clone());
        move |wish| {
            if let Some(field) = field.cast::<HtmlTextAreaElement>().filter(|_| wish.line > 0) {
                show(&field, &text, &lines.range(wish.line), wish.line);
            }
        }
    });
    let onscroll = move |_: Event| look();
    let oninput = props
        .on_text
        .reform(|event: InputEvent| event.target_unchecked_into::<HtmlTextAreaElement>().value());
    let is_drawn = props.lines.are_short();
    html! {
        <div class={classes!("code-editor", (!is_drawn).then_some("plain"))}>
            if is_drawn {
                { sheet(props, *view) }
            }
            <textarea
                ref={field} id="code-text" class="code-field" wrap="off" spellcheck="false" autocapitalize="none"
                autocomplete="off" aria-label={tr!("intake.text")} aria-describedby="code-summary"
                placeholder={tr!("intake.placeholder")} value={props.text.to_string()} {oninput} {onscroll}
                data-test="code-text"
            />
        </div>
    }
}

/// What of the field is in sight, in px.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
struct View {
    top: i32,
    left: i32,
    height: i32,
}

/// px of a line; styles/code.css has the same.
const LINE: i32 = 18;

/// Lines in sight, from 1.
fn in_sight(view: View, count: usize) -> Range<usize> {
    let whole = |px: i32| usize::try_from(px / LINE).unwrap_or(0);
    // Before the first measurement: as many as a big screen has.
    let height = if view.height == 0 { 80 * LINE } else { view.height };
    let first = whole(view.top) + 1;
    first..(first + whole(height) + 2).min(count + 1)
}

fn sheet(props: &CodeEditorProps, view: View) -> Html {
    let shown = in_sight(view, props.lines.count());
    let above = i32::try_from(shown.start - 1).unwrap_or(i32::MAX / LINE).saturating_mul(LINE);
    let down = above - view.top;
    let line = |number: usize| {
        let found = props.marks.binary_search_by_key(&number, |mark| mark.line).ok();
        let mark = found.and_then(|index| props.marks.get(index)).map(|mark| class(mark.severity));
        (mark, number)
    };
    let shown: Vec<_> = shown.map(line).collect();
    let numbers = shown.iter().map(|(mark, number)| {
        html! { <div key={*number} class={classes!("code-number", *mark)}>{ *number }</div> }
    });
    let lines = shown.iter().map(|(mark, number)| {
        html! {
            <div key={*number} class={classes!("code-drawn", *mark)} data-line={number.to_string()}>
                { ink(&props.lines, *number) }
            </div>
        }
    });
    html! { <>
        <Layer class="code-gutter" right={0} {down}>{ for numbers }</Layer>
        <Layer class="code-layer" right={-view.left} {down}>{ for lines }</Layer>
    </> }
}

#[derive(Clone, PartialEq, Properties)]
struct LayerProps {
    class: &'static str,
    /// px from where the field begins.
    right: i32,
    down: i32,
    children: Html,
}

/// What moves with the field.
#[component]
fn Layer(props: &LayerProps) -> Html {
    let node = use_node_ref();
    use_effect_with((node.clone(), props.right, props.down), |(node, right, down)| {
        if let Some(element) = node.cast::<HtmlElement>() {
            // Through the object model: the content security policy allows no style attributes. Lengths in px are always
            // accepted.
            let _ = element.style().set_property("transform", &format!("translate({right}px, {down}px)"));
        }
    });
    html! {
        <div class={props.class} aria-hidden="true"><div ref={node}>{ props.children.clone() }</div></div>
    }
}

const fn class(severity: Severity) -> &'static str {
    match severity {
        Severity::Error => "error",
        Severity::Warning => "warning",
        Severity::Note => "note",
    }
}

/// Selects a line and brings it into sight.
fn show(field: &HtmlTextAreaElement, text: &str, range: &Range<usize>, line: usize) {
    // The browser counts in UTF-16.
    let units = |end: usize| {
        let count = text.get(..end).map_or(0, |before| before.encode_utf16().count());
        u32::try_from(count).unwrap_or(u32::MAX)
    };
    // Refused only by an element that is no text field.
    let _ = field.set_selection_range(units(range.start), units(range.end));
    let _ = field.focus();
    let top = i32::try_from(line).unwrap_or(i32::MAX / LINE).saturating_mul(LINE);
    field.set_scroll_top((top - field.client_height() / 3).max(0));
    field.set_scroll_left(0);
    field.scroll_into_view_with_bool(false);
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn only_the_lines_in_sight_are_drawn() {
        let view = View { top: 0, left: 0, height: 180 };
        assert_eq!(in_sight(view, 1_000), 1..13);
        assert_eq!(in_sight(view, 3), 1..4);
        assert_eq!(in_sight(View { top: 17_900, ..view }, 1_000), 995..1001);
        assert!(in_sight(View { top: 99_999, ..view }, 10).is_empty());
    }
}
