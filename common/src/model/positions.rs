//! The positions of an OBJ file, with more digits than a vertex has.

use glam::{DVec3, Vec3};

use super::number::words;

/// A model is far from the origin if its largest coordinate is more than this many times its size: 32 bits then
/// round it to a step of 1/65,536 of its size or more.
const FAR: f64 = 256.0;

/// The positions of an OBJ file.
#[derive(Default)]
pub(crate) struct Positions {
    /// Rounded to 32 bits.
    rounded: Vec<Vec3>,
    /// The remainder of the rounding; both together have 48 bits.
    left: Vec<Vec3>,
}

impl Positions {
    /// Adds the position that 32 bits round to `rounded`: three numbers, to be divided by `w` if there is one.
    pub fn push(&mut self, rounded: Vec3, rest: &str, w: bool) {
        let mut numbers = words(rest).map(|word| word.parse::<f64>().unwrap_or_default());
        let mut number = || numbers.next().unwrap_or_default();
        let exact = DVec3::new(number(), number(), number());
        let exact = if w { exact / number() } else { exact };
        let left = (exact - rounded.as_dvec3()).as_vec3();
        self.rounded.push(rounded);
        self.left.push(if left.is_finite() { left } else { Vec3::ZERO });
    }

    /// Adds a position that cannot be shown.
    pub fn push_wrong(&mut self) {
        self.rounded.push(Vec3::NAN);
        self.left.push(Vec3::ZERO);
    }

    /// True for a position that [`push_wrong`](Self::push_wrong) added.
    pub fn is_wrong(&self, position: u32) -> bool {
        self.rounded.get(position as usize).is_some_and(|position| position.is_nan())
    }

    /// A position in 32 bits.
    pub fn rounded(&self, position: u32) -> Vec3 {
        self.rounded[position as usize]
    }

    /// A position as the file has it.
    pub fn exact(&self, position: u32) -> DVec3 {
        let position = position as usize;
        self.rounded[position].as_dvec3() + self.left[position].as_dvec3()
    }

    /// The distance of a model from the origin, if it is far, by the positions it uses.
    pub fn far(&self, used: impl Iterator<Item = u32>) -> Option<Far> {
        let (low, high) = used
            .map(|position| self.exact(position))
            .fold((DVec3::INFINITY, DVec3::NEG_INFINITY), |(low, high), position| {
                (low.min(position), high.max(position))
            });
        Far::of(low, high)
    }

    /// Moves the origin to a point, in 64 bits.
    pub fn set_origin(&mut self, origin: DVec3) {
        for position in 0..self.rounded.len() {
            let exact = self.exact(position as u32) - origin;
            self.rounded[position] = exact.as_vec3();
            self.left[position] = (exact - self.rounded[position].as_dvec3()).as_vec3();
        }
    }
}

/// A model that is far from the origin.
pub(crate) struct Far {
    /// Its middle, rounded.
    pub middle: DVec3,
    size: f64,
    reach: f64,
    decimals: usize,
}

impl Far {
    /// The distance of a box from the origin, if it is far for its size.
    pub fn of(low: DVec3, high: DVec3) -> Option<Self> {
        let size = (high - low).max_element();
        let reach = low.abs().max(high.abs()).max_element();
        (size > 0.0 && reach > FAR * size).then(|| {
            // As round as its size allows, so that a message can state it.
            let digits = -size.log10().floor();
            let unit = 10f64.powf(-digits);
            let middle = ((low + high) * 0.5 / unit).round() * unit;
            Self { middle, size, reach, decimals: digits.clamp(0.0, 300.0) as usize }
        })
    }

    /// The warning for a model that stays where it is.
    pub fn stays(&self) -> String {
        let Self { size, reach, .. } = self;
        let step = f64::from((*reach as f32).next_up()) - f64::from(*reach as f32);
        format!(
            "is {size:.3e} from end to end and reaches {reach:.3e} from the origin, where 32 bits round to \
             steps of {step:.1e}: its shape is lost; move it to the origin in the program that wrote it"
        )
    }

    /// The note about a model that was moved.
    pub fn moved(&self) -> String {
        let [x, y, z] = self.middle.to_array();
        let decimals = self.decimals;
        format!(
            "is far from the origin, where 32 bits would lose its shape: it was moved by ({:.decimals$}, \
             {:.decimals$}, {:.decimals$}) in 64 bits, and the camera with it; points that you set, such as \
             \"camera eye\", count from the new origin",
            0.0 - x,
            0.0 - y,
            0.0 - z
        )
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn positions(list: &[&str]) -> Positions {
        let mut positions = Positions::default();
        for rest in list {
            let mut numbers = words(rest).map(|word| word.parse().unwrap());
            let mut number = || numbers.next().unwrap();
            positions.push(Vec3::new(number(), number(), number()), rest, false);
        }
        positions
    }

    #[test]
    fn a_model_far_away_keeps_its_digits_when_it_is_moved() {
        let mut far =
            positions(&["388096.123 3948996.456 35.2", "388096.823 3948998.056 35.25 # b"]);
        let found = far.far(0..2).unwrap();
        assert_eq!(found.middle, DVec3::new(388096.0, 3948997.0, 35.0));
        let note = found.moved();
        assert!(note.contains("moved by (-388096, -3948997, -35) in 64 bits"), "{note}");
        far.set_origin(found.middle);
        assert_eq!(far.rounded(0), Vec3::new(0.123, -0.544, 0.2));
        assert_eq!(far.rounded(1), Vec3::new(0.823, 1.056, 0.25));
        assert!(far.far(0..2).is_none());
    }

    #[test]
    fn a_model_is_far_by_its_own_size() {
        let far = |list: &[&str]| positions(list).far(0..list.len() as u32).is_some();
        assert!(!far(&["0 0 0", "1e6 0 0"]));
        assert!(!far(&["100 0 0", "101 0 0"]));
        assert!(far(&["1000 0 0", "1001 0 0"]));
        assert!(!far(&["1000 0 0"]), "a point has no size");
        assert!(!far(&[]));
        // A city of 10 km on a map.
        assert!(far(&["500000 5400000 0", "510000 5410000 100"]));
        let tiny = positions(&["1.0003 0 0", "1.0005 0 0"]).far(0..2).unwrap();
        assert!(tiny.moved().contains("(-1.0004, 0.0000, 0.0000)"), "{}", tiny.moved());
    }
}
