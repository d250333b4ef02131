//! A small plot for the panel: labelled dots, both axes logarithmic.

/// What a sample has found out, for [`Controls::chart`](super::Controls::chart).
#[derive(Clone, Debug)]
pub struct Chart {
    /// What is plotted, in a word: the name of its row.
    pub name: &'static str,
    /// What runs to the right, and its unit.
    pub x: &'static str,
    /// What runs upwards, and its unit.
    pub y: &'static str,
    /// What is shown whatever there is to see: from and to, above 0, in each direction.
    pub span: [[f64; 2]; 2],
    /// What there is to see.
    pub dots: Vec<Dot>,
}

/// One dot.
#[derive(Clone, Debug)]
pub struct Dot {
    /// What it stands for.
    pub label: &'static str,
    /// Its place; both above 0.
    pub at: [f64; 2],
    /// Whether it is the one that the picture shows.
    pub is_shown: bool,
}

impl Chart {
    /// The decades that hold all dots, in each direction: exponents of ten, at least one apart.
    pub fn decades(&self) -> [(i32, i32); 2] {
        [0, 1].map(|axis| {
            let values = self.dots.iter().map(|dot| dot.at[axis]).chain(self.span[axis]);
            let low = values.clone().fold(f64::INFINITY, f64::min).log10();
            let high = values.fold(f64::NEG_INFINITY, f64::max).log10();
            let low = low.floor() as i32;
            (low, (high.ceil() as i32).max(low + 1))
        })
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn decades_hold_every_dot() {
        let dot = |x, y| Dot { label: "S0", at: [x, y], is_shown: false };
        let chart = |dots| Chart { name: "", x: "", y: "", span: [[1.0, 5.0], [1.0, 1.0]], dots };
        assert_eq!(chart(vec![]).decades(), [(0, 1); 2]);
        assert_eq!(chart(vec![dot(10.0, 0.5)]).decades(), [(0, 1), (-1, 0)]);
        assert_eq!(chart(vec![dot(0.3, 1.0), dot(200.0, 4e5)]).decades(), [(-1, 3), (0, 6)]);
    }
}
