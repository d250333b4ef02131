//! Every seventh ray of a picture of shapes, compared with the exact nearest hit.

use common::app::Picture;
use common::scene::Camera;
use reference::Ray;

use super::reference_shapes::{Id, ReferenceShapes};
use run::primary_hits::{answer, rays};

/// An error bound of a hit with a shape: of t, and of the shape's outline across the ray.
pub struct Bound {
    pub along: f64,
    pub across: f64,
}

/// The hits whose shape is the exact one, and the others, which the bounds explain.
#[derive(Default)]
pub struct Hits {
    /// Ray, shape, t and exact t.
    pub same: Vec<(Ray, Id, f32, f64)>,
    /// The number of rays that graze an outline.
    pub outlines: usize,
    /// The number of rays that hit another surface at the same distance.
    pub ties: usize,
}

impl Hits {
    /// Compares the pictures of `show=hit` and `show=ray direction`.
    pub fn compare(
        exact: &ReferenceShapes,
        camera: &Camera,
        [hits, directions]: [&Picture; 2],
        bound: impl Fn(&Ray, Id) -> Bound,
    ) -> Self {
        let mut compared = Self::default();
        for (ray, pixel) in rays(camera, directions).zip(&hits.pixels).step_by(7) {
            let found = answer(pixel).map(|hit| ((hit.instance, hit.primitive), hit.t));
            let closest = exact.closest(&ray);
            match (found, closest) {
                (None, None) => continue,
                (Some((id, t)), Some((exact_id, exact_t))) if id == exact_id => {
                    compared.same.push((ray, id, t, exact_t));
                    continue;
                }
                (Some((id, _)), Some((_, exact_t)))
                    if exact
                        .hit(&ray, id)
                        .is_some_and(|t| (t - exact_t).abs() <= bound(&ray, id).along) =>
                {
                    compared.ties += 1;
                    continue;
                }
                _ => {}
            }
            let may_hit =
                found.is_none_or(|(id, _)| exact.grown(&ray, id, bound(&ray, id).across).is_some());
            let missed = closest.filter(|(id, _)| found.is_none_or(|found| found.0 != *id));
            let nearer = missed.filter(|(_, t)| found.is_none_or(|found| *t < found.1.into()));
            let may_miss = nearer
                .is_none_or(|(id, _)| exact.grown(&ray, id, -bound(&ray, id).across).is_none());
            assert!(may_hit && may_miss, "{ray:?}: found {found:?}, exact {closest:?}");
            compared.outlines += 1;
        }
        println!("{} at outlines, {} ties", compared.outlines, compared.ties);
        compared
    }
}
