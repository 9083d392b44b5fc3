//! What is said about places in a text: each leads to its line.

use std::ops::Range;

use cipdeck_shared::{code::Remark, plan::Severity};
use yew::prelude::*;

use super::{
    super::{i18n::tr, say},
    desk::Desk,
};
use crate::invisible;

/// Remarks that are drawn for all texts together.
const MOST_SHOWN: usize = 200;

/// What belongs to no block, of all texts.
pub(super) fn rest(desk: &Desk, on_line: &Callback<(u32, usize)>) -> Html {
    let all: Vec<_> = desk
        .sources
        .iter()
        .flat_map(|source| source.imported.iter().flat_map(|it| &it.remarks).map(move |it| (source, it)))
        .collect();
    if all.is_empty() {
        return html! {};
    }
    let left = all.len().saturating_sub(MOST_SHOWN);
    let line = |(source, remark): &(&super::desk::Source, &Remark)| {
        let key = source.key;
        let on_line = on_line.reform(move |line| (key, line));
        html! {
            <li>
                if let Some(file) = source.file.as_ref().filter(|_| desk.sources.len() > 1) {
                    <span class="quiet">{ file }</span>
                }
                { said(remark, &on_line) }
            </li>
        }
    };
    html! {
        <section class="panel" data-test="rest">
            <h2>{ tr!("remarks.rest") }</h2>
            <ul class="code-remarks">{ for all.iter().take(MOST_SHOWN).map(line) }</ul>
            if left > 0 {
                <p class="hint">{ tr!("remarks.left", count = left) }</p>
            }
        </section>
    }
}

/// A remark: what it is, where, which text, and what is said.
pub(super) fn said(remark: &Remark, on_line: &Callback<usize>) -> Html {
    let (word, shape, class) = say::severity(remark.severity);
    let line = remark.line;
    let mark = match remark.severity {
        Severity::Error => "not-understood",
        Severity::Warning => "look-at",
        Severity::Note => "note",
    };
    html! {
        <div class="code-remark" data-test={mark} data-line={line.to_string()}>
            <span class={classes!("state", class)}>{ shape.draw() }<span>{ word }</span></span>
            <button type="button" class="tool" onclick={on_line.reform(move |_: MouseEvent| line)}>
                { tr!("remarks.at", line = line, column = remark.column) }
            </button>
            if !remark.excerpt.is_empty() {
                <code>{ invisible::shown(&remark.excerpt) }</code>
            }
            <span>{ remark.what.to_string() }</span>
        </div>
    }
}

/// A button that shows where a block is.
pub(super) fn to_line(lines: &Range<usize>, file: Option<&str>, on_line: &Callback<usize>) -> Html {
    let (from, to) = (lines.start, lines.end.saturating_sub(1));
    let place =
        if to <= from { tr!("found.line", line = from) } else { tr!("found.lines", from = from, to = to) };
    let words = match file {
        Some(file) => tr!("found.in_file", file = file, place = place),
        None => place,
    };
    let title = tr!("found.to_line", place = words);
    html! { <button type="button" class="tool" {title} onclick={on_line.reform(move |_: MouseEvent| from)} data-test="to-line">{ words }</button> }
}
