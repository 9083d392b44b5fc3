//! What was found, in one list: each structure that was opened is followed by its members.

use std::rc::Rc;

use cipdeck_shared::{
    api::BrowsedSymbol,
    config::{NewVariable, VariableConfig, join_address},
};

use super::{Ticked, listing::Listing};
use crate::browser;

/// One line.
#[derive(Clone, Debug, PartialEq)]
pub(super) struct Found {
    /// As a variable takes it, with those of its parents.
    pub(super) address: String,
    /// The address of what it is a part of.
    pub(super) parent: Option<String>,
    /// As the device says it.
    pub(super) symbol: BrowsedSymbol,
    /// How many structures it is in.
    pub(super) depth: usize,
    /// Its members are shown.
    pub(super) is_open: bool,
}

/// Structures in structures, at most.
const DEEPEST: usize = 8;

/// Those whose name or type contains the text, with the members of those that are open.
pub(super) fn flat(listing: &Listing, filter: &str) -> Vec<Rc<Found>> {
    let mut all = Vec::new();
    let is_found = |symbol: &&BrowsedSymbol| {
        filter.trim().is_empty()
            || browser::contains(&symbol.name, filter)
            || browser::contains(&symbol.kind, filter)
    };
    for symbol in listing.symbols.iter().filter(is_found) {
        add(listing, symbol, None, 0, &mut all);
    }
    all
}

fn add(
    listing: &Listing,
    symbol: &BrowsedSymbol,
    parent: Option<&str>,
    depth: usize,
    all: &mut Vec<Rc<Found>>,
) {
    let address = join_address(parent.unwrap_or_default(), &symbol.name);
    let is_open = listing.open.get(&address).is_some();
    all.push(Rc::new(Found {
        address: address.clone(),
        parent: parent.map(str::to_owned),
        symbol: symbol.clone(),
        depth,
        is_open,
    }));
    let of = symbol.structure.as_ref().filter(|_| is_open && depth < DEEPEST);
    for member in of.and_then(|of| listing.types.get(of)).iter().flat_map(|of| &of.members) {
        add(listing, member, Some(&address), depth + 1, all);
    }
}

/// What is ticked, parents first: a member brings along what it is a part of. What the group has already is left out.
pub(super) fn new_variables(all: &[Rc<Found>], ticked: &Ticked, known: &[String]) -> Vec<NewVariable> {
    let mut added: Vec<String> = known.to_vec();
    let mut variables = Vec::new();
    for found in all.iter().filter(|found| ticked.get(&found.address).is_some()) {
        bring(all, found, &mut added, &mut variables);
    }
    variables
}

fn bring(all: &[Rc<Found>], found: &Found, added: &mut Vec<String>, variables: &mut Vec<NewVariable>) {
    if added.contains(&found.address) {
        return;
    }
    let parent = found.parent.as_ref().and_then(|parent| all.iter().find(|other| other.address == *parent));
    if let Some(parent) = parent {
        bring(all, parent, added, variables);
    }
    added.push(found.address.clone());
    let own = &found.symbol.name;
    let mut config = VariableConfig::new(own, own);
    // What is no structure has a type that says everything; that of a structure the device says again.
    if found.symbol.structure.is_none() {
        config.kind.clone_from(&found.symbol.kind);
    }
    variables.push(NewVariable { parent_address: found.parent.clone(), config });
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::store::Shelf;

    fn found(address: &str, parent: Option<&str>, name: &str) -> Rc<Found> {
        let symbol = BrowsedSymbol {
            name: name.to_owned(),
            kind: "REAL".to_owned(),
            structure: None,
            access: None,
            note: None,
        };
        let (address, parent) = (address.to_owned(), parent.map(str::to_owned));
        Rc::new(Found { address, parent, symbol, depth: 0, is_open: false })
    }

    #[test]
    fn a_member_brings_along_what_it_is_a_part_of() {
        let all = [
            found("stMotor", None, "stMotor"),
            found("stMotor.speed", Some("stMotor"), "speed"),
            found("stMotor.run", Some("stMotor"), "run"),
            found("TAG1", None, "TAG1"),
        ];
        let mut ticked = Shelf::default();
        for address in ["stMotor.run", "stMotor.speed", "TAG1"] {
            ticked.insert(address.to_owned(), ());
        }
        let names = |known: &[String]| {
            let new = new_variables(&all, &Rc::new(ticked.clone()), known);
            new.into_iter().map(|it| it.config.address).collect::<Vec<_>>()
        };
        assert_eq!(names(&[]), ["stMotor", "speed", "run", "TAG1"]);
        assert_eq!(names(&["stMotor".to_owned(), "TAG1".to_owned()]), ["speed", "run"]);
    }
}
