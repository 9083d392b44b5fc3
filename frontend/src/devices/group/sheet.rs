//! Lines of a spreadsheet or of a CSV file as variables, with what is wrong with each.

use cipdeck_shared::{
    config::{NewVariable, Variable, join_address},
    plan::plant,
    tag::Types,
};
use yew::AttrValue;

use super::draft::{VariableDraft, Wrong};
use crate::devices::i18n::tr;

/// A pasted table.
#[derive(Clone, Debug, Default, PartialEq)]
pub(super) struct Sheet {
    /// The columns that were understood, by member; of the others their headings.
    pub(super) columns: Vec<Column>,
    /// One per line.
    pub(super) rows: Vec<SheetRow>,
}

/// A column and what it means.
#[derive(Clone, Debug, PartialEq, Eq)]
pub(super) enum Column {
    /// A member of a variable.
    Member(&'static str),
    /// A heading that means nothing here.
    Unknown(String),
}

/// One line.
#[derive(Clone, Debug, PartialEq)]
pub(super) struct SheetRow {
    /// Counted from 1, as spreadsheets do.
    pub(super) number: usize,
    /// As they were pasted, by column.
    pub(super) cells: Vec<String>,
    /// With its parent's.
    pub(super) address: String,
    /// What is to be added.
    pub(super) variable: Option<NewVariable>,
    /// What is wrong with it.
    pub(super) wrong: Vec<Wrong>,
}

/// Columns without a heading, in this order.
const ORDER: [&str; 10] =
    ["name", "address", "type", "unit", "factor", "offset", "digits", "writable", "min", "max"];

/// Every member, and what spreadsheets call it.
const MEMBERS: [(&str, &[&str]); 14] = [
    ("parent", &["parent_address", "structure", "array"]),
    ("name", &["variable", "tag name"]),
    ("address", &["tag", "variable address"]),
    ("type", &["data type", "datatype", "kind"]),
    ("unit", &["units", "eu"]),
    ("factor", &["scale", "gain"]),
    ("offset", &[]),
    ("digits", &["decimals"]),
    ("display", &["format"]),
    ("choices", &["enum", "states"]),
    ("writable", &["write", "access"]),
    ("min", &["minimum", "low"]),
    ("max", &["maximum", "high"]),
    ("order", &[]),
];

impl Sheet {
    /// Reads what was pasted. `known` has the addresses that the group has already.
    pub(super) fn read(text: &str, known: &[String]) -> Self {
        let mut cells =
            cells(text).into_iter().filter(|(_, row)| row.iter().any(|cell| !cell.is_empty())).peekable();
        let heading = cells.peek().and_then(|(_, row)| columns(row));
        if heading.is_some() {
            cells.next();
        }
        let rows: Vec<_> = cells.collect();
        let widest = rows.iter().map(|(_, row)| row.len()).max().unwrap_or(0);
        let columns = heading.unwrap_or_else(|| without_heading(widest));
        let mut sheet = Self { columns, rows: Vec::with_capacity(rows.len()) };
        let mut taken: Vec<String> = known.to_vec();
        taken.sort_unstable();
        for (number, cells) in rows {
            let row = sheet.row(number, cells, &mut taken);
            sheet.rows.push(row);
        }
        sheet
    }

    /// Those that can be added, in their order.
    pub(super) fn good(&self) -> Vec<NewVariable> {
        self.rows.iter().filter_map(|row| row.variable.clone()).collect()
    }

    /// With what the relay would find: the same rules.
    pub(super) fn checked(mut self, there: &[Variable], types: &Types) -> Self {
        let places: Vec<_> = self
            .rows
            .iter()
            .enumerate()
            .filter(|(_, row)| row.variable.is_some())
            .map(|(place, _)| place)
            .collect();
        let Err(findings) = plant::added(there, &self.good(), types, |number| number.to_string()) else {
            return self;
        };
        for finding in findings {
            let at = finding
                .field
                .split_once('.')
                .and_then(|(number, field)| Some((number.parse::<usize>().ok()?, field)));
            let row = at.and_then(|(number, _)| self.rows.get_mut(*places.get(number)?)).or(None);
            let field = at
                .and_then(|(_, field)| MEMBERS.iter().find(|(name, _)| *name == field))
                .map_or("line", |(name, _)| name);
            // What is wrong with all of them together is told by the relay.
            if let Some(row) = row {
                row.variable = None;
                row.wrong.push((field, finding.rule.to_string().into()));
            }
        }
        self
    }

    fn row(&self, number: usize, cells: Vec<String>, taken: &mut Vec<String>) -> SheetRow {
        let mut draft = VariableDraft::default();
        let mut parent = String::new();
        for (cell, column) in cells.iter().zip(&self.columns) {
            match column {
                Column::Member("parent") => plain(cell).clone_into(&mut parent),
                Column::Member(member) => {
                    if let Some(text) = draft.member(member) {
                        plain(cell).clone_into(text);
                    }
                }
                Column::Unknown(_) => {}
            }
        }
        if draft.address.is_empty() && !self.has("address") {
            // One column of names: they are the addresses.
            draft.address.clone_from(&draft.name);
        }
        let address = join_address(&parent, &draft.address);
        let mut wrong = Vec::new();
        let config = draft.read(None).map_err(|found| wrong = found).ok();
        if cells.len() > self.columns.len() {
            wrong.push(("line", tr!("sheet.too_many", count = cells.len(), columns = self.columns.len())));
        }
        if !parent.is_empty() && taken.binary_search(&parent).is_err() {
            wrong.push(("parent", tr!("sheet.no_parent", parent = parent)));
        }
        match taken.binary_search(&address) {
            Ok(_) => wrong.push(("address", tr!("sheet.twice", address = address))),
            Err(place) if !address.is_empty() => taken.insert(place, address.clone()),
            Err(_) => {}
        }
        let parent_address = (!parent.is_empty()).then_some(parent);
        let variable =
            config.filter(|_| wrong.is_empty()).map(|config| NewVariable { parent_address, config });
        SheetRow { number, cells, address, variable, wrong }
    }

    fn has(&self, member: &str) -> bool {
        self.columns.iter().any(|column| matches!(column, Column::Member(of) if *of == member))
    }
}

/// Our own files have an apostrophe in front of what a spreadsheet would take for a formula.
fn plain(cell: &str) -> &str {
    cell.strip_prefix('\'').filter(|rest| rest.starts_with(['=', '+', '-', '@'])).unwrap_or(cell)
}

/// The columns, if a line is a heading: it names an address or a name, and no two columns mean the same.
fn columns(row: &[String]) -> Option<Vec<Column>> {
    let found: Vec<_> = row.iter().map(|cell| column(cell)).collect();
    let is_heading = found.iter().any(|column| matches!(column, Column::Member("address" | "name")));
    let members: Vec<_> = found.iter().filter(|column| matches!(column, Column::Member(_))).collect();
    let is_unique = members.iter().enumerate().all(|(place, column)| !members[..place].contains(column));
    (is_heading && is_unique).then_some(found)
}

fn column(heading: &str) -> Column {
    let heading = heading.trim();
    let is_called = |name: &str| name.eq_ignore_ascii_case(heading);
    let member =
        MEMBERS.iter().find(|(name, others)| is_called(name) || others.iter().any(|name| is_called(name)));
    member.map_or_else(|| Column::Unknown(heading.to_owned()), |(name, _)| Column::Member(name))
}

/// One column has addresses, two have names and addresses, and so on.
fn without_heading(count: usize) -> Vec<Column> {
    match count {
        0 | 1 => vec![Column::Member("address")],
        _ => ORDER.iter().take(count).map(|name| Column::Member(name)).collect(),
    }
}

/// The cells of each line, with its number. Spreadsheets separate by tabs; files by commas or semicolons, and put a cell
/// in quotes that has one of these in it.
fn cells(text: &str) -> Vec<(usize, Vec<String>)> {
    let text = text.strip_prefix('\u{FEFF}').unwrap_or(text);
    let separator = separator(text);
    let mut rows = Vec::new();
    let (mut row, mut cell) = (Vec::new(), String::new());
    let (mut number, mut begin, mut quoted) = (1, 1, false);
    let mut characters = text.chars().peekable();
    while let Some(character) = characters.next() {
        match character {
            '"' if quoted && characters.peek() == Some(&'"') => {
                characters.next();
                cell.push('"');
            }
            '"' if quoted => quoted = false,
            '"' if cell.is_empty() => quoted = true,
            '\n' if !quoted => {
                row.push(std::mem::take(&mut cell).trim().to_owned());
                rows.push((begin, std::mem::take(&mut row)));
                number += 1;
                begin = number;
            }
            '\r' if !quoted => {}
            other if other == separator && !quoted => row.push(std::mem::take(&mut cell).trim().to_owned()),
            other => {
                number += usize::from(other == '\n');
                cell.push(other);
            }
        }
    }
    row.push(cell.trim().to_owned());
    rows.push((begin, row));
    rows
}

/// A tab if there is one in the first line; otherwise what there is more of. An address may have a comma in it.
fn separator(text: &str) -> char {
    let first = text.lines().find(|line| !line.trim().is_empty()).unwrap_or_default();
    let count = |wanted: char| first.matches(wanted).count();
    if count('\t') > 0 {
        return '\t';
    }
    match (count(';'), count(',')) {
        (0, 0) => '\t',
        (semicolons, commas) if semicolons >= commas => ';',
        // `Arr[1,2]` is one cell.
        _ if first.find('[').zip(first.find(',')).is_some_and(|(bracket, comma)| bracket < comma) => '\t',
        _ => ',',
    }
}

/// What is wrong with a line, in words.
pub(super) fn words(wrong: &[Wrong]) -> AttrValue {
    let each: Vec<_> = wrong
        .iter()
        .map(|(field, words)| tr!("finding_at", field = field, words = words).to_string())
        .collect();
    each.join(" ").into()
}

#[cfg(test)]
mod tests {
    use cipdeck_shared::config::{Choice, GroupId, Scale, ValueDisplay, VariableConfig, VariableId};

    use super::*;

    fn read(text: &str) -> Sheet {
        Sheet::read(text, &["stMotor".to_owned()])
    }

    fn addresses(sheet: &Sheet) -> Vec<&str> {
        sheet.rows.iter().map(|row| row.address.as_str()).collect()
    }

    #[test]
    fn columns_of_addresses_need_no_heading() {
        let sheet = read("TAG1\r\nTAG2\n\nArr[1,2]\n");
        assert_eq!(addresses(&sheet), ["TAG1", "TAG2", "Arr[1,2]"]);
        assert_eq!((sheet.good().len(), sheet.rows[2].number), (3, 4), "an empty line counts as a line");
        assert_eq!(sheet.good()[0].config.name, "TAG1");
        let sheet = read("Level\tgrHWCs_PV\tREAL\tmm");
        let config = &sheet.good()[0].config;
        assert_eq!(
            (config.name.as_str(), config.unit.as_str(), config.kind.as_str()),
            ("Level", "mm", "REAL")
        );
    }

    #[test]
    fn a_heading_may_name_columns_in_any_order() {
        let sheet = read(
            "Address;Remark;NAME;Data Type;writable\nTAG1;first;one;BOOL;yes\nTAG2;\"a; b\";\"\"\"two\"\"\";;",
        );
        assert_eq!(sheet.columns[1], Column::Unknown("Remark".to_owned()));
        let good = sheet.good();
        assert_eq!((good[0].config.kind.as_str(), good[0].config.writable), ("BOOL", true));
        assert_eq!(good[1].config.name, "\"two\"");
    }

    #[test]
    fn a_part_needs_what_it_is_a_part_of() {
        let sheet = read("parent\taddress\n\tarTemp\narTemp\t[3]\nstMotor\tspeed\nnoSuch\tx");
        assert_eq!(addresses(&sheet), ["arTemp", "arTemp[3]", "stMotor.speed", "noSuch.x"]);
        assert_eq!(sheet.good().len(), 3);
        assert_eq!(sheet.rows[3].wrong[0].0, "parent");
    }

    #[test]
    fn what_is_wrong_is_told_line_by_line() {
        let sheet = read("name,address,min,max\na,TAG1,0,1\nb,TAG1,0,1\nc,,0,1\nd,TAG2,x,1\ne,TAG3,0,1,9");
        let wrong: Vec<_> = sheet.rows.iter().map(|row| row.wrong.first().map(|(field, _)| *field)).collect();
        assert_eq!(wrong, [None, Some("address"), Some("address"), Some("min"), Some("line")]);
        assert!(words(&sheet.rows[3].wrong).contains("min"));
    }

    #[test]
    fn what_the_relay_would_refuse_is_told_before() {
        let sheet = read("address\ttype\nTAG1\tBOOL\nno name!\tREAL\nTAG2\tNOTYPE\n'-x\tINT")
            .checked(&[], &Types::default());
        let wrong: Vec<_> = sheet.rows.iter().map(|row| row.wrong.first().map(|(field, _)| *field)).collect();
        assert_eq!(wrong[0], None);
        assert_eq!(wrong[2], Some("type"), "{wrong:?}");
        assert_eq!(sheet.rows[3].address, "-x");
    }

    #[test]
    fn what_is_exported_can_be_pasted() {
        let variable = |id, config| Variable { id: VariableId(id), revision: 1, group: GroupId(1), config };
        let mode = VariableConfig {
            parent: Some(VariableId(2)),
            kind: "INT".to_owned(),
            scale: Some(Scale { factor: 0.1, offset: -5.0 }),
            unit: "°C".to_owned(),
            digits: Some(1),
            display: ValueDisplay::Hex,
            choices: vec![
                Choice { value: 0, text: "off, cold".to_owned() },
                Choice { value: 1, text: "on".to_owned() },
            ],
            writable: true,
            min: Some(-0.5),
            max: Some(99.5),
            order: 2,
            ..VariableConfig::new("=mode; \"quoted\"", "mode")
        };
        let all = [
            variable(1, VariableConfig::new("PV", "grHWCs_PV")),
            variable(2, VariableConfig::new("line", "stLine")),
            variable(3, mode.clone()),
        ];
        let sheet = read(&plant::write_csv(&all)).checked(&[], &Types::default());
        assert!(
            sheet.columns.iter().all(|column| matches!(column, Column::Member(_))),
            "{:?}",
            sheet.columns
        );
        let good = sheet.good();
        assert_eq!(good.len(), 3, "{:?}", sheet.rows);
        assert_eq!(good[0].config, all[0].config);
        let part = good.iter().find(|new| new.parent_address.as_deref() == Some("stLine")).expect("the part");
        assert_eq!(part.config, VariableConfig { parent: None, ..mode });
    }

    #[test]
    fn nothing_is_nothing() {
        for text in ["", "\n\n", "\t\t\n", "\u{FEFF}"] {
            assert_eq!(read(text).rows.len(), 0, "{text:?}");
        }
        let sheet = read("\"never closed\nx");
        assert_eq!(sheet.rows.len(), 1);
    }
}
