//! Shadow rays of a chapter, compared with the reference: their starts and their hits.

use std::path::Path;

use common::app::Picture;
use common::scene::Scene;
use glam::{DVec3, Vec3};
use reference::Ray;
use reference::scene::Scene as Exact;

use run::Chapter;
use run::primary_hits::{answer, rays, reference};

const SIZE: &str = "240x150";

/// A picture with the shaders of a folder and these controls set.
pub fn picture_by(shaders: &Path, name: &str, sets: &[&str]) -> Picture {
    Chapter::new(name).size(SIZE).shaders(shaders).sets(sets).picture()
}

/// The errors of a picture's shadows (`show=shadow`).
pub struct Shadows {
    /// Pixels that should be lit.
    pub lit: usize,
    /// Of those, the pixels that are dark.
    pub dark: usize,
    /// Lit pixels that should be dark.
    pub leaks: usize,
}

impl Shadows {
    pub fn compare(right: &Picture, shown: &Picture) -> Self {
        let is = |pixel: &[f32; 4], value: f32| pixel[..3] == [value; 3];
        let pairs = || right.pixels.iter().zip(&shown.pixels);
        Self {
            lit: right.pixels.iter().filter(|pixel| is(pixel, 1.0)).count(),
            dark: pairs().filter(|(a, b)| is(a, 1.0) && is(b, 0.0)).count(),
            leaks: pairs().filter(|(a, b)| is(a, 0.0) && is(b, 1.0)).count(),
        }
    }
}

/// A ray from a point to the light, with the same bits as in a shader in f32.
pub type Shadow = fn(Vec3) -> Ray;

/// A visible surface, and the shadow ray that left it.
pub struct Seen {
    pub instance: u32,
    pub triangle: u32,
    /// The hit, in f64.
    pub point: DVec3,
    /// Unit normal of the triangle, towards the eye.
    pub normal: DVec3,
    /// Origin of the GPU's shadow ray.
    pub origin: Vec3,
    /// True if the ray reached the light.
    pub lit: bool,
}

/// The surface visible in each pixel of a chapter, without pixels of the sky.
pub fn seen(exact: &Exact, name: &str, sets: &[&str]) -> Vec<Seen> {
    let camera = Scene::chess().unwrap().camera;
    let show = |view| Chapter::new(name).size(SIZE).sets(sets).sets(&[view]).picture();
    let (hits, directions) = (show("show=hit"), show("show=ray direction"));
    let origins = show("show=shadow origin");
    let rays = rays(&camera, &directions);
    let pixels = rays.zip(&hits.pixels).zip(&origins.pixels);
    let surfaces = pixels.filter_map(|((ray, hit), &[x, y, z, lit])| {
        let answer = answer(hit)?;
        let (instance, triangle) = (answer.instance, answer.primitive);
        let t = exact.candidate_at(&ray, instance, triangle).unwrap().hit.t;
        let [a, b, c] = *exact.triangle(instance, triangle).unwrap();
        let normal = (b - a).cross(c - a).normalize();
        let normal = normal * -normal.dot(ray.direction).signum();
        assert!(lit == 0.0 || lit == 1.0, "{lit}");
        let (point, origin, lit) = (ray.at(t), Vec3::new(x, y, z), lit == 1.0);
        Some(Seen { instance, triangle, point, normal, origin, lit })
    });
    surfaces.collect()
}

/// The results of a picture's shadow rays.
pub struct Answers {
    pub surfaces: usize,
    pub lit: usize,
    /// Rays that hit an edge, where either answer is right.
    pub edges: usize,
    /// Surfaces that face away from the light, which need no ray.
    pub turned_away: usize,
}

/// Compares each shadow ray of a chapter with the reference.
pub fn hold_answers(name: &str, shadow: Shadow) -> Answers {
    let exact = reference(&Scene::chess().unwrap());
    let surfaces = seen(&exact, name, &[]);
    let (mut lit, mut edges, mut sides) = (0, 0, 0);
    for surface in &surfaces {
        lit += usize::from(surface.lit);
        let ray = shadow(surface.origin);
        // Its own triangle is below: to be blocked by it is an error at any distance.
        let own = (surface.instance, surface.triangle);
        let mut candidates = exact.near_candidates(&ray);
        candidates.retain(|candidate| (candidate.hit.instance, candidate.hit.primitive) != own);
        if candidates.iter().any(|candidate| candidate.must_hit(&ray)) {
            assert!(!surface.lit, "lit through a triangle: {ray:?}");
        } else if !candidates.is_empty() {
            edges += 1;
        } else if !surface.lit {
            // Nothing is in the way, so the shader must have found the light below the triangle; the cosine
            // is off by a few roundings.
            let cosine = surface.normal.dot(ray.direction) / ray.direction.length();
            assert!(cosine < 1e-6, "dark: {ray:?} {cosine}");
            sides += 1;
        }
    }
    let all = surfaces.len();
    println!("{name}: {all} surfaces, {lit} lit, {edges} at edges, {sides} turned away");
    assert!(lit > all / 4 && lit < all * 9 / 10, "{lit} of {all}");
    // Most of those start next to an edge shared by their own triangle and one in the same plane.
    assert!(edges * 100 < all, "{edges} of {all}");
    Answers { surfaces: all, lit, edges, turned_away: sides }
}

/// The distances of origins from the exact hits, and their effect.
pub struct Origins {
    /// Surfaces whose shadow differs from that of the exact hit.
    pub differ: usize,
    pub surfaces: usize,
    /// The highest origin above its triangle; slivers are counted separately.
    pub height: f64,
    pub height_on_slivers: f64,
    /// The largest distance from the exact hit.
    pub moved: f64,
}

/// Answers the actual question: is the segment from the exact hit to the light blocked?
pub fn hold_origins(name: &str, shadow: Shadow) -> Origins {
    let exact = reference(&Scene::chess().unwrap());
    let surfaces = seen(&exact, name, &[]);
    let mut differ = 0;
    let (mut highest, mut highest_on_slivers, mut farthest) = (0.0, 0.0, 0.0);
    for surface in &surfaces {
        let rounded = shadow(surface.origin);
        let moved = surface.point - rounded.origin;
        let height = -moved.dot(surface.normal);
        assert!(height > 0.0, "a shadow ray starts {height} above its triangle");
        let [a, b, c] = *exact.triangle(surface.instance, surface.triangle).unwrap();
        let longest = (b - a).length().max((c - a).length()).max((c - b).length());
        let width = (b - a).cross(c - a).length() / longest;
        let sliver = width < longest / 50.0;
        let bound = if sliver { &mut highest_on_slivers } else { &mut highest };
        *bound = f64::max(*bound, height);
        farthest = f64::max(farthest, moved.length());

        let end = rounded.origin + rounded.direction;
        let direction = if rounded.tmax == 1.0 { end - surface.point } else { rounded.direction };
        let ray = Ray { origin: surface.point, direction, ..rounded };
        let own = (surface.instance, surface.triangle);
        let above = surface.normal.dot(direction) > 0.0;
        let blocker = exact.closest_hit(&ray, |hit| (hit.instance, hit.primitive) != own);
        let lit = above && blocker.is_none();
        if lit == surface.lit {
            continue;
        }
        differ += 1;
        // The origin was moved by a known distance, and an edge, a contact or the horizon must be as close as
        // that, or as the bound on the triangle test.
        let cosine = surface.normal.dot(direction) / direction.length();
        let near = exact.near_candidates(&rounded);
        let doubtful = blocker.map(|hit| exact.candidate(&ray, hit)).into_iter().chain(near);
        let moved = moved.length();
        let excused = doubtful.into_iter().any(|candidate| {
            let at_edge = candidate.graze.margin.abs() <= candidate.graze.bound + moved;
            let [a, b, c] = *exact
                .triangle(candidate.hit.instance, candidate.hit.primitive)
                .expect("a triangle of the scene");
            let slope = (b - a).cross(c - a).normalize().dot(ray.direction).abs();
            let at_contact = candidate.hit.t * slope <= candidate.t_bound * slope + moved;
            at_edge || at_contact
        });
        assert!(excused || cosine.abs() < 1e-6, "{ray:?} {moved} {cosine}");
    }
    let all = surfaces.len();
    println!(
        "{name}: {differ} of {all} differ; origins are {highest:.1e} high at most, \
         {highest_on_slivers:.1e} on slivers, {farthest:.1e} from the exact hit"
    );
    assert!(differ * 500 < all, "{differ} of {all}");
    // A board's square is 1: a shadow begins at the foot of the piece.
    assert!(highest < 1e-4 && highest_on_slivers < 2e-3, "{highest} {highest_on_slivers}");
    Origins {
        differ,
        surfaces: all,
        height: highest,
        height_on_slivers: highest_on_slivers,
        moved: farthest,
    }
}

/// Returns whether a shadow ray started on the board's squares: flat, level, of two materials without
/// textures.
pub fn is_on_a_square(&[x, y, z, lit]: &[f32; 4]) -> bool {
    lit >= 0.0 && y.abs() < 1e-4 && x.abs() < 3.99 && z.abs() < 3.99
}
