//! Code out: a block in every dialect, what of it a dialect cannot say, and the block as one of another kind.

mod another;
mod choice;
mod output;
mod pair;

use std::rc::Rc;

use cipdeck_shared::{
    code::{Dialect, Kind, Language},
    config::{Block, BlockId},
};
use yew::prelude::*;

use self::{another::Another, choice::choice, output::Output};
use super::{facts::place, i18n::tr};
use crate::{
    address::{self, use_path},
    hooks::use_title,
    office::{fetch::use_fetched, kit::waiting},
};

#[derive(Clone, PartialEq, Properties)]
pub(super) struct ExportPageProps {
    pub(super) id: BlockId,
}

/// The page of one block. The dialect is in the address, so that a link leads to it.
#[component]
pub(super) fn ExportPage(props: &ExportPageProps) -> Html {
    let fetched = use_fetched::<Block>(format!("blocks/{}", props.id));
    let language = use_state(Language::default);
    // Renders again when the dialect in the address changes.
    let path = use_path();
    let name = fetched.data.as_ref().map(|block| block.config.name().to_owned());
    use_title(name.as_deref().unwrap_or_default());
    let Some(block) = fetched.data.clone() else {
        return html! { <div class="code-page"><h1>{ tr!("take.title") }</h1>{ waiting(&fetched) }</div> };
    };
    let named = address::query().strip_prefix("?as=").and_then(|name| name.parse().ok());
    let dialect = named.unwrap_or_else(|| of_its_kind(&block));
    let on_dialect = Callback::from(move |dialect: Dialect| {
        address::replace(&format!("{path}?as={}", dialect.name()));
    });
    html! {
        <div class="code-page">
            { head(&block) }
            <div class="code-out">
                { choice(dialect, *language, &on_dialect, &language.setter()) }
                <Output block={block.clone()} {dialect} language={*language} />
            </div>
            <Another {block} />
        </div>
    }
}

fn head(block: &Rc<Block>) -> Html {
    html! {
        <div class="page-head">
            <h1>{ block.config.name().to_owned() }</h1>
            <span class="pill">{ Kind::of(&block.config).to_string() }</span>
            <span class="quiet mono">{ block.config.target_text().to_owned() }</span>
            <span class="page-do"><a class="button link" href={place(Kind::of(&block.config), block.id)}>{ tr!("take.open") }</a></span>
        </div>
    }
}

/// Where the block comes from, so to speak.
fn of_its_kind(block: &Block) -> Dialect {
    match Kind::of(&block.config) {
        Kind::MsgCipGeneric => Dialect::CcwSt,
        Kind::SendReqEtc100 => Dialect::SendReqEtc100,
        Kind::SendReqEtc101 => Dialect::SendReqEtc101,
        Kind::DataExch => Dialect::DataExch,
    }
}
