//! A box in the form that builds work on.

use common::glam::Vec3;

use crate::tree::Bounds;

/// A box: its low corner, and its high corner negated. So the box around two boxes is the lesser of each
/// pair of numbers, which a processor finds for four pairs at a time. One number of each four is idle.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Hull([f32; 8]);

impl Hull {
    /// The box around nothing.
    pub const EMPTY: Self = Self([f32::MAX; 8]);

    /// The box around those boxes that are any.
    pub fn around(bounds: impl IntoIterator<Item = Bounds>) -> Self {
        let hulls = bounds.into_iter().filter(has_place).map(Self::from);
        hulls.fold(Self::EMPTY, |a, b| a.join(&b))
    }

    /// The box around two.
    pub fn join(&self, other: &Self) -> Self {
        let mut joined = self.0;
        for (a, &b) in joined.iter_mut().zip(&other.0) {
            // Not `f32::min`, which takes care of NaN: there is none, and the care costs time.
            *a = if b < *a { b } else { *a };
        }
        Self(joined)
    }

    /// Half its surface area. In 64 bits, where no square of a 32-bit number is lost or infinite.
    pub fn half_area(&self) -> f64 {
        let [x, y, z] =
            [0, 1, 2].map(|axis| -f64::from(self.0[axis + 4]) - f64::from(self.0[axis]));
        x * y + y * z + z * x
    }
}

impl Hull {
    /// Half the middle along an axis: so it is finite, and so is the way from one to another.
    pub fn half_middle(&self, axis: usize) -> f32 {
        self.0[axis] * 0.25 - self.0[axis + 4] * 0.25
    }

    /// Length along an axis.
    pub fn side(&self, axis: usize) -> f32 {
        -self.0[axis + 4] - self.0[axis]
    }

    /// The low corner's coordinate along an axis.
    pub fn low(&self, axis: usize) -> f32 {
        self.0[axis]
    }

    /// A box without size.
    pub fn point(at: [f32; 3]) -> Self {
        let [x, y, z] = at;
        Self([x, y, z, 0.0, -x, -y, -z, 0.0])
    }
}

impl From<Bounds> for Hull {
    fn from((low, high): Bounds) -> Self {
        Self([low.x, low.y, low.z, 0.0, -high.x, -high.y, -high.z, 0.0])
    }
}

impl From<Hull> for Bounds {
    fn from(Hull([x, y, z, _, u, v, w, _]): Hull) -> Self {
        (Vec3::new(x, y, z), Vec3::new(-u, -v, -w))
    }
}

/// The box of a primitive that has no place.
pub(crate) const NOWHERE: Bounds = (Vec3::NAN, Vec3::NAN);

/// Tests whether a primitive has a place in a tree: its box is finite and not inside out. One that has none is met
/// by no ray, as Vulkan has it of a primitive without numbers.
pub fn has_place(&(low, high): &Bounds) -> bool {
    low.is_finite() && high.is_finite() && low.cmple(high).all()
}
