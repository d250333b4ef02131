//! Ambient occlusion on a plane beside a box, held to the closed form.

use common::app::Picture;
use common::scene::Camera;
use glam::DVec3;
use reference::occlusion::standing_box;
use serde_json::json;

use run::primary_hits::{answer, rays};
use run::{Run, expected, root};

use super::{NAME, chapter};

const SIZE: &str = "96x60";
/// The corners of the box in `box_on_plane.obj`.
const BOX: [DVec3; 2] = [DVec3::new(-1.0, 0.0, -1.0), DVec3::new(1.0, 1.5, 1.0)];

fn run_of(sets: &[&str], frames: u32) -> Run {
    let scene = root().join("samples/assets/box_on_plane.obj");
    let view = ["camera eye=5,4,6", "camera target=0,0.2,0", "field of view=45"];
    chapter(SIZE).scene(scene).frames(frames).sets(&view).sets(sets).run()
}

/// The part of the sky that each pixel of the plane sees: its number, and the exact part.
fn exact() -> Vec<(usize, f64)> {
    let camera = Camera::new(DVec3::new(5.0, 4.0, 6.0), DVec3::new(0.0, 0.2, 0.0), 45.0);
    let show = |view| run_of(&[view, "occlusion rays=0"], 1).picture;
    let (hits, directions) = (show("show=hit"), show("show=ray direction"));
    let pixels = rays(&camera, &directions).zip(&hits.pixels).enumerate();
    let plane = pixels.filter_map(|(pixel, (ray, hit))| {
        let point = ray.at(f64::from(answer(hit)?.t));
        // The plane is what lies at no height; that is exact up to the rounding of t.
        (answer(hit)?.instance == 0).then(|| {
            assert!(point.y.abs() < 1e-4, "{point}");
            (pixel, 1.0 - standing_box(point.with_y(0.0), BOX[0], BOX[1]))
        })
    });
    plane.collect()
}

fn root_mean_square(pixels: &[(usize, f64)], picture: &Picture) -> f64 {
    let errors = pixels.iter().map(|&(pixel, open)| f64::from(picture.pixels[pixel][0]) - open);
    (errors.map(|error| error * error).sum::<f64>() / pixels.len() as f64).sqrt()
}

#[test]
fn the_mean_of_many_rays_is_the_closed_form() {
    run::needs!(NAME);
    let pixels = exact();
    assert!(pixels.len() > 2000, "{}", pixels.len());
    // With one ray per pixel each is open or not, and independent of its neighbours.
    let picture = run_of(&["show=ambient occlusion", "occlusion rays=1"], 1).picture;
    let found: f64 = pixels.iter().map(|&(pixel, _)| f64::from(picture.pixels[pixel][0])).sum();
    let expected: f64 = pixels.iter().map(|(_, open)| open).sum();
    let deviation = pixels.iter().map(|(_, open)| open * (1.0 - open)).sum::<f64>().sqrt();
    let off = (found - expected) / deviation;
    println!("{} pixels, {found} open, {expected} expected: {off} deviations", pixels.len());
    assert!(off.abs() < 3.0, "{found} of {expected}: {off} standard deviations");
    // The same beside the box alone, where most is hidden.
    let dark: Vec<_> = pixels.iter().copied().filter(|(_, open)| *open < 0.7).collect();
    let found: f64 = dark.iter().map(|&(pixel, _)| f64::from(picture.pixels[pixel][0])).sum();
    let expected: f64 = dark.iter().map(|(_, open)| open).sum();
    let deviation = dark.iter().map(|(_, open)| open * (1.0 - open)).sum::<f64>().sqrt();
    assert!(dark.len() > 50 && (found - expected).abs() < 3.0 * deviation, "{found} {expected}");
}

#[test]
fn the_error_falls_faster_than_by_the_root_of_the_rays() {
    run::needs!(NAME);
    let pixels = exact();
    let variance: f64 = pixels.iter().map(|(_, open)| open * (1.0 - open)).sum();
    let one = (variance / pixels.len() as f64).sqrt();
    let (mut held, mut timed) = (serde_json::Map::new(), serde_json::Map::new());
    held.insert("pixels".to_owned(), pixels.len().into());
    for count in [1u32, 4, 16, 64, 256] {
        let set = format!("occlusion rays={count}");
        let run = run_of(&["show=ambient occlusion", &set], 3);
        let error = root_mean_square(&pixels, &run.picture);
        let independent = one / f64::from(count).sqrt();
        println!("{count}: {error:.5}, independent {independent:.5}");
        // The points of a spiral keep apart, and so err less; a single point has no other to keep away from.
        let most = if count == 1 { 1.1 } else { 0.9 };
        assert!(error < most * independent, "{count}: {error}, {independent}");
        held.insert(format!("error_{count}"), json!(error));
        held.insert(format!("independent_{count}"), json!(independent));
        timed.insert(format!("ms_{count}"), run.report["gpu_milliseconds"]["median"].clone());
    }
    expected::hold("17_ray_query_raster/occlusion", held.into());
    expected::give_timed("17_ray_query_raster/occlusion_times", timed.into());
}
