//! Tests of the whole relay that need its inside: the decision can be replaced, to show what it is good for.

mod attacks;
mod cyclic;
mod matrix;
mod site;
