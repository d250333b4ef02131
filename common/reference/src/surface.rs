//! Intersection of a ray with a surface: t and the normal, in f64 and exactly.

use glam::DVec3;

use super::surd::Surd;

/// Intersection of a ray with a surface, in f64.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Surface {
    /// Ray parameter of the hit, in lengths of the ray's direction.
    pub t: f64,
    /// Unit normal at the hit; the module's conventions say which of the two.
    pub normal: DVec3,
}

/// Intersection of a ray with a surface, exactly.
#[derive(Clone, Debug)]
pub struct ExactSurface {
    /// Ray parameter of the hit, in lengths of the ray's direction.
    pub t: Surd,
    /// Unit normal at the hit; the module's conventions say which of the two.
    pub normal: [Surd; 3],
}

impl ExactSurface {
    /// The same, each number correctly rounded to the nearest f64.
    pub fn to_f64(&self) -> Surface {
        Surface {
            t: self.t.to_f64(),
            normal: DVec3::from_array(self.normal.each_ref().map(Surd::to_f64)),
        }
    }
}
