//! A small plot for the panel: labelled dots, both axes logarithmic.

/// A sample's measurements, for [`Controls::chart`](super::Controls::chart).
#[derive(Clone, Debug)]
pub struct Chart {
    /// The plotted quantity, in a word: the name of its row.
    pub name: &'static str,
    /// The quantity on the horizontal axis, and its unit.
    pub x: &'static str,
    /// The quantity on the vertical axis, and its unit.
    pub y: &'static str,
    /// The range always shown, whatever the dots: from and to, above 0, in each direction.
    pub span: [[f64; 2]; 2],
    /// The dots.
    pub dots: Vec<Dot>,
}

/// One dot.
#[derive(Clone, Debug)]
pub struct Dot {
    /// The configuration represented by the dot.
    pub label: &'static str,
    /// Its position; both coordinates above 0.
    pub at: [f64; 2],
    /// True if the picture shows this one.
    pub is_shown: bool,
}

impl Chart {
    /// The decades that contain all dots, in each direction: exponents of ten, at least one apart.
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
