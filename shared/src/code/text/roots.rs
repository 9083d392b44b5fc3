//! Which variables a statement is about, and the statements that are about no message.

use alloc::collections::BTreeSet;
use alloc::string::String;
use alloc::vec::Vec;

use super::script::{Item, Script};
use super::syntax::{Argument, Expression, Reference, Statement, Step};
use crate::code::remark::{Remark, RemarkKind};
use crate::plan::Severity;

/// What belongs to no message: one remark for each run of such statements. A statement belongs to a message if it
/// has one of its variables in it, or one that such an assignment has.
pub(in crate::code) fn left_over(
    script: &Script<'_>,
    mut names: BTreeSet<String>,
    severity: Severity,
) -> Vec<Remark> {
    let roots: Vec<Vec<String>> = script.items.iter().map(roots).collect();
    let is_used = |names: &BTreeSet<String>, of: &[String]| of.iter().any(|name| names.contains(name));
    for _ in 0..2 {
        for (item, of) in script.items.iter().zip(&roots) {
            if matches!(item.statement, Statement::Assignment { .. }) && is_used(&names, of) {
                names.extend(of.iter().cloned());
            }
        }
    }
    let mut remarks: Vec<Remark> = Vec::new();
    let mut before = true;
    for (item, of) in script.items.iter().zip(&roots) {
        let used = is_used(&names, of);
        if !used && before {
            let what = RemarkKind::Told("statements that belong to no message begin here, left out".into());
            let (line, column) = (item.place.line, item.place.column);
            remarks.push(Remark { severity, ..Remark::error(line, column, script.source(item), what) });
        }
        before = used;
    }
    remarks
}

/// The variables of a statement, in lower case.
pub(in crate::code) fn roots(item: &Item<'_>) -> Vec<String> {
    let mut names = Vec::new();
    match &item.statement {
        Statement::Declaration(declaration) => {
            names.extend(declaration.names.iter().map(|(name, _)| name.to_ascii_lowercase()));
        }
        Statement::Assignment { target, value } => {
            of_reference(target, &mut names);
            of_expression(value, &mut names);
        }
        Statement::Call(call) => {
            of_reference(&call.name, &mut names);
            of_arguments(&call.arguments, &mut names);
        }
    }
    names
}

fn of_reference(reference: &Reference<'_>, names: &mut Vec<String>) {
    names.push(reference.root.to_ascii_lowercase());
    for step in &reference.steps {
        if let Step::Index(indexes) = step {
            of_expressions(indexes, names);
        }
    }
}

fn of_arguments(arguments: &[Argument<'_>], names: &mut Vec<String>) {
    for argument in arguments {
        if let Some(value) = &argument.value {
            of_expression(value, names);
        }
    }
}

fn of_expressions(expressions: &[Expression<'_>], names: &mut Vec<String>) {
    for expression in expressions {
        of_expression(expression, names);
    }
}

fn of_expression(expression: &Expression<'_>, names: &mut Vec<String>) {
    match expression {
        Expression::Literal(..) => {}
        Expression::Reference(reference) => of_reference(reference, names),
        Expression::Call(call) => of_arguments(&call.arguments, names),
        Expression::List(values, _)
        | Expression::Repeated(_, values, _)
        | Expression::Chain(values, _, _) => {
            of_expressions(values, names);
        }
        Expression::Structure(members, _) => {
            for (_, value) in members {
                of_expression(value, names);
            }
        }
        Expression::Unary(_, value, _) => of_expression(value, names),
    }
}
