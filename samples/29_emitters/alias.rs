//! A table by which one of many is chosen in one step, each as often as its weight says.

use anyhow::{Result, ensure};

common::shader_struct! {
    /// A column of the table.
    pub struct Column {
        /// The part of the column that belongs to its own number, a multiple of 2^-24.
        pub own: f32,
        /// The number that owns the rest.
        pub other: u32,
    }
}

/// The alias method (Walker, ACM TOMS 3:3, 1977; Vose, IEEE TSE 17:9, 1991), in whole numbers.
pub struct AliasTable {
    /// As many columns as the next power of two, so that a binary fraction finds one without rounding; none
    /// if nothing has a weight.
    pub columns: Vec<Column>,
    /// The share of all columns that each number has, in parts of [`UNITS`] to a column: all together, all of it.
    pub shares: Vec<u64>,
}

/// Into how many parts a column can be divided: as many as `to_unit` has numbers.
pub const UNITS: u64 = 1 << 24;

/// Maximum count of numbers: fewer than a column has parts, since each with a weight has at least one.
pub const MOST: usize = 1 << 20;

impl AliasTable {
    /// A table for weights from 0 up. What is chosen has the probability of its *share*, the weight rounded to
    /// parts of the table.
    ///
    /// # Errors
    /// If a weight is none: negative, infinite or no number. If there are too many.
    pub fn new(weights: &[f64]) -> Result<Self> {
        ensure!(weights.len() <= MOST, "{} emitters are more than {MOST}", weights.len());
        for (i, weight) in weights.iter().enumerate() {
            let is_weight = weight.is_finite() && *weight >= 0.0;
            ensure!(
                is_weight,
                "emitter {i} has a power of {weight}; it must be finite, and not below 0"
            );
        }
        Ok(Self::of(weights))
    }

    /// As [`AliasTable::new`], for fewer than [`UNITS`] weights that are finite and not negative.
    pub fn of(weights: &[f64]) -> Self {
        let most = weights.iter().copied().fold(0.0, f64::max);
        if most == 0.0 {
            return Self { columns: vec![], shares: vec![0; weights.len()] };
        }
        // Whole numbers: their sum is the same in any order.
        let whole = |weight: &f64| (weight / most * 2f64.powi(40)).ceil() as u128;
        let sum: u128 = weights.iter().map(whole).sum();
        let count = weights.len().next_power_of_two();
        let all = count as u64 * UNITS;
        let share = |weight: &f64| {
            let share = (whole(weight) * u128::from(all) / sum) as u64;
            // An emitter that is never chosen would be missing from the picture.
            share.max(u64::from(*weight > 0.0))
        };
        let mut shares: Vec<u64> = weights.iter().map(share).collect();
        // The strongest takes the error of rounding, less than one part per emitter.
        let strongest = weights.iter().position(|weight| *weight == most).unwrap_or(0);
        let others = shares.iter().sum::<u64>() - shares[strongest];
        shares[strongest] = all - others;
        Self { columns: columns(&shares, count), shares }
    }

    /// The probability of number `i`.
    pub fn probability(&self, i: usize) -> f64 {
        let all = self.columns.len().max(1) as u64 * UNITS;
        self.shares[i] as f64 / all as f64
    }
}

/// Divides shares among columns: one too small for its column is filled up from one too large for it.
fn columns(shares: &[u64], count: usize) -> Vec<Column> {
    let mut left = shares.to_vec();
    left.resize(count, 0);
    let (mut small, mut large): (Vec<usize>, Vec<usize>) =
        (0..count).partition(|&i| left[i] < UNITS);
    let mut columns: Vec<Column> =
        (0..count as u32).map(|other| Column { own: 1.0, other }).collect();
    while let (Some(low), Some(&high)) = (small.pop(), large.last()) {
        columns[low] = Column { own: left[low] as f32 / UNITS as f32, other: high as u32 };
        left[high] -= UNITS - left[low];
        if left[high] < UNITS {
            large.pop();
            small.push(high);
        }
    }
    columns
}

#[cfg(test)]
mod tests {
    use super::*;

    /// The share of each number in the columns, in parts.
    fn counted(table: &AliasTable) -> Vec<u64> {
        let mut found = vec![0; table.columns.len()];
        for (i, column) in table.columns.iter().enumerate() {
            let own = column.own * UNITS as f32;
            assert!(own.fract() == 0.0 && (0.0..=UNITS as f32).contains(&own), "column {i}: {own}");
            found[i] += own as u64;
            found[column.other as usize] += UNITS - own as u64;
        }
        found
    }

    /// Weights over many orders of magnitude, some of them 0.
    fn weights(count: u32) -> Vec<f64> {
        let unit = |i: u32| f64::from(i.wrapping_mul(2_654_435_769) >> 8) / 16_777_216.0;
        let weight =
            |i| if i % 7 == 3 { 0.0 } else { (60.0 * unit(i) - 30.0).exp2() * (1.0 + unit(i + 1)) };
        (0..count).map(weight).collect()
    }

    #[test]
    fn the_columns_hold_each_share_to_the_last_part() {
        for count in [1, 2, 3, 5, 64, 100, 1000, 4097] {
            let weights = weights(count);
            let table = AliasTable::new(&weights).unwrap();
            assert!(table.columns.len().is_power_of_two());
            let found = counted(&table);
            assert_eq!(found[..weights.len()], table.shares, "{count}");
            assert!(found[weights.len()..].iter().all(|share| *share == 0), "{count}: padding");
            assert_eq!(table.shares.iter().sum::<u64>(), table.columns.len() as u64 * UNITS);
            let sum: f64 = weights.iter().sum();
            for (i, weight) in weights.iter().enumerate() {
                assert_eq!(*weight == 0.0, table.shares[i] == 0, "{count}: {i}");
                // Rounded down, or up to one part; but the strongest, which has what is left.
                let off = (table.probability(i) - weight / sum).abs();
                assert!(off < 2.0 / UNITS as f64, "{count}: {i} is off by {off}");
            }
        }
    }

    #[test]
    fn no_order_of_the_weights_changes_a_share() {
        let forwards = weights(1000);
        let mut backwards = forwards.clone();
        backwards.reverse();
        let mut shares = AliasTable::new(&backwards).unwrap().shares;
        shares.reverse();
        assert_eq!(AliasTable::new(&forwards).unwrap().shares, shares);
    }

    #[test]
    fn equal_weights_have_equal_shares_but_for_what_cannot_be_divided() {
        let shares = AliasTable::new(&[2.5; 3]).unwrap().shares;
        assert_eq!(shares, [22_369_622, 22_369_621, 22_369_621]);
        assert_eq!(AliasTable::new(&[1e-300; 4]).unwrap().shares, [UNITS; 4]);
    }

    #[test]
    fn one_weight_is_always_chosen_and_none_never() {
        let one = AliasTable::new(&[1e-30]).unwrap();
        assert_eq!((one.shares[0], one.columns.len(), one.columns[0].own), (UNITS, 1, 1.0));
        for nothing in [&[][..], &[0.0][..], &[0.0; 5][..]] {
            let table = AliasTable::new(nothing).unwrap();
            assert!(table.columns.is_empty() && table.shares.iter().all(|share| *share == 0));
        }
        let beside = AliasTable::new(&[0.0, 3.0, 0.0]).unwrap();
        assert_eq!(beside.shares, [0, 4 * UNITS, 0]);
    }

    #[test]
    fn the_weakest_is_chosen_now_and_then() {
        let table = AliasTable::new(&[1e30, 1e-30, 0.0]).unwrap();
        assert_eq!(table.shares, [4 * UNITS - 1, 1, 0]);
    }

    #[test]
    fn what_is_no_weight_is_refused_by_number() {
        for wrong in [f64::NAN, f64::INFINITY, -1.0] {
            let error = AliasTable::new(&[1.0, wrong]).err().unwrap().to_string();
            assert!(error.starts_with("emitter 1 has a power of"), "{error}");
        }
        let error = AliasTable::new(&vec![1.0; MOST + 1]).err().unwrap().to_string();
        assert!(error.starts_with("1048577 emitters are more than 1048576"), "{error}");
    }
}
