//! 20_wireframe: lines have the requested width, wherever the triangle is and however it is rotated.

use std::fs;

use common::app::Picture;

use run::{Chapter, expected, render};
use serde_json::Map;

const NAME: &str = "20_wireframe";

#[test]
fn the_picture_repeats() {
    run::needs!(NAME);
    Chapter::new(NAME).repeats();
}

/// Two triangles that share a vertical edge in the middle of the picture.
struct Diamond {
    /// Half the length of its diagonals.
    size: f64,
    /// The distance of the eye.
    distance: f64,
    /// The angle of the eye around it, in degrees: at 90 it would be seen edge-on.
    turned: f64,
    /// Half of the height visible at this distance.
    shown: f64,
}

/// A diamond that fills the picture, seen from the front.
const FRONT: Diamond = Diamond { size: 1.0, distance: 2.0, turned: 0.0, shown: 0.5 };

impl Diamond {
    /// A picture of its lines, drawn with this width.
    fn picture(&self, width: f64, more: &[&str]) -> Picture {
        let folder = tempfile::tempdir().expect("a temporary folder");
        let file = folder.path().join("diamond.obj");
        let s = self.size;
        // Not at round numbers, so that no product of coordinates is exact. The edge from 2 to 4 is vertical.
        let corners = [
            [1.013, 0.021, 0.003],
            [0.0, 0.987, 0.013],
            [-0.991, -0.017, 0.007],
            [0.0, -1.009, -0.011],
        ];
        let vertex = |[x, y, z]: [f64; 3]| format!("v {} {} {}\n", x * s, y * s, z * s);
        let text = corners.map(vertex).concat() + "f 1 2 4\nf 3 4 2\n";
        fs::write(&file, text).expect("an OBJ file");
        let (sin, cos) = self.turned.to_radians().sin_cos();
        let sets = [
            format!("camera eye={},0,{}", self.distance * sin, self.distance * cos),
            "camera target=0,0,0".to_owned(),
            format!("field of view={}", 2.0 * (self.shown / self.distance).atan().to_degrees()),
            format!("line width={width}"),
            "show=lines".to_owned(),
        ];
        Chapter::new(NAME).size("97x61").scene(file).sets(&sets).with(more).picture()
    }

    /// The width of the middle line in a picture, in pixels: the amount of ink per row.
    fn measured(&self, width: f64, more: &[&str]) -> f64 {
        ink(&self.picture(width, more), 30, (width / 2.0 + 1.0).ceil() as usize)
    }
}

/// The ink in the middle of a row, up to `reach` pixels on both sides.
fn ink(picture: &Picture, row: usize, reach: usize) -> f64 {
    let columns = picture.width as usize;
    let middle = row * columns + columns / 2;
    let pixels = &picture.pixels[middle - reach..=middle + reach];
    pixels.iter().map(|pixel| 1.0 - f64::from(pixel[0])).sum()
}

#[test]
fn a_line_is_as_wide_as_asked() {
    run::needs!(NAME);
    for width in [0.25, 0.5, 1.0, 1.5, 2.0, 3.0, 7.0, 20.0] {
        let measured = FRONT.measured(width, &[]);
        assert!((measured - width).abs() < 1e-3, "{width}: {measured}");
    }
}

#[test]
fn its_width_does_not_depend_on_size_distance_or_slant() {
    run::needs!(NAME);
    for turned in [0.0, 45.0, -60.0, 80.0, 85.0] {
        let measured = Diamond { size: 3.0, distance: 6.0, turned, shown: 0.5 }.measured(3.0, &[]);
        assert!((measured - 3.0).abs() < 1e-3, "turned by {turned} degrees: {measured}");
    }
    // The largest accepted size reaches 1e9.
    for size in [1e-12, 1e-3, 0.1, 10.0, 1e4, 9e8] {
        let diamond = Diamond { size, distance: 2.0 * size, turned: 30.0, shown: 0.5 * size };
        let measured = diamond.measured(3.0, &[]);
        assert!((measured - 3.0).abs() < 1e-3, "a diamond of {size}: {measured}");
    }
    let mut table = Map::new();
    for distance in [1e1, 1e2, 1e3, 1e4, 1e5] {
        let measured = Diamond { distance, turned: 30.0, ..FRONT }.measured(3.0, &[]);
        println!("| {distance:e} | {measured:.4} |");
        table.insert(format!("{distance:e}"), measured.into());
        // A pixel is 1/61 over the distance wide, seen from the eye, and each side of the line may be off by
        // a last place of the direction, 2^-24.
        let rounding = 2.0 * 61.0 * distance / f64::from(1 << 24);
        assert!((measured - 3.0).abs() < 1e-3 + rounding, "from {distance}: {measured}");
    }
    expected::hold("20_wireframe/widths", table.into());
}

#[test]
fn a_line_of_constant_weight_is_as_wide_as_its_triangle_is_large() {
    run::needs!(NAME);
    let weight = ["--set", "constant=barycentric"];
    let width = |diamond: Diamond| diamond.measured(10.0, &weight);
    let whole = width(FRONT);
    let half = width(Diamond { size: 0.5, ..FRONT });
    let turned = width(Diamond { turned: 60.0, ..FRONT });
    // A tenth of the triangle's width on either side, in whole pixels. The whole triangle is 61 pixels wide.
    for (measured, width) in [(whole, 12.2), (half, 6.1), (turned, 6.1)] {
        assert!((measured - width).abs() < 1.0, "{measured}, not {width}");
    }
}

/// Many small triangles: a long lens far away shows the same lines.
#[test]
fn a_scene_has_as_much_ink_from_afar() {
    run::needs!(NAME);
    let ink = |distance: f64| -> f64 {
        let eye = [0.6, 0.45, 0.66].map(|x| (x * distance).to_string()).join(",");
        let degrees = 2.0 * (4.2 / distance).atan().to_degrees();
        let sets = [
            format!("camera eye={eye}"),
            "camera target=0,0.2,0".to_owned(),
            format!("field of view={degrees}"),
            "show=lines".to_owned(),
        ];
        let picture = Chapter::new(NAME).size("240x150").sets(&sets).picture();
        picture.pixels.iter().map(|pixel| 1.0 - f64::from(pixel[0])).sum()
    };
    let near = ink(100.0);
    for distance in [1e3, 1e4] {
        let far = ink(distance);
        assert!((far / near - 1.0).abs() < 0.02, "from {distance}: {far}, from 100: {near}");
    }
}

/// A vertex behind the eye has no position in the picture, but the edge to it has.
#[test]
fn edges_to_corners_behind_the_eye_are_as_wide() {
    run::needs!(NAME);
    let folder = tempfile::tempdir().expect("a temporary folder");
    let file = folder.path().join("ground.obj");
    // The shared edge passes under the eye, from far ahead to far behind.
    let text = "v -50 0 -3\nv 0 0 -50\nv 50 0 3\nv 0 0 50\nf 1 4 2\nf 3 2 4\n";
    fs::write(&file, text).expect("an OBJ file");
    let sets = ["camera eye=0,1,0", "camera target=0,0.6,-1", "line width=4", "show=lines"];
    let picture = Chapter::new(NAME).size("97x61").scene(&file).sets(&sets).picture();
    for row in [30, 40, 50, 60] {
        let measured = ink(&picture, row, 20);
        assert!((measured - 4.0).abs() < 1e-3, "row {row}: {measured}");
    }
}

#[test]
fn hidden_lines_are_fainter_and_leave_what_is_seen_as_it_is() {
    run::needs!(NAME);
    let [seen, all] = ["off", "on"].map(|hidden| {
        let hidden = format!("hidden lines={hidden}");
        render(NAME, "120x75", &["--set", "show=lines", "--set", &hidden]).picture
    });
    let mut fainter = 0;
    for (seen, all) in seen.pixels.iter().zip(&all.pixels) {
        // Hidden lines add at most a third of the missing ink.
        let ink = [seen, all].map(|pixel| 1.0 - pixel[0]);
        assert!(ink[1] >= ink[0] - 1e-6 && ink[1] <= ink[0] + 0.34 * (1.0 - ink[0]), "{ink:?}");
        fainter += usize::from(ink[1] > ink[0] + 0.1);
    }
    assert!(fainter > 100, "{fainter} pixels show what is hidden");
}
