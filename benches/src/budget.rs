//! Counts against `budgets.toml`: a table of our cases in instructions per pixel, that of `mesh` too.

use std::fmt::Write as _;
use std::path::Path;

use toml_edit::{DocumentMut, Item, Table, value};

use crate::case::Case;
use crate::error::Error;
use crate::scene::PIXELS;

/// The file.
pub const FILE: &str = concat!(env!("CARGO_MANIFEST_DIR"), "/budgets.toml");

/// The table's name: first, and within that. `firmware/run` takes each table within
/// `instructions_per_pixel` for one of its cores.
const TABLE: (&str, &str) = ("host_instructions_per_pixel", "x86_64");

/// A count may be above its budget by this factor: compilers differ a little.
const TOLERANCE: f64 = 1.01;

/// What was counted for our cases: names and instructions per pixel.
pub type Counted = Vec<(String, f64)>;

/// From instructions a frame to a hundredth of an instruction per pixel.
#[must_use]
pub fn per_pixel(cases: &[Case], counts: &[u64]) -> Counted {
    let each = |count: &u64| (*count as f64 / PIXELS as f64 * 100.0).round() / 100.0;
    cases
        .iter()
        .map(Case::to_string)
        .zip(counts.iter().map(each))
        .collect()
}

/// A comparison of counts with budgets.
#[derive(Debug)]
pub struct Report {
    /// A line for each.
    pub text: String,
    /// How many are over their budget, have none, or were not counted.
    pub faults: usize,
}

/// Compares counts with the budgets in the text of a `budgets.toml`.
///
/// # Errors
///
/// [`Error::Content`] if the text is not TOML or a budget is not a number.
pub fn compare(budgets: &str, counted: &Counted) -> Result<Report, Error> {
    let document = parse(budgets)?;
    let limits = numbers(&document)?;
    let (mut text, mut faults) = (String::new(), 0);
    _ = writeln!(
        text,
        "{:<48} {:>8} {:>8}",
        "instructions per pixel", "counted", "budget"
    );
    for (name, count) in counted {
        let limit = limits
            .iter()
            .find(|limit| limit.0 == *name)
            .map(|limit| limit.1);
        let result = match limit {
            Some(limit) if *count <= limit * TOLERANCE => "within",
            Some(_) => "OVER",
            None => "NO BUDGET",
        };
        faults += usize::from(result != "within");
        let limit = limit.map_or_else(|| "-".to_owned(), |limit| format!("{limit:.2}"));
        _ = writeln!(text, "{name:<48} {count:>8.2} {limit:>8} {result}");
    }
    for (name, limit) in limits {
        if counted.iter().all(|count| count.0 != name) {
            faults += 1;
            _ = writeln!(text, "{name:<48} {:>8} {limit:>8.2} NOT COUNTED", "-");
        }
    }
    Ok(Report { text, faults })
}

/// The text of a `budgets.toml` with counts as budgets. All other tables stay as they are.
///
/// # Errors
///
/// [`Error::Content`] if the text is not TOML or the table's name has something else.
pub fn accept(budgets: &str, counted: &Counted) -> Result<String, Error> {
    let mut document = parse(budgets)?;
    let group = document
        .entry(TABLE.0)
        .or_insert_with(|| {
            let mut group = Table::new();
            group.set_implicit(true);
            Item::Table(group)
        })
        .as_table_mut()
        .ok_or_else(|| Error::content(TABLE.0, "is not a table"))?;
    let table = group
        .entry(TABLE.1)
        .or_insert_with(|| Item::Table(Table::new()))
        .as_table_mut()
        .ok_or_else(|| Error::content(TABLE.1, "is not a table"))?;
    table.clear();
    for (name, count) in counted {
        table.insert(name, value(*count));
    }
    Ok(document.to_string())
}

/// Reads the file.
///
/// # Errors
///
/// [`Error::Read`].
pub fn read() -> Result<String, Error> {
    std::fs::read_to_string(FILE).map_err(|e| Error::read(Path::new(FILE), &e))
}

fn parse(budgets: &str) -> Result<DocumentMut, Error> {
    budgets
        .parse()
        .map_err(|e| Error::content("budgets.toml", &e))
}

/// The table's keys and numbers; none if there is no table.
fn numbers(document: &DocumentMut) -> Result<Counted, Error> {
    let table = document.get(TABLE.0).and_then(|group| group.get(TABLE.1));
    let Some(table) = table.and_then(Item::as_table) else {
        return Ok(Vec::new());
    };
    table
        .iter()
        .map(|(name, item)| {
            let number = item
                .as_float()
                .or_else(|| item.as_integer().map(|i| i as f64));
            let number =
                number.ok_or_else(|| Error::content(name, "has a budget that is no number"))?;
            Ok((name.to_owned(), number))
        })
        .collect()
}

#[cfg(test)]
mod tests {
    use super::{accept, compare};

    const BUDGETS: &str = "# Kept.\n[bytes.m4]\ntext = 1 # as it is\n\n# Ours.\n\
                           [host_instructions_per_pixel.x86_64]\n\"wall a\" = 10.0\n\"wall b\" = 20\n";

    fn counted(a: f64, b: f64) -> super::Counted {
        vec![("wall a".to_owned(), a), ("wall b".to_owned(), b)]
    }

    fn faults(counted: &super::Counted) -> Option<usize> {
        compare(BUDGETS, counted).ok().map(|report| report.faults)
    }

    #[test]
    fn one_percent_more_is_within_and_above_that_is_over() {
        assert_eq!(faults(&counted(10.1, 20.2)), Some(0));
        assert_eq!(faults(&counted(10.11, 20.2)), Some(1));
        assert_eq!(faults(&counted(10.11, 20.21)), Some(2));
    }

    #[test]
    fn a_count_without_budget_and_a_budget_without_count_are_faults() {
        assert_eq!(faults(&vec![("wall c".to_owned(), 1.0)]), Some(3));
    }

    #[test]
    fn accepting_changes_one_table() {
        let text = accept(BUDGETS, &counted(9.5, 30.25)).unwrap_or_default();
        let expected = BUDGETS.replace("10.0", "9.5").replace("= 20", "= 30.25");
        assert_eq!(text, expected);
        assert_eq!(
            compare(&text, &counted(9.5, 30.25)).ok().map(|r| r.faults),
            Some(0)
        );
    }

    #[test]
    fn what_is_no_number_is_refused() {
        let text = BUDGETS.replace("10.0", "\"many\"");
        assert!(compare(&text, &counted(1.0, 1.0)).is_err());
        assert!(compare("[", &counted(1.0, 1.0)).is_err());
        assert!(accept("[", &counted(1.0, 1.0)).is_err());
    }
}
