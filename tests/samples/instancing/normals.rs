//! Normals transformed by each rung, compared with the inverse transpose.

use glam::Vec3;
use reference::transform::U;
use run::expected;
use serde_json::{Map, Value, json};

use super::{SPECIMEN, ViewedScene, absolute};

/// The errors of `normals` for the object-space normals whose bits the GPU wrote: for each pixel the piece,
/// the sine of the error's angle, and its bound if the inverse was rounded once.
fn normal_errors(viewed: &ViewedScene, sets: &[&str]) -> Vec<(usize, f64, f64)> {
    let show = |view| viewed.picture(&[&[SPECIMEN], sets, &[view]].concat());
    let (objects, worlds) = (show("show=object normal"), show("show=normal"));
    let pixels = objects.pixels.iter().zip(&worlds.pixels);
    let seen = pixels.filter(|(object, _)| object[3] >= 0.0);
    let errors = seen.map(|(&[x, y, z, index], &[r, g, b, _])| {
        let index = index as usize;
        let transform = viewed.transform(index);
        let object = Vec3::new(x, y, z).as_dvec3();
        let exact = transform.inverse.transpose() * object;
        let world = Vec3::new(r, g, b).as_dvec3() * 2.0 - 1.0;
        // The entry, the product and two sums; then normalizing, and 0.5 + 0.5 n of the picture.
        let strayed = absolute(transform.inverse).transpose() * object.abs() * 4.0;
        let bound = 1.01 * U * (strayed.length() / exact.length() + 2.0 * 3f64.sqrt());
        (index, exact.normalize().cross(world.normalize()).length(), bound)
    });
    errors.collect()
}

/// The largest errors, in degrees, of the normals by a sample's two inverses; compared with the bound.
pub fn by_the_inverses(viewed: &ViewedScene, sets: &[&str]) -> Map<String, Value> {
    let mut table = Map::new();
    println!("| normals | off by, in degrees, at most |");
    for normals in ["device inverse", "host inverse"] {
        let set = format!("normals={normals}");
        let errors = normal_errors(viewed, &[sets, &[&set]].concat());
        let worst = errors.iter().fold(0.0, |worst, &(_, sine, _)| f64::max(worst, sine));
        let degrees = worst.asin().to_degrees();
        println!("| {normals} | {degrees:.1e} |");
        table.insert(normals.replace(' ', "-"), json!(degrees));
        assert!(errors.len() > 2000, "{}", errors.len());
        // The specification does not bound the device's error, so it is not tested.
        if normals == "host inverse" {
            assert!(errors.iter().all(|(_, sine, bound)| sine <= bound), "{worst}");
        }
    }
    table
}

#[test]
fn normals_turn_with_the_inverse_transpose() {
    let viewed = ViewedScene::specimens();
    expected::hold("09_instancing/normals", by_the_inverses(&viewed, &[]).into());
    // By the matrix: right if it only rotates and mirrors, wrong if it shears or stretches.
    let first = viewed.pieces.len() - 6;
    // Two only rotated and mirrored, and four sheared or stretched.
    let mut most = [0f64; 6];
    for (index, sine, _) in normal_errors(&viewed, &["normals=matrix"]) {
        if let Some(knight) = index.checked_sub(first) {
            most[knight] = most[knight].max(sine.min(1.0).asin().to_degrees());
        }
    }
    println!("by the matrix, in degrees: {most:.5?}");
    let of_knight = |(knight, degrees): (usize, &f64)| (knight.to_string(), json!(degrees));
    let by_matrix: Map<_, _> = most.iter().enumerate().skip(2).map(of_knight).collect();
    expected::hold("09_instancing/by_matrix", by_matrix.into());
    let (rigid, deformed) = most.split_at(2);
    assert!(rigid.iter().all(|&degrees| degrees < 1e-4), "{most:?}");
    assert!(deformed.iter().all(|&degrees| degrees > 15.0), "{most:?}");
}
