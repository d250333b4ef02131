//! A row of the table of prices: its words, its stored values, and their sources.

use std::sync::LazyLock;

use anyhow::{Context, Result, ensure};
use manuscript::page::Page;
use manuscript::project::Project;
use regex_lite::Regex;

use crate::values::record::Records;
use crate::values::table;

/// The page, and its table.
pub const PAGE: &str = "docs/prices.md";
pub const TABLE: &str = "prices";

/// The column of the software driver; it follows the description and precedes the H200.
const SOFTWARE: usize = 1;

/// A ratio in the template: `{42_distant_spheres/spheres.stable.ratio:0.00}`, or `{1/22_solids/…}` for its inverse.
static RATIO: LazyLock<Regex> = LazyLock::new(|| {
    let pattern = r"^\{(1/)?([\w-]+/[\w-]+)\.([^{}|]+)\.ratio(?::[\d.]+)?\}$";
    Regex::new(pattern).expect("the pattern is right")
});

/// A link, of which a terminal shows only the text.
static LINK: LazyLock<Regex> =
    LazyLock::new(|| Regex::new(r"\[([^\]]*)\]\([^)]*\)").expect("the pattern is right"));

/// A row of the table.
#[derive(Clone, Debug, PartialEq)]
pub struct Row {
    /// A description of the ratio, as plain words.
    pub what: String,
    /// The ratios of the software driver and of the H200 as printed on the page.
    pub software: String,
    pub h200: String,
    /// The stored measurement, and the name of the value in it.
    pub record: String,
    pub value: String,
    /// True if the row shows the inverse of the stored value.
    pub inverted: bool,
}

impl Row {
    /// All rows, in the page's order.
    ///
    /// # Errors
    /// If the page has no such table, or a row contains no stored ratio.
    pub fn all(project: &Project, stored: &Records) -> Result<Vec<Self>> {
        let page = Page::parse(PAGE, &project.read(PAGE)?);
        let shown = table::body(project, &page, 1, TABLE, stored).map_err(|fault| fault.error())?;
        let template = table::template(project, &page, TABLE).context("it has just been read")?;
        let rows = template.lines().zip(shown.lines()).skip(2);
        rows.map(|(template, shown)| Self::of(template, shown)).collect()
    }

    /// The stored measurements of these rows, each once, in order.
    pub fn records<'a>(rows: &[&'a Self]) -> Vec<&'a str> {
        let mut records: Vec<&str> = Vec::new();
        for row in rows {
            if !records.contains(&&*row.record) {
                records.push(&row.record);
            }
        }
        records
    }

    fn of(template: &str, shown: &str) -> Result<Self> {
        let (template, shown) = (cells(template), cells(shown));
        let file = format!("docs/values/{TABLE}.md");
        ensure!(shown.len() > 2, "{file}: a row has too few cells: {}", shown.join(" | "));
        let name = &template[SOFTWARE];
        let ratio = RATIO.captures(name);
        let ratio = ratio.with_context(|| format!("{file}: '{name}' names no stored ratio"))?;
        Ok(Self {
            what: LINK.replace_all(&shown[0], "$1").into_owned(),
            software: shown[SOFTWARE].clone(),
            h200: shown[SOFTWARE + 1].clone(),
            record: ratio[2].to_owned(),
            value: ratio[3].to_owned(),
            inverted: ratio.get(1).is_some(),
        })
    }
}

/// The cells of a row of Markdown.
fn cells(row: &str) -> Vec<String> {
    let inner = row.trim().trim_start_matches('|').trim_end_matches('|');
    inner.split('|').map(|cell| cell.trim().to_owned()).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_row_names_the_value_that_it_shows() {
        let of = |software: &str| {
            let template =
                format!("| planes ([22](22.md)) | {software} | {{a/b.c.ratio}} | | why |");
            Row::of(&template, "| planes ([22](22.md)) | 1.10 | 1.57 | | why |")
        };
        let expected = Row {
            what: "planes (22)".to_owned(),
            software: "1.10".to_owned(),
            h200: "1.57".to_owned(),
            record: "22_solids/rungs".to_owned(),
            value: "point".to_owned(),
            inverted: true,
        };
        assert_eq!(of("{1/22_solids/rungs.point.ratio:0.00}").expect("a row"), expected);
        let plain = of("{22_solids/rungs.point.ratio}").expect("a row");
        assert_eq!(plain, Row { inverted: false, ..expected });
        assert!(of("1.10").is_err() && of("{rungs.point.ratio}").is_err());
    }
}
