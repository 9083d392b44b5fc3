//! What kind of variable is added: the document's three ways.

use yew::prelude::*;

use crate::devices::i18n::tr;

/// A variable by itself, or one whose parts follow.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Shape {
    /// One value.
    Plain,
    /// Its members follow.
    Structure,
    /// Its elements follow.
    Array,
}

/// One of three.
pub(super) fn chooser(shape: &UseStateHandle<Shape>) -> Html {
    let entry = |of: Shape, id: &'static str, words: AttrValue| {
        let set = shape.setter();
        html! {
            <span class="check-line">
                <input {id} type="radio" name="shape" class="check" checked={**shape == of} onchange={move |_: Event| set.set(of)} />
                <label for={id}>{ words }</label>
            </span>
        }
    };
    html! {
        <fieldset class="shapes">
            <legend class="unseen">{ tr!("shape.label") }</legend>
            { entry(Shape::Plain, "shape-plain", tr!("shape.plain")) }
            { entry(Shape::Structure, "shape-structure", tr!("shape.structure")) }
            { entry(Shape::Array, "shape-array", tr!("shape.array")) }
        </fieldset>
    }
}
