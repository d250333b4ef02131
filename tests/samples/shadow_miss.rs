//! 05_shadow_miss: shadows held to the reference, and what each choice must not change.

mod offsets;

use common::app::Picture;
use common::scene::{PointLight, Scene, Sun};
use glam::{DVec3, Vec3};
use reference::Ray;
use reference::scene::Scene as Exact;
use serde_json::json;

use run::primary_hits::{answer, rays, reference};
use run::{bits, figures, golden, render, same_answers, same_colors};

const NAME: &str = "05_shadow_miss";
const SIZE: &str = "240x150";

/// A picture with these controls set.
fn picture(sets: &[&str]) -> Picture {
    let arguments: Vec<&str> = sets.iter().flat_map(|&set| ["--set", set]).collect();
    render(NAME, SIZE, &arguments).picture
}

#[test]
fn the_picture_is_the_golden_one() {
    // Tolerance set by llvmpipe (Mesa 25.0.7), which made the golden and repeats it to the bit.
    golden(NAME, &picture(&[]), 0.002);
}

/// A surface that was seen, and the shadow ray that left it.
struct Seen {
    instance: u32,
    triangle: u32,
    /// The hit, in f64.
    point: DVec3,
    /// Unit normal of the triangle, towards the eye.
    normal: DVec3,
    /// Where the GPU's shadow ray started.
    origin: Vec3,
    /// Whether it found its way.
    lit: bool,
}

/// The surface that each pixel saw, but for pixels that saw the sky.
fn seen(exact: &Exact, sets: &[&str]) -> Vec<Seen> {
    let camera = Scene::chess().unwrap().camera;
    let show = |view| picture(&[sets, &[view]].concat());
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

/// A ray from a point to the light, of the very bits that a shader in f32 makes of them.
type Shadow = fn(Vec3) -> Ray;

fn to_sun(origin: Vec3) -> Ray {
    let sun = Sun { azimuth: 60.0, elevation: 17.0, ..Sun::default() };
    Ray::from_f32(origin.to_array(), sun.light().direction.to_array(), 0.0, 1e30)
}

fn to_lamp(origin: Vec3) -> Ray {
    let direction = PointLight::default().position - origin;
    Ray::from_f32(origin.to_array(), direction.to_array(), 0.0, 1.0)
}

const LIGHTS: [(&str, Shadow); 2] = [("light=directional", to_sun), ("light=point", to_lamp)];

#[test]
fn every_shadow_ray_gets_the_reference_s_answer() {
    let exact = reference(&Scene::chess().unwrap());
    for (light, shadow) in LIGHTS {
        for terminator in ["smooth terminator=off", "smooth terminator=on"] {
            let surfaces = seen(&exact, &[light, terminator]);
            let (mut lit, mut edges, mut sides) = (0, 0, 0);
            for surface in &surfaces {
                lit += usize::from(surface.lit);
                let ray = shadow(surface.origin);
                // Its own triangle lies below: to be stopped by it is a fault, however near it is.
                let own = (surface.instance, surface.triangle);
                let mut candidates = exact.near_candidates(&ray);
                candidates
                    .retain(|candidate| (candidate.hit.instance, candidate.hit.primitive) != own);
                if candidates.iter().any(|candidate| candidate.must_hit(&ray)) {
                    assert!(!surface.lit, "lit through a triangle: {ray:?}");
                } else if !candidates.is_empty() {
                    edges += 1;
                } else if !surface.lit {
                    // The way is free, so the shader must have found the light below the surface.
                    // Without the lift that is the triangle; the cosine is off by a few roundings.
                    let cosine = surface.normal.dot(ray.direction) / ray.direction.length();
                    assert!(terminator.ends_with("on") || cosine < 1e-6, "dark: {ray:?} {cosine}");
                    sides += 1;
                }
            }
            let all = surfaces.len();
            println!(
                "{light}, {terminator}: {all} surfaces, {lit} lit, {edges} at edges, {sides} turned away"
            );
            if (light, terminator) == ("light=directional", "smooth terminator=off") {
                let found =
                    json!({ "surfaces": all, "lit": lit, "edges": edges, "turned_away": sides });
                figures::hold("05_shadow_miss/rays", found);
            }
            assert!(lit > all / 4 && lit < all * 9 / 10, "{lit} of {all}");
            // Most of those start beside an edge that the own triangle shares with one in the same plane.
            assert!(edges * 100 < all, "{edges} of {all}");
        }
    }
}

/// The question itself: is the segment from the hit, exactly, to the light blocked?
#[test]
fn shadows_are_those_of_the_exact_hit_points() {
    let exact = reference(&Scene::chess().unwrap());
    for (light, shadow) in LIGHTS {
        let surfaces = seen(&exact, &[light, "smooth terminator=off"]);
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
            let direction =
                if rounded.tmax == 1.0 { end - surface.point } else { rounded.direction };
            let ray = Ray { origin: surface.point, direction, ..rounded };
            let own = (surface.instance, surface.triangle);
            let above = surface.normal.dot(direction) > 0.0;
            let blocker = exact.closest_hit(&ray, |hit| (hit.instance, hit.primitive) != own);
            let lit = above && blocker.is_none();
            if lit == surface.lit {
                continue;
            }
            differ += 1;
            // The origin was moved by a distance that is known, and an edge, a contact or the
            // horizon must be as near as that, or as the bound on the triangle test.
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
            "{light}: {differ} of {all} differ; origins are {highest:.1e} high at most, \
             {highest_on_slivers:.1e} on slivers, {farthest:.1e} from the exact hit"
        );
        if light == "light=directional" {
            let found = json!({ "differ": differ, "surfaces": all, "height": highest,
                                "height_on_slivers": highest_on_slivers, "moved": farthest });
            figures::hold("05_shadow_miss/origins", found);
        }
        assert!(differ * 500 < all, "{differ} of {all}");
        // A board's square is 1: a shadow begins where the piece stands.
        assert!(highest < 1e-4 && highest_on_slivers < 2e-3, "{highest} {highest_on_slivers}");
    }
}

#[test]
fn lifting_the_origin_changes_only_what_turns_away_from_the_light() {
    let exact = reference(&Scene::chess().unwrap());
    let sides = ["smooth terminator=off", "smooth terminator=on"];
    let [flat, smooth] = sides.map(|set| seen(&exact, &[set]));
    let (mut lifted, mut lit, mut dark, mut highest) = (0, 0, 0, 0.0);
    for (flat, smooth) in flat.iter().zip(&smooth) {
        let height = f64::from((smooth.origin - flat.origin).length());
        highest = f64::max(highest, height);
        lifted += usize::from(height > 0.0);
        lit += usize::from(smooth.lit && !flat.lit);
        dark += usize::from(!smooth.lit && flat.lit);
        if smooth.lit != flat.lit {
            assert!(height > 0.0, "nothing was lifted at {:?}", flat.origin);
        }
    }
    let all = flat.len();
    println!("{lifted} of {all} lifted by up to {highest:.1e}; {lit} became lit, {dark} dark");
    figures::hold("05_shadow_miss/lift", json!({ "height": highest }));
    assert!(lit > 10 && lit * 20 < all && dark * 100 < all, "{lit} lit, {dark} dark");
    // The pieces are turned from 32 sides or so: r·(1 - cos(π/32)) is below a hundredth.
    assert!(highest < 0.01, "{highest}");
}

#[test]
fn a_light_without_size_costs_one_ray_and_no_noise() {
    let hard = picture(&[]);
    for sets in [["light size=0", "light samples=1"], ["light size=0", "light samples=64"]] {
        same_colors(&format!("{sets:?}"), NAME, &picture(&sets), &hard);
    }
}

#[test]
fn a_penumbra_lies_between_light_and_shadow() {
    for (light, size) in
        [("light=directional", "light size=0.05"), ("light=point", "light size=0.4")]
    {
        let soft = picture(&[light, size, "show=shadow"]);
        let hard = picture(&[light, "show=shadow"]);
        let (mut between, mut opposite) = (0, 0);
        for (soft, hard) in
            soft.pixels.iter().zip(&hard.pixels).filter(|(_, hard)| hard[0] == hard[2])
        {
            let part = soft[0] * 16.0;
            if hard[0] != 0.0 && hard[0] != 1.0 {
                continue; // the sky
            }
            assert!((0.0..=16.0).contains(&part) && part.fract() == 0.0, "{part} of 16");
            between += usize::from(part > 0.0 && part < 16.0);
            opposite += usize::from(part == 16.0 * (1.0 - hard[0]));
        }
        println!("{light}: {between} in the penumbra, {opposite} opposite");
        assert!(between > 2000, "{light}: {between}");
        // The middle of the light is one of the points that see it: dark there, hardly lit all around.
        assert!(opposite * 200 < soft.pixels.len(), "{light}: {opposite}");
    }
}

#[test]
fn a_penumbra_needs_no_luck() {
    let sets = ["light size=0.05", "light samples=5"];
    assert_eq!(bits(&picture(&sets)), bits(&picture(&sets)));
}

#[test]
fn ending_at_the_first_hit_changes_nothing() {
    for sets in [["light=directional", "light size=0"], ["light=point", "light size=0.3"]] {
        let [first, nearest] = ["first", "nearest"].map(|rays| {
            picture(&[&sets[..], &[format!("shadow rays={rays} hit").as_str()]].concat())
        });
        same_colors(&format!("{sets:?}"), NAME, &first, &nearest);
    }
}

#[test]
fn a_shadow_ray_changes_nothing_of_what_a_hit_is() {
    let [off, traced] =
        ["off", "first hit"].map(|rays| picture(&["show=hit", &format!("shadow rays={rays}")]));
    same_answers("with and without shadow rays", NAME, &off, &traced);
}

/// Whether a shadow ray started on the board's squares: flat, level, of two materials without textures.
fn is_on_a_square(&[x, y, z, lit]: &[f32; 4]) -> bool {
    lit >= 0.0 && y.abs() < 1e-4 && x.abs() < 3.99 && z.abs() < 3.99
}

#[test]
fn a_light_below_the_board_lights_nothing() {
    for terminator in ["smooth terminator=off", "smooth terminator=on"] {
        let below = ["light=point", "lamp position=0.3,-1,0.2", "show=shadow origin", terminator];
        let picture = picture(&below);
        let lit = picture.pixels.iter().find(|pixel| pixel[3] > 0.0);
        assert!(lit.is_none(), "{terminator}: {lit:?}");
    }
    // The sun on the horizon is within the plane of the board, and not above it.
    let level = picture(&["sun elevation=0", "show=shadow origin"]);
    let board = level.pixels.iter().filter(|pixel| is_on_a_square(pixel));
    assert!(board.clone().count() > 5000 && board.clone().all(|pixel| pixel[3] == 0.0));
}

#[test]
fn a_lamp_fades_with_the_square_of_the_distance() {
    let lamp = PointLight::default();
    let eye = Scene::chess().unwrap().camera.eye.as_vec3();
    let lit = picture(&["light=point"]);
    let dark = picture(&["light=point", "lamp position=0,-1,0"]);
    let origins = picture(&["light=point", "show=shadow origin"]);
    let mut compared = 0;
    for ((lit, dark), origin) in lit.pixels.iter().zip(&dark.pixels).zip(&origins.pixels) {
        let [x, y, z, seen] = *origin;
        if seen != 1.0 || !is_on_a_square(origin) {
            continue;
        }
        let (point, up) = (Vec3::new(x, y, z), Vec3::Y);
        let (to_light, view) = (lamp.position - point, (eye - point).normalize());
        let light = to_light.normalize();
        let highlight = up.dot((view + light).normalize()).max(0.0).powf(90.0) * 98.0 / 8.0;
        // In the dark there is the sky's light alone, which on a level square is known.
        let base = Vec3::new(dark[0], dark[1], dark[2]) / Vec3::new(0.42, 0.47, 0.55);
        let reflected = (base + 0.03 * highlight) * light.y / std::f32::consts::PI;
        let expected = lamp.intensity / to_light.length_squared() * reflected;
        let got = Vec3::new(lit[0] - dark[0], lit[1] - dark[1], lit[2] - dark[2]);
        assert!(
            (got - expected).abs().max_element() < 1e-3 * expected.max_element(),
            "{point}: {got} {expected}"
        );
        compared += 1;
    }
    assert!(compared > 1000, "{compared}");
}
