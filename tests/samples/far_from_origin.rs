//! 39_far_from_origin: the accuracy of coordinates, object rays and normals far from the origin.

use glam::{DVec3, Vec3};
use reference::transform::U;
use run::{Chapter, expected, same_colors};
use serde_json::{Map, json};

use super::instancing::normals::by_the_inverses;
use super::instancing::{SPECIMEN, ViewedScene, absolute, percent_changed};

const NAME: &str = "39_far_from_origin";
const SIZE: &str = "120x75";

fn chapter() -> Chapter {
    Chapter::new(NAME).size(SIZE)
}

/// The knights at a control's position, in world coordinates: the control's value, and the scene.
fn specimens(far: f64) -> (String, ViewedScene) {
    let viewed = ViewedScene::moved_specimens(NAME, DVec3::new(far, 0.0, far));
    (format!("far={far}"), viewed)
}

/// The steps of the origin are powers of two, so that a million leaves no remainder.
#[test]
fn camera_relative_coordinates_are_the_same_bits_a_million_units_away() {
    let [near, far] = ["far=0", "far=1000000"].map(|far| chapter().sets(&[far]).picture());
    same_colors("near and far", NAME, &near, &far);
}

#[test]
fn far_away_only_camera_relative_coordinates_keep_the_picture() {
    changed_by_distance(&["1000000"]);
}

#[test]
#[ignore = "nightly: 18 pictures; quick: far_from_origin::far_away_only_camera_relative_coordinates_keep_the_picture"]
fn so_they_do_at_four_distances() {
    let table = changed_by_distance(&["10000", "100000", "1000000", "1234567.9"]);
    expected::hold("39_far_from_origin/coordinates", table.into());
}

/// The fraction of pixels with another triangle, or another shadow, than near the origin.
fn changed_by_distance(distances: &[&str]) -> Map<String, serde_json::Value> {
    let sets = |far: &str, coordinates: &str, show: &str| {
        chapter().sets(&[far, coordinates, show]).picture()
    };
    let [relative, world] = ["coordinates=camera-relative", "coordinates=world"];
    let near = |show| sets("far=0", relative, show);
    let (hits, shadows) = (near("show=hit"), near("show=shadow"));
    println!("| far | coordinates | another triangle | another shadow |");
    let mut rows = Vec::new();
    for far in distances {
        for coordinates in [world, relative] {
            let far = format!("far={far}");
            let moved = sets(&far, coordinates, "show=hit");
            let shadow = sets(&far, coordinates, "show=shadow");
            let triangles = percent_changed(&hits, &moved);
            let dark = percent_changed(&shadows, &shadow);
            println!("| {far} | {coordinates} | {triangles:.2} % | {dark:.2} % |");
            rows.push((coordinates == world, far, triangles, dark));
        }
    }
    let (mut table, mut most) = (Map::new(), [0f64; 2]);
    for (is_world, far, triangles, dark) in rows {
        let far = far.trim_start_matches("far=");
        let distance: f64 = far.parse().unwrap();
        if is_world {
            table.insert(format!("{far}.triangles"), json!(triangles / 100.0));
            table.insert(format!("{far}.shadows"), json!(dark / 100.0));
        } else {
            most = [most[0].max(triangles / 100.0), most[1].max(dark / 100.0)];
        }
        if !is_world {
            assert!(triangles < 0.05 && dark < 0.05, "{far}: {triangles} {dark}");
        } else if distance >= 1e6 {
            assert!(triangles > 20.0 && dark > 5.0, "{far}: {triangles} {dark}");
        }
    }
    table.insert("relative.triangles".to_owned(), json!(most[0]));
    table.insert("relative.shadows".to_owned(), json!(most[1]));
    table
}

#[test]
fn both_coordinates_side_by_side_are_the_two_pictures() {
    let show = |coordinates: &str| chapter().set("coordinates", coordinates).picture();
    let [both, world, relative] = ["both", "world", "camera-relative"].map(show);
    assert!(percent_changed(&world, &relative) > 20.0);
    for (index, pixel) in both.pixels.iter().enumerate() {
        let half = if index % 120 < 60 { &world } else { &relative };
        assert_eq!(pixel, &half.pixels[index], "pixel {index}");
    }
}

/// Normals do not depend on the place: their matrix contains no translation.
#[test]
fn normals_are_as_good_far_away() {
    let (far, viewed) = specimens(1e6);
    let table = by_the_inverses(&viewed, &["coordinates=world", &far]);
    expected::hold("39_far_from_origin/normals", table.into());
}

/// The ray's origin in the space of each visible piece: the error of each rung, relative to the bound of
/// `L^-1·(o - T)`.
fn origin_errors(viewed: &ViewedScene, sets: &[&str]) -> Vec<(usize, f64, f64)> {
    let origins = chapter().sets(sets).sets(&["show=object origin"]).picture();
    let seen = origins.pixels.iter().filter(|pixel| pixel[3] >= 0.0);
    let errors = seen.map(|&[x, y, z, index]| {
        let transform = viewed.transform(index as usize);
        let apart = viewed.camera.eye.as_vec3().as_dvec3() - transform.translation;
        let exact = transform.inverse * apart;
        // The difference, the entries and the sum of three products: 1 + 1 + 3 roundings.
        let bound = 1.01 * 5.0 * U * (absolute(transform.inverse) * apart.abs());
        let error = (Vec3::new(x, y, z).as_dvec3() - exact).abs();
        let relative = error.length() / exact.length();
        (index as usize, relative, (error / bound).max_element())
    });
    errors.collect()
}

#[test]
fn the_difference_first_keeps_the_object_space_origin() {
    let mut table = Map::new();
    println!("| far | object ray | error, relative, most | parts of the bound |");
    for far in [0.0, 1e3, 1e6] {
        let (far_set, viewed) = specimens(far);
        let first = viewed.pieces.len() - 6;
        for rung in ["device", "matrix", "inverse"] {
            let rung_set = format!("object ray={rung}");
            let sets = [SPECIMEN, "coordinates=world", &far_set, &rung_set];
            let errors = origin_errors(&viewed, &sets);
            let knights = errors.iter().filter(|(index, ..)| *index >= first);
            let worst = knights.clone().fold(0.0, |worst, (_, error, _)| f64::max(worst, *error));
            let part = knights.clone().fold(0.0, |worst, (.., part)| f64::max(worst, *part));
            println!("| {far} | {rung} | {worst:.1e} | {part:.1} |");
            table.insert(format!("{far}.{rung}"), json!(worst));
            assert!(knights.count() > 300);
            if rung == "inverse" {
                assert!(errors.iter().all(|(.., part)| *part <= 1.0), "{far}: {part}");
            } else if far == 1e6 {
                assert!(part > 1000.0, "{rung}: {part}");
            }
        }
    }
    expected::hold("39_far_from_origin/object_ray", table.into());
}
