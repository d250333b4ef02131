//! The errors of t, and the rays whose hit or miss is wrong.

use reference::ulp::ulp_error;

/// Errors of t in ULP, and rays whose hit or miss is wrong.
#[derive(Default)]
pub struct Errors {
    pub ulp: Vec<f64>,
    pub rays: usize,
    pub false_hits: usize,
    pub false_misses: usize,
}

impl Errors {
    pub fn add(&mut self, t: Option<f32>, exact: Option<f64>) {
        self.rays += 1;
        match (t, exact) {
            (Some(t), Some(exact)) => self.ulp.push(ulp_error(t, exact)),
            (Some(_), None) => self.false_hits += 1,
            (None, Some(_)) => self.false_misses += 1,
            (None, None) => {}
        }
    }

    /// The error below which this fraction of the hits stays.
    pub fn at(&self, part: f64) -> f64 {
        let mut sorted = self.ulp.clone();
        sorted.sort_by(f64::total_cmp);
        let place = (sorted.len() as f64 * part) as usize;
        sorted.get(place).or(sorted.last()).copied().unwrap_or(0.0)
    }

    /// The figures of a row of the page's table; rays are counted as fractions of all.
    pub fn values(&self) -> [(&'static str, f64); 5] {
        let part = |count: usize| count as f64 / self.rays as f64;
        let [p50, p99, max] = [0.5, 0.99, 1.0].map(|part| self.at(part));
        let [hits, misses] = [self.false_hits, self.false_misses].map(part);
        [("p50", p50), ("p99", p99), ("max", max), ("false_hits", hits), ("false_misses", misses)]
    }

    /// A row of the page's table.
    pub fn row(&self) -> String {
        format!(
            "{:.1} | {:.1} | {:.0} | {:.2} % | {:.2} %",
            self.at(0.5),
            self.at(0.99),
            self.at(1.0),
            self.percent(self.false_hits),
            self.percent(self.false_misses)
        )
    }

    /// The label of the page's error map.
    pub fn label(&self) -> String {
        let false_hits = self.percent(self.false_hits);
        format!("p50 {:.1} ULP, {false_hits:.2} % false hits", self.at(0.5))
    }

    fn percent(&self, count: usize) -> f64 {
        100.0 * count as f64 / self.rays as f64
    }
}
