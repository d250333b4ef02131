//! 43_filtered_checker: the mean of the squares in each pixel, compared with many rays.

use serde_json::json;

use crate::infinite_plane::{Octahedron, PLANE};
use run::{Chapter, expected, same_colors};

const NAME: &str = "43_filtered_checker";

#[test]
fn the_checker_board_is_averaged_over_each_pixel() {
    let model = Octahedron::out_of_sight();
    // From above to the horizon.
    let sets = [
        "camera eye=0.3,1.5,0.2",
        "camera target=1,0.9,-2",
        "field of view=60",
        "plane reflection=0",
        "light squares=1,1,1",
        "dark squares=0,0,0",
    ];
    // The albedo of the plane, its brightness, and its distance.
    let light = |name: &str, size: &str, more: &[&str]| {
        let [hits, squares] = ["hit", "triangle"].map(|show| {
            Chapter::new(name)
                .size(size)
                .sets(&sets)
                .sets(more)
                .set("show", show)
                .scene(model.path())
                .picture()
                .pixels
        });
        let both = hits.iter().zip(squares).map(|(hit, square)| [hit[0], square[0], hit[2]]);
        both.collect::<Vec<_>>()
    };
    const FINE: usize = 12;
    let (width, height) = (64, 40);
    let filtered = light(NAME, "64x40", &[]);
    let point = light(NAME, "64x40", &["checker=point"]);
    let faded = light("12_infinite_plane", "64x40", &[]);
    let fine = light(NAME, "768x480", &["checker=point"]);
    let (mut count, mut errors, mut worst) = (0, [0.0; 3], 0.0f32);
    for (row, column) in (0..height).flat_map(|row| (0..width).map(move |column| (row, column))) {
        let pixels = (0..FINE * FINE).map(|i| {
            let (y, x) = (row * FINE + i / FINE, column * FINE + i % FINE);
            fine[y * width * FINE + x]
        });
        let pixels: Vec<_> = pixels.collect();
        if pixels.iter().any(|pixel| pixel[0] != PLANE) {
            continue;
        }
        let mean = pixels.iter().map(|pixel| pixel[1]).sum::<f32>() / pixels.len() as f32;
        let at = row * width + column;
        count += 1;
        let off = |squares: &[[f32; 3]]| (squares[at][1] - mean).abs();
        worst = worst.max(off(&filtered));
        for (sum, squares) in errors.iter_mut().zip([&filtered, &point, &faded]) {
            *sum += off(squares);
        }
    }
    let [filtered_error, point_error, faded_error] = errors.map(|sum| sum / count as f32);
    println!(
        "{count} pixels: filtered off by {filtered_error:.3} (most {worst:.2}), at the middle by \
         {point_error:.3}, faded by {faded_error:.3}"
    );
    let found = json!({
        "rays": FINE * FINE, "filtered": filtered_error, "point": point_error, "faded": faded_error,
    });
    expected::hold("43_filtered_checker/checker", found);
    assert!(count > 1000 && filtered_error < 0.06 && point_error > 4.0 * filtered_error);
    assert!(faded_error > 1.5 * filtered_error, "{faded_error}");
    // Towards the horizon everything is grey, and nothing is cut off.
    let horizon = filtered.iter().filter(|pixel| pixel[0] == PLANE && pixel[2] > 60.0);
    assert!(horizon.clone().count() > 40);
    assert!(horizon.clone().all(|pixel| (pixel[1] - 0.5).abs() < 0.05));
}

#[test]
fn every_ray_meets_what_it_meets_in_12() {
    for show in ["hit", "normal", "shadow"] {
        let [one, other] = [NAME, "12_infinite_plane"]
            .map(|name| Chapter::new(name).size("120x75").set("show", show).picture());
        same_colors(show, NAME, &one, &other);
    }
}

#[test]
fn near_squares_are_those_of_12() {
    // From above, where 12 does not fade the squares.
    let sets = ["camera eye=0.3,6.1,4.2", "camera target=0.1,0,0.05", "show=triangle"];
    let model = Octahedron::out_of_sight();
    let show = |name: &str, more: &[&str]| {
        let chapter = Chapter::new(name).size("120x75").sets(&sets).sets(more);
        chapter.scene(model.path()).picture().pixels
    };
    let (one, other) = (show(NAME, &["checker=point"]), show("12_infinite_plane", &[]));
    // A ray at the border of two squares may be rounded to either.
    let differ = one.iter().zip(&other).filter(|(a, b)| (a[0] - b[0]).abs() > 0.01).count();
    assert!(differ * 200 < one.len(), "{differ} of {} pixels", one.len());
}
