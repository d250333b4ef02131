//! A report card's prices: what accuracy costs on its device.

use anyhow::Result;
use serde::{Deserialize, Serialize};
use time_limit::Limit;

use crate::prices::row::Row;
use crate::prices::timing::{Quartiles, Timing};
use crate::programs::program::Programs;
use crate::values::record::{Record, Records};

/// Rounds of each comparison, as many as `cargo chapters prices` has.
const ROUNDS: u32 = 9;

/// A row of `docs/prices.md`, measured on the card's device.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Price {
    /// Its description.
    pub what: String,
    /// Time of the accurate way over that of the simple one: the median of all rounds, and the quartiles.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub ratio: Option<f64>,
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub quartiles: Option<[f64; 2]>,
    /// The reason why there is no ratio.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub failed: Option<String>,
}

/// The rows of the page, and the stored measurements they come from.
pub struct PriceList {
    rows: Vec<Row>,
    stored: Records,
}

impl PriceList {
    /// The rows; none if the project has no such page.
    pub fn new(programs: &Programs) -> Self {
        let (stored, _) = Record::all(programs.project);
        let rows = Row::all(programs.project, &stored).unwrap_or_default();
        Self { rows, stored }
    }

    /// The stored measurements, in the page's order.
    pub fn records(&self) -> Vec<String> {
        let rows: Vec<&Row> = self.rows.iter().collect();
        Row::records(&rows).into_iter().map(str::to_owned).collect()
    }

    /// Measures the rows of one stored measurement. A row that this device cannot run has the reason.
    pub fn measure(
        &self,
        programs: &Programs,
        record: &str,
        device: Option<&str>,
        limit: Limit,
        told: impl Fn(&anyhow::Error) -> String,
    ) -> Vec<Price> {
        let rows: Vec<&Row> = self.rows.iter().filter(|row| row.record == record).collect();
        let timing = Timing { programs, stored: &self.stored, rounds: ROUNDS, device, limit };
        let measured: Result<Vec<Quartiles>> =
            timing.measure(record, &rows).map(|timed| timed.ratios);
        let price = |(index, row): (usize, &&Row)| {
            let what = row.what.clone();
            match &measured {
                Ok(ratios) => {
                    let Quartiles { low, median, high } = ratios[index];
                    let quartiles = Some([low, high]);
                    Price { what, ratio: Some(median), quartiles, failed: None }
                }
                Err(why) => Price { what, failed: Some(told(why)), ..Price::default() },
            }
        };
        rows.iter().enumerate().map(price).collect()
    }
}

/// The ratios in a line.
pub fn told(prices: &[Price]) -> String {
    let result = |price: &Price| match (&price.failed, price.ratio) {
        (Some(why), _) => why.clone(),
        (None, ratio) => format!("{:.2}", ratio.unwrap_or_default()),
    };
    let mut results: Vec<String> = prices.iter().map(result).collect();
    results.dedup();
    results.join(", ")
}
