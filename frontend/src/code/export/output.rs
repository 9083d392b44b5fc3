//! A block in one dialect: what changes, the code, and how to take it.

use std::rc::Rc;

use cipdeck_shared::{
    code::{Dialect, Language, Options, export},
    config::Block,
};
use yew::prelude::*;

use super::super::{changes::changes, i18n::tr, lines::Lines, say, sheet::CodeSheet};
use crate::browser;

#[derive(Clone, PartialEq, Properties)]
pub(super) struct OutputProps {
    pub(super) block: Rc<Block>,
    pub(super) dialect: Dialect,
    pub(super) language: Language,
}

/// The table of changes above the code, so that nobody takes one without the other.
#[component]
pub(super) fn Output(props: &OutputProps) -> Html {
    let (dialect, name) = (props.dialect, props.block.config.name());
    let code = use_memo(props.clone(), |props| {
        export(&props.block.config, props.dialect, &Options { language: props.language })
    });
    let lines = use_memo((code.clone(), dialect), |(code, dialect)| {
        Lines::in_one(&code.text.trim_end_matches('\n').into(), *dialect)
    });
    let said = use_state_eq(|| None::<AttrValue>);
    use_effect_with(code.clone(), {
        let said = said.setter();
        move |_| said.set(None)
    });
    let on_copy = {
        let (said, code) = (said.setter(), code.clone());
        move |_: MouseEvent| {
            let said = said.clone();
            browser::copy(&code.text, move |done| {
                said.set(Some(if done { tr!("take.copied") } else { tr!("take.copy_refused") }));
            });
        }
    };
    let title = tr!("take.code_of", name = name, dialect = say::dialect(dialect));
    let file = file_name(name, dialect);
    html! {
        <section class="code-output" data-test="output" data-dialect={dialect.name()}>
            <p class="lead">{ dialect.title() }</p>
            { changes(&code.changes) }
            if code.text.trim().is_empty() {
                <p class="finding error" data-test="no-code">{ tr!("take.no_code") }</p>
            } else {
                <div class="code-tools">
                    <span class="mono quiet" data-test="file-name">{ &file }</span>
                    <span class="spring" />
                    <span role="status" class="hint">{ (*said).clone().unwrap_or_default() }</span>
                    <button type="button" class="button" onclick={on_copy} data-test="copy">{ tr!("take.copy") }</button>
                    <a class="button primary link" href={download(&code.text)} download={file.clone()} data-test="download">{ tr!("take.download") }</a>
                </div>
                <CodeSheet label={title} {lines} />
            }
        </section>
    }
}

/// The code as an address that a browser stores as a file.
fn download(text: &str) -> String {
    format!("data:text/plain;charset=utf-8,{}", js_sys::encode_uri_component(text))
}

/// `drive-name.L5X`: the block's name in letters that every file system takes.
fn file_name(name: &str, dialect: Dialect) -> String {
    let is_safe = |c: char| c.is_ascii_alphanumeric() || matches!(c, '-' | '_');
    let short: String = name.chars().take(MAX_NAME).collect();
    // One underscore for all that lies between two parts.
    let parts: Vec<_> = short.split(|c| !is_safe(c)).filter(|part| !part.is_empty()).collect();
    let name = if parts.is_empty() { "block".to_owned() } else { parts.join("_") };
    format!("{name}.{}", dialect.file_ending())
}

/// Characters of a block's name in a file's name.
const MAX_NAME: usize = 60;

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_file_is_named_after_its_block() {
        assert_eq!(file_name("drive-name", Dialect::L5x), "drive-name.L5X");
        assert_eq!(file_name("../a b\u{202e}é", Dialect::Pycomm3), "a_b.py");
        assert_eq!(file_name("write \"speed\" */ (* <b> & x", Dialect::CcwSt), "write_speed_b_x.st");
        assert_eq!(file_name(" ", Dialect::Hex), "block.txt");
        assert!(file_name(&"x".repeat(500), Dialect::Json).len() < 70);
    }
}
