//! Code on a sheet: line numbers, colours, marks. It is only read.

use std::rc::Rc;

use cipdeck_shared::code::Ink;
use yew::prelude::*;

use super::lines::Lines;

/// A sheet.
#[derive(Clone, Debug, PartialEq, Properties)]
pub struct CodeSheetProps {
    /// What this is the code of.
    pub label: AttrValue,
    /// The code.
    pub lines: Rc<Lines>,
}

/// Numbers are drawn by the style sheet, so that a copy by hand holds the code alone.
#[component]
pub fn CodeSheet(props: &CodeSheetProps) -> Html {
    let line = |number: usize| {
        html! {
            <code key={number} class="code-line" data-line={number.to_string()}>{ ink(&props.lines, number) }{ "\n" }</code>
        }
    };
    html! {
        <pre class="code-sheet" tabindex="0" role="region" aria-label={props.label.clone()} data-test="code">
            { for (1..=props.lines.count()).map(line) }
        </pre>
    }
}

/// The coloured parts of a line from 1.
pub(super) fn ink(lines: &Lines, line: usize) -> Html {
    let part = |(ink, text): (Option<Ink>, &str)| match ink {
        None => html! { { text.to_owned() } },
        Some(ink) => html! { <span class={class(ink)}>{ text.to_owned() }</span> },
    };
    html! { <>{ for lines.parts(line).into_iter().map(part) }</> }
}

const fn class(ink: Ink) -> &'static str {
    match ink {
        Ink::Keyword => "ink-keyword",
        Ink::Comment => "ink-comment",
        Ink::Number => "ink-number",
        Ink::Text => "ink-text",
        Ink::Name => "ink-name",
    }
}
