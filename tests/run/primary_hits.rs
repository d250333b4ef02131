//! The reference's copy of a scene, and the judgement of a whole picture of hits.

use std::fmt;

use common::app::Picture;
use common::scene::{self, Camera};
use reference::Ray;
use reference::scene::{Instance, Scene};
use reference::transform::Transform;
use reference::ulp::ulp_error;
use reference::verdict::{Answer, Verdict};
use serde_json::{Value, json};

/// The reference's copy of a scene: the same f32 positions and matrices.
pub fn reference(scene: &scene::Scene) -> Scene {
    let instances = scene.instances.iter().map(|instance| {
        let mesh = &scene.model.meshes[instance.mesh];
        let corners = |&triangle: &[u32; 3]| {
            triangle.map(|index| mesh.vertices[index as usize].position.to_array())
        };
        let [x0, x1, x2, x3, y0, y1, y2, y3, z0, z1, z2, z3] =
            scene::transform(&instance.transform).matrix;
        let rows = [[x0, x1, x2, x3], [y0, y1, y2, y3], [z0, z1, z2, z3]];
        Instance {
            transform: Transform::from_rows(rows).expect("an instance's matrix can be inverted"),
            triangles: mesh.triangles.iter().map(corners).collect(),
        }
    });
    Scene::new(instances)
}

/// The rays whose directions the GPU wrote (`show=ray direction`).
pub fn rays<'a>(camera: &Camera, directions: &'a Picture) -> impl Iterator<Item = Ray> + 'a {
    let origin = camera.eye.as_vec3().to_array();
    directions.pixels.iter().map(move |&[x, y, z, _]| Ray::from_f32(origin, [x, y, z], 0.0, 1e30))
}

/// The GPU's record of a hit (`show=hit`): instance, triangle, t; `None` for a miss.
pub fn answer(pixel: &[f32; 4]) -> Option<Answer> {
    let [instance, primitive, t, _] = *pixel;
    let hit = Answer { instance: instance as u32, primitive: primitive as u32, t };
    (instance >= 0.0).then_some(hit)
}

/// The numbers of rays, by outcome.
#[derive(Default)]
pub struct Tally {
    /// Rays with the exact answer.
    pub agree: usize,
    /// Rays with another triangle at the same distance, within the bounds.
    pub ties: usize,
    /// Rays that graze an edge within its bound.
    pub grazes: usize,
    /// Rays without an explanation.
    pub wrong: usize,
    /// The first of those.
    pub first_wrong: Option<String>,
    /// The error of each hit's t compared with f64, in units of the last place.
    pub ulp_errors: Vec<f64>,
}

impl Tally {
    /// The errors' median, 99th percentile and maximum.
    fn errors(&self) -> [f64; 3] {
        let mut errors = self.ulp_errors.clone();
        errors.sort_by(f64::total_cmp);
        let at = |part: f64| errors.get((errors.len() as f64 * part) as usize).copied();
        [at(0.5), at(0.99), errors.last().copied()].map(Option::unwrap_or_default)
    }

    /// All counts as figures for a page.
    pub fn values(&self) -> Value {
        let Self { agree, ties, grazes, wrong, .. } = self;
        let [half, most, worst] = self.errors();
        json!({ "agree": agree, "ties": ties, "edges": grazes, "wrong": wrong,
                "median": half, "p99": most, "most": worst })
    }
}

impl fmt::Display for Tally {
    fn fmt(&self, f: &mut fmt::Formatter) -> fmt::Result {
        let Self { agree, ties, grazes, wrong, .. } = self;
        let [half, most, worst] = self.errors();
        write!(f, "{agree} rays agree, {wrong} are wrong, {ties} ties, {grazes} at edges; ")?;
        write!(f, "t is off by {half:.1} ULP (median), {most:.1} (99 %), {worst:.1} (at most)")
    }
}

/// Judges each ray's answer: instance, triangle and t, `None` for a miss.
pub fn judge(scene: &Scene, rays: impl Iterator<Item = (Ray, Option<Answer>)>) -> Tally {
    let mut tally = Tally::default();
    for (index, (ray, answer)) in rays.enumerate() {
        let exact =
            answer.and_then(|a| Some((a, scene.candidate_at(&ray, a.instance, a.primitive)?)));
        tally.ulp_errors.extend(exact.map(|(answer, exact)| ulp_error(answer.t, exact.hit.t)));
        match scene.judge(&ray, answer, |_| true) {
            Verdict::Agrees => tally.agree += 1,
            Verdict::Tie { .. } => tally.ties += 1,
            Verdict::WithinEdgeBound { .. } | Verdict::WithinIntervalBound { .. } => {
                tally.grazes += 1;
            }
            verdict @ Verdict::Wrong { .. } => {
                tally.wrong += 1;
                let line = || format!("ray {index}: {ray:?} {answer:?}: {verdict:?}");
                tally.first_wrong.get_or_insert_with(line);
            }
        }
    }
    tally
}
