//! Errors by the thousand: how many there are of each size, and the largest.

/// The exponent of the least bucket's upper end: errors below 2^-4 are not distinguished.
const LEAST: i32 = -4;
/// Number of buckets; the last has no upper end.
const BUCKETS: usize = 26;

/// Errors, none of them negative or NaN.
#[derive(Default)]
pub struct Errors(Vec<f64>);

/// Summary of the errors.
pub struct Spread {
    /// Half of them are no larger.
    pub p50: f64,
    /// 99 of 100 are no larger.
    pub p99: f64,
    pub max: f64,
    /// Number of errors below 2^-4, then from there to 2^-3, and so on by powers of two; the last from 2^20.
    pub buckets: Vec<u64>,
}

impl Errors {
    pub fn add(&mut self, error: f64) {
        self.0.push(error);
    }

    /// Zeros where there are no errors.
    pub fn spread(mut self) -> Spread {
        self.0.sort_by(f64::total_cmp);
        let mut buckets = vec![0; BUCKETS];
        for error in &self.0 {
            let above = (error.log2().floor() as i32).saturating_sub(LEAST - 1);
            buckets[above.clamp(0, BUCKETS as i32 - 1) as usize] += 1;
        }
        let at = |part: f64| {
            let last = self.0.len().saturating_sub(1) as f64;
            self.0.get((part * last).round() as usize).copied().unwrap_or_default()
        };
        Spread { p50: at(0.5), p99: at(0.99), max: at(1.0), buckets }
    }
}
