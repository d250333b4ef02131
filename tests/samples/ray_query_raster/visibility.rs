//! Who sees what: every pixel of the rasteriser and of the rays, the reference deciding.

use common::app::Picture;
use common::scene::{Camera, Scene};
use glam::{DVec2, DVec3};
use reference::Ray;
use reference::scene::Scene as Exact;
use serde_json::json;

use run::primary_hits::{answer, rays, reference};
use run::{figures, render};

use super::NAME;

/// Width and height.
type Size = (u32, u32);

/// A pixel's fraction that a vertex is rounded to: of 8 bits on llvmpipe. It moves by half of that each way,
/// and so an edge by at most √2/2 of it; what the vertex shader rounds in 32 bits comes on top.
const SNAP: f64 = std::f64::consts::FRAC_1_SQRT_2 / 256.0 + 0.0002;

/// How the answers of a picture compare with the reference.
#[derive(Debug, Default)]
struct Count {
    agree: usize,
    /// Another answer, as the pixel's centre is nearer to an edge than vertices are rounded.
    edges: usize,
    /// Of those, other instances: a reader sees them.
    other_instances: usize,
    /// The nearest of the edges' distances that would have explained all of those, in pixels.
    reach: f64,
    /// A surface farther away than another that covers the pixel too.
    farther: usize,
    /// How much farther the farthest is.
    depth: f64,
    /// Nothing, where something covers the pixel.
    lost: usize,
    /// Nothing explains it.
    wrong: Vec<String>,
}

/// A camera in f64, which finds the place of a point in the picture.
struct Projection {
    camera: Camera,
    size: Size,
}

impl Projection {
    /// In pixels from the top left corner.
    fn place(&self, point: DVec3) -> DVec2 {
        let [right, up, forward] = self.camera.axes();
        let way = point - self.camera.eye;
        let (width, height) = (f64::from(self.size.0), f64::from(self.size.1));
        let half = (self.camera.fov_y.to_radians() / 2.0).tan() * way.dot(forward);
        let (x, y) = (way.dot(right) / (half * width / height), way.dot(up) / half);
        DVec2::new((x + 1.0) * width / 2.0, (1.0 - y) * height / 2.0)
    }

    /// How far inside a triangle the middle of a pixel is: negative outside.
    fn margin(&self, pixel: usize, triangle: &[DVec3; 3]) -> f64 {
        let width = self.size.0 as usize;
        let middle = DVec2::new((pixel % width) as f64 + 0.5, (pixel / width) as f64 + 0.5);
        let [a, b, c] = triangle.map(|corner| self.place(corner));
        let around = (b - a).perp_dot(c - a).signum();
        let inside = |from: DVec2, to: DVec2| {
            around * (to - from).perp_dot(middle - from) / (to - from).length()
        };
        inside(a, b).min(inside(b, c)).min(inside(c, a))
    }
}

fn count(exact: &Exact, projection: &Projection, hits: &Picture, rays: &[Ray], snap: f64) -> Count {
    let mut count = Count::default();
    for (pixel, (hit, ray)) in hits.pixels.iter().zip(rays).enumerate() {
        let expected = exact.closest_hit(ray, |_| true).map(|hit| (hit.instance, hit.primitive));
        let found = answer(hit).map(|found| (found.instance, found.primitive));
        if found == expected {
            count.agree += 1;
            continue;
        }
        let margin = |(instance, primitive): (u32, u32)| {
            projection.margin(pixel, exact.triangle(instance, primitive).expect("a triangle"))
        };
        let t = |(instance, primitive): (u32, u32)| {
            exact.candidate_at(ray, instance, primitive).expect("a triangle").hit.t
        };
        // The answer covers the pixel only if an edge moves, or what should cover it does not.
        let needed = found.map_or(0.0, |found| -margin(found)).max(0.0);
        let missed = expected.map_or(f64::INFINITY, margin);
        let reach = if needed > 0.0 { needed } else { missed };
        if reach <= snap {
            count.edges += 1;
            let instance = |of: Option<(u32, u32)>| of.map(|(instance, _)| instance);
            count.other_instances += usize::from(instance(found) != instance(expected));
            count.reach = count.reach.max(reach);
        } else if let (Some(found), Some(expected)) = (found, expected)
            && needed == 0.0
        {
            count.farther += 1;
            count.depth = count.depth.max(t(found) - t(expected));
        } else if found.is_none() {
            count.lost += 1;
        } else {
            count.wrong.push(format!("{pixel}: {found:?}, not {expected:?}; {needed}, {missed}"));
        }
    }
    count
}

/// The counts of the rasteriser and of the rays, of this view and with these settings.
fn compared(size: Size, camera: &Camera, sets: &[&str]) -> [Count; 2] {
    compared_in("driver", SNAP, size, camera, sets)
}

/// The same in an arithmetic, in which edges move by so much of a pixel.
fn compared_in(
    arithmetic: &str,
    snap: f64,
    size: Size,
    camera: &Camera,
    sets: &[&str],
) -> [Count; 2] {
    let exact = reference(&Scene::chess().unwrap());
    let projection = Projection { camera: *camera, size };
    let Camera { eye, target, fov_y, .. } = camera;
    let settings = [
        format!("camera eye={},{},{}", eye.x, eye.y, eye.z),
        format!("camera target={},{},{}", target.x, target.y, target.z),
        format!("field of view={fov_y}"),
        "occlusion rays=0".to_owned(),
    ];
    let settings: Vec<&str> =
        settings.iter().map(String::as_str).chain(sets.iter().copied()).collect();
    let size = format!("{}x{}", size.0, size.1);
    let shown = |more: &[&str]| {
        let sets = settings.iter().chain(more).flat_map(|&set| ["--set", set]);
        let arguments: Vec<&str> = ["--arithmetic", arithmetic].into_iter().chain(sets).collect();
        render(NAME, &size, &arguments).picture
    };
    let directions = shown(&["show=ray direction"]);
    let rays: Vec<Ray> = rays(camera, &directions).collect();
    ["primary=raster", "primary=rays"]
        .map(|primary| count(&exact, &projection, &shown(&["show=hit", primary]), &rays, snap))
}

#[test]
fn raster_and_rays_see_what_the_reference_sees_but_for_edges() {
    let camera = Scene::chess().unwrap().camera;
    let [raster, rays] = compared((480, 300), &camera, &[]);
    println!("{raster:?}\n{rays:?}");
    for found in [&raster, &rays] {
        assert!(found.wrong.is_empty(), "{:?}", found.wrong);
        assert_eq!((found.farther, found.lost), (0, 0), "{found:?}");
    }
    // A ray's edges are off by its roundings alone.
    assert!(rays.edges < raster.edges && rays.reach < 0.0002, "{rays:?}");
    assert!(raster.edges > 30, "{raster:?}");
    figures::hold(
        "17_ray_query_raster/visibility",
        json!({
            "pixels": 480 * 300,
            "raster_edges": raster.edges,
            "raster_instances": raster.other_instances,
            "raster_reach": raster.reach,
            "rays_edges": rays.edges,
            "rays_instances": rays.other_instances,
            "rays_reach": rays.reach,
        }),
    );
}

/// All triangles at a corner compute its place alike, however inexactly: edges move, and no crack opens.
#[test]
fn no_crack_opens_in_the_worst_arithmetic() {
    let camera = Scene::chess().unwrap().camera;
    // A corner is some 40 roundings of 12 units off, of which a pixel is 0.05.
    let snap = SNAP + 40.0 * 12.0 * f64::from(f32::EPSILON) / 0.05;
    for arithmetic in ["worst", "worst-by-place"] {
        let [raster, _] = compared_in(arithmetic, snap, (240, 150), &camera, &[]);
        println!("{arithmetic}: {raster:?}");
        assert!(raster.wrong.is_empty(), "{:?}", raster.wrong);
        assert_eq!((raster.farther, raster.lost), (0, 0), "{raster:?}");
    }
}

/// The same view from farther and farther away, by a telescope: what the depth test mistakes.
#[test]
fn reversed_floats_tell_near_from_far_where_others_do_not() {
    let here = Scene::chess().unwrap().camera;
    let mut found = serde_json::Map::new();
    let mut mistaken = |times: f64, name: &str, depth: &str| {
        let eye = here.target + times * (here.eye - here.target);
        let half = (here.fov_y.to_radians() / 2.0).tan() / times;
        let camera = Camera { eye, fov_y: 2.0 * half.atan().to_degrees(), ..here };
        let set = format!("depth={depth}");
        let [raster, _] = compared((120, 75), &camera, &[&set]);
        let Count { farther, lost, depth: by, .. } = raster;
        println!("{times} {depth}: {farther} farther, by {by}, {lost} lost");
        assert!(raster.wrong.is_empty(), "{:?}", raster.wrong);
        found.insert(format!("{name}_{times}"), (farther + lost).into());
        farther + lost
    };
    for times in [1.0, 10.0, 100.0] {
        let reversed = mistaken(times, "reversed", "reversed float");
        let usual = mistaken(times, "usual", "usual float");
        let short = mistaken(times, "short", "usual 16 bits");
        assert!(reversed <= usual && usual <= short, "{reversed} {usual} {short}");
        assert_eq!(reversed, 0, "{times}");
        assert!(times < 100.0 || usual > 500, "{usual}");
    }
    figures::hold("17_ray_query_raster/depth", found.into());
}
