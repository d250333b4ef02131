//! 19_ray_cones: the definition of a footprint, its finiteness, and the difference of each from 1,024 rays
//! per pixel.

#[path = "../../samples/19_ray_cones/floor.rs"]
mod floor;
mod hard;
mod measured;
mod mipmaps;

use common::app::Picture;
use glam::DVec3;

use run::{Chapter, bits, compiled_for, same_answers, same_colors};

const NAME: &str = "19_ray_cones";
const SIZE: &str = "240x150";
const FOOTPRINTS: [&str; 4] = ["point", "cone", "ellipse", "differentials"];

fn chapter(size: &str) -> Chapter {
    Chapter::new(NAME).size(size)
}

/// A view of the bare floor, from a distance and at an angle, not along the texture's axes; displaced
/// sideways by `slid` pixels of the picture's height.
fn view(distance: f64, angle: f64, slid: f64) -> Vec<String> {
    let height = f64::from(floor::chess().expect("the scene").bounds().0.y);
    let angle = angle.to_radians();
    let aside = DVec3::new(-0.6, 0.0, 0.8);
    let slid = slid * pixel() * distance * aside;
    let target = DVec3::new(-1000.3, height, 100.7) + slid;
    // Straight from above, a minimal slant still determines the up direction.
    let away = (angle.cos() + 1e-6) * DVec3::new(0.8, 0.0, 0.6) + DVec3::new(0.0, angle.sin(), 0.0);
    let eye = target + distance * away;
    let point = |name: &str, at: DVec3| format!("camera {name}={},{},{}", at.x, at.y, at.z);
    vec![point("eye", eye), point("target", target), format!("field of view={FIELD_OF_VIEW}")]
}

const FIELD_OF_VIEW: f64 = 10.0;
/// The size of the pictures in that view.
const SMALL: &str = "48x30";

/// The width of a pixel at distance 1.
fn pixel() -> f64 {
    2.0 * (FIELD_OF_VIEW / 2.0).to_radians().tan() / 30.0
}

/// A picture of only the texture's colours, or of another view.
fn seen(from: &[String], sets: &[&str]) -> Picture {
    chapter(SMALL).sets(from).sets(&["show=color"]).sets(sets).picture()
}

#[test]
fn the_picture_repeats() {
    Chapter::new(NAME).repeats();
}

#[test]
fn a_point_gives_the_picture_of_05() {
    let of = |name: &str, sets: &[&str]| {
        let camera = ["camera eye=-5.6,4.8,9.2", "camera target=0.35,0.3,-0.2", "field of view=37"];
        let chapter = Chapter::new(name).size(SIZE).scene("samples/assets/chess.obj");
        chapter.sets(&camera).sets(sets).picture()
    };
    let parent = of("41_ray_offset", &[]);
    same_colors("a point", NAME, &of(NAME, &["footprint=point"]), &parent);
    let hits = of("41_ray_offset", &["show=hit"]);
    for footprint in FOOTPRINTS {
        let footprint = format!("footprint={footprint}");
        same_answers(&footprint, NAME, &of(NAME, &["show=hit", &footprint]), &hits);
    }
    assert_ne!(bits(&of(NAME, &["footprint=cone"])), bits(&parent), "a cone changes nothing");
}

/// The level is the binary logarithm of the number of texels per pixel; there are 64 of them in a unit.
#[test]
fn the_level_is_that_of_a_pixel_s_width() {
    levels_are_those_of_a_pixel_s_width(&[80.0]);
}

#[test]
#[ignore = "nightly: other distances; quick: ray_cones::the_level_is_that_of_a_pixel_s_width"]
fn so_it_is_near_and_far() {
    levels_are_those_of_a_pixel_s_width(&[20.0, 320.0]);
}

fn levels_are_those_of_a_pixel_s_width(distances: &[f64]) {
    let shaders = run::shaders_with(
        "19_ray_cones/shade.rchit",
        "hit.color = heat(0.1 * row.level);",
        "hit.color = vec3(row.level, row.count, 0.0);",
    );
    let middle = |footprint: &str, distance: f64, angle: f64| {
        let chapter = chapter(SMALL).shaders(shaders.path()).sets(&view(distance, angle, 0.0));
        let picture = chapter.sets(&["show=level"]).set("footprint", footprint).picture();
        let [level, count, ..] = picture.pixels[15 * 48 + 24];
        (f64::from(level), f64::from(count))
    };
    // The pixel's middle is half a pixel below that of the picture.
    let below = (0.5 * pixel()).atan();
    for &distance in distances {
        for angle in [90.0, 30.0, 10.0_f64] {
            let aimed = angle.to_radians();
            let slant = 1.0 / (aimed + below).sin();
            let texels = 64.0 * pixel() * distance * aimed.sin() * slant;
            // Half a pixel sideways changes lengths by 1 part in 100,000.
            let near = |found: f64, texels: f64| (found - texels.log2()).abs() < 0.01;
            let (level, count) = middle("cone", distance, angle);
            assert!(near(level, texels * slant) && count == 1.0, "{distance} {angle}: {level}");
            for footprint in ["ellipse", "differentials"] {
                let (level, count) = middle(footprint, distance, angle);
                assert_eq!(count, (slant - 0.1).ceil(), "{footprint} {distance} {angle}");
                assert!(near(level, texels), "{footprint} {distance} {angle}: {level}");
            }
        }
    }
}

#[test]
#[ignore = "nightly: compiles for a GPU; quick: gpus budgets::no_chapter_costs_a_gpu_more_than_is_recorded"]
fn its_program_spills_no_register() {
    for footprint in FOOTPRINTS {
        let set = format!("footprint={footprint}");
        let Some(programs) = compiled_for(NAME, "navi31", &["--set", &set]) else { return };
        assert_eq!(programs.len(), 1, "rays do not nest: one program");
        assert_eq!(programs[0]["spilled_registers"], 0, "{}", programs[0]);
    }
}
