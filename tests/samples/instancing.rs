//! 09_instancing: every matrix, mask and flag held to the reference, and the set moved far away.

use std::cell::OnceCell;

use common::app::Picture;
use common::scene::{self, Camera, Scene, Sun};
use glam::{DMat3, DVec3, Vec3};
use reference::scene::Scene as Exact;
use reference::transform::{Transform, U};
use reference::{Ray, hit::Hit};

use run::exact::{Tally, answer, judge, rays, reference};
use run::{Run, bits, golden, render};

#[allow(dead_code)]
#[path = "../../samples/09_instancing/formation.rs"]
mod formation;

use formation::{BLACK, BOARD, Formation, Piece, SPECIMENS, WHITE};

const NAME: &str = "09_instancing";
const SIZE: &str = "120x75";
const SPECIMEN: &str = "scene=specimens";
/// Few enough pieces for the reference to hold a copy of each.
const FEW: [&str; 3] = ["squares=60", "camera eye=1,5,8", "camera target=0,0.8,0"];

fn run(size: &str, sets: &[&str]) -> Run {
    let arguments: Vec<&str> = sets.iter().flat_map(|&set| ["--set", set]).collect();
    render(NAME, size, &arguments)
}

fn picture(sets: &[&str]) -> Picture {
    run(SIZE, sets).picture
}

/// A scene as it is placed: its pieces, and the same for the reference.
struct Placed {
    pieces: Vec<Piece>,
    exact: Exact,
    camera: Camera,
    shift: DVec3,
    /// What `show=ray direction` wrote: no control but the camera's changes it.
    directions: OnceCell<Picture>,
}

impl Placed {
    /// A scene and a view of it, moved by `far` and seen from the origin of its coordinates.
    fn new(scene: u32, squares: u32, mut camera: Camera, far: f64, is_relative: bool) -> Self {
        let meshes = formation::meshes().unwrap();
        let pieces = Formation::new(scene, squares, &meshes.model).unwrap().pieces;
        let moved = DVec3::new(far, 0.0, far);
        let step = ((camera.eye + moved) / 16.0).round() * 16.0;
        let shift = moved - if is_relative { step } else { DVec3::ZERO };
        camera.eye += shift;
        let instances = pieces.iter().map(|piece| piece.instance(shift)).collect();
        let exact = reference(&Scene { model: meshes.model, instances, camera });
        Self { pieces, exact, camera, shift, directions: OnceCell::new() }
    }

    fn specimens() -> Self {
        Self::new(SPECIMENS, 0, formation::camera(SPECIMENS), 0.0, true)
    }

    fn few() -> Self {
        let camera = Camera::new(DVec3::new(1.0, 5.0, 8.0), DVec3::new(0.0, 0.8, 0.0), 36.0);
        Self::new(0, 60, camera, 0.0, true)
    }

    /// The matrix of a piece, as the device has it.
    fn transform(&self, index: usize) -> Transform {
        let rows = scene::transform(&self.pieces[index].instance(self.shift).transform).matrix;
        let row = |i: usize| std::array::from_fn(|k| rows[4 * i + k]);
        Transform::from_rows([row(0), row(1), row(2)]).unwrap()
    }

    /// The rays of a picture with what they hit.
    fn hits(&self, sets: &[&str]) -> Vec<(Ray, [f32; 4])> {
        let show = |view| picture(&[sets, &[view]].concat());
        let directions = self.directions.get_or_init(|| show("show=ray direction"));
        rays(&self.camera, directions).zip(show("show=hit").pixels).collect()
    }
}

/// Which piece each pixel shows; `None` for the sky.
fn indices(hits: &Picture) -> impl Iterator<Item = Option<usize>> {
    hits.pixels.iter().map(|pixel| (pixel[0] >= 0.0).then_some(pixel[0] as usize))
}

#[test]
fn the_picture_is_the_golden_one() {
    // Tolerance set by llvmpipe (Mesa 25.0.7), which made the golden and repeats it to the bit.
    golden(NAME, &run("240x150", &[]).picture, 0.002);
}

#[test]
fn hits_agree_under_every_matrix() {
    for (placed, sets) in [(Placed::specimens(), &[SPECIMEN][..]), (Placed::few(), &FEW)] {
        let hits = placed.hits(sets);
        let mut seen = vec![0; placed.pieces.len()];
        for hit in hits.iter().filter_map(|(_, hit)| answer(hit)) {
            seen[hit.instance as usize] += 1;
        }
        let tally = judge(&placed.exact, hits.iter().map(|(ray, hit)| (*ray, answer(hit))));
        println!("{sets:?}: {tally}");
        let Tally { wrong, first_wrong, agree, .. } = &tally;
        assert_eq!(*wrong, 0, "{first_wrong:?}");
        assert!(*agree > 8_950, "{tally}");
        // Six knights at the end of the row, all of them seen.
        if sets == [SPECIMEN] {
            let knights = &seen[seen.len() - 6..];
            assert!(knights.iter().all(|&pixels| pixels > 30), "{knights:?}");
        }
    }
}

/// The specimens' shadow rays: none may stop at the triangle that it leaves, however that is stretched.
#[test]
fn no_matrix_makes_a_triangle_shadow_itself() {
    let placed = Placed::specimens();
    let sets = [SPECIMEN, "smooth terminator=off"];
    let hits = placed.hits(&sets);
    let origins = picture(&[&sets[..], &["show=shadow origin"]].concat());
    let sun = Sun { azimuth: 300.0, elevation: 22.0, ..Sun::default() }.light().direction;
    let (mut lit, mut dark) = (0, 0);
    for ((ray, hit), &[x, y, z, seen]) in hits.iter().zip(&origins.pixels).step_by(3) {
        let Some(hit) = answer(hit) else { continue };
        let own = (hit.instance, hit.primitive);
        let shadow = Ray::from_f32([x, y, z], sun.to_array(), 0.0, 1e30);
        let mut candidates = placed.exact.near_candidates(&shadow);
        candidates.retain(|near| (near.hit.instance, near.hit.primitive) != own);
        let [a, b, c] = *placed.exact.triangle(own.0, own.1).unwrap();
        let normal = (b - a).cross(c - a).normalize();
        let cosine = -normal.dot(ray.direction).signum() * normal.dot(shadow.direction);
        if candidates.iter().any(|near| near.must_hit(&shadow)) {
            assert!(seen == 0.0, "lit through a triangle: {shadow:?}");
        } else if candidates.is_empty() && cosine > 1e-6 {
            assert!(seen == 1.0, "piece {} shadows itself: {shadow:?}", hit.instance);
        }
        lit += usize::from(seen == 1.0);
        dark += usize::from(seen == 0.0);
    }
    println!("{lit} lit, {dark} dark");
    assert!(lit > 500 && dark > 100, "{lit} {dark}");
}

/// What `normals` made of the object-space normals whose bits the GPU wrote: for each pixel the piece,
/// the sine of the error's angle, and the bound on it if the inverse was rounded once.
fn normal_errors(placed: &Placed, sets: &[&str]) -> Vec<(usize, f64, f64)> {
    let show = |view| picture(&[&[SPECIMEN], sets, &[view]].concat());
    let (objects, worlds) = (show("show=object normal"), show("show=normal"));
    let pixels = objects.pixels.iter().zip(&worlds.pixels);
    let seen = pixels.filter(|(object, _)| object[3] >= 0.0);
    let errors = seen.map(|(&[x, y, z, index], &[r, g, b, _])| {
        let index = index as usize;
        let transform = placed.transform(index);
        let object = Vec3::new(x, y, z).as_dvec3();
        let exact = transform.inverse.transpose() * object;
        let world = Vec3::new(r, g, b).as_dvec3() * 2.0 - 1.0;
        // The entry, the product and two sums; then normalising, and 0.5 + 0.5 n of the picture.
        let strayed = absolute(transform.inverse).transpose() * object.abs() * 4.0;
        let bound = 1.01 * U * (strayed.length() / exact.length() + 2.0 * 3f64.sqrt());
        (index, exact.normalize().cross(world.normalize()).length(), bound)
    });
    errors.collect()
}

fn absolute(m: DMat3) -> DMat3 {
    DMat3::from_cols_array(&m.to_cols_array().map(f64::abs))
}

#[test]
fn normals_turn_with_the_inverse_transpose() {
    println!("| far | normals | off by, in degrees, at most |");
    for far in [0.0, 1e6] {
        let placed = Placed::new(SPECIMENS, 0, formation::camera(SPECIMENS), far, false);
        for normals in ["device inverse", "host inverse"] {
            let (far_set, set) = (format!("far={far}"), format!("normals={normals}"));
            let errors = normal_errors(&placed, &["coordinates=world", &far_set, &set]);
            let worst = errors.iter().fold(0.0, |worst, &(_, sine, _)| f64::max(worst, sine));
            println!("| {far} | {normals} | {:.1e} |", worst.asin().to_degrees());
            assert!(errors.len() > 2000, "{}", errors.len());
            // The specification says nothing of the device's, so nothing is asked of it.
            if normals == "host inverse" {
                assert!(errors.iter().all(|(_, sine, bound)| sine <= bound), "{worst}");
            }
        }
    }
    // By the matrix: right where it only turns and mirrors, wrong where it shears or stretches.
    let placed = Placed::specimens();
    let first = placed.pieces.len() - 6;
    let mut most = [0f64; 6];
    for (index, sine, _) in normal_errors(&placed, &["normals=matrix"]) {
        if let Some(knight) = index.checked_sub(first) {
            most[knight] = most[knight].max(sine.min(1.0).asin().to_degrees());
        }
    }
    println!("by the matrix, in degrees: {most:.5?}");
    assert!(most[..2].iter().all(|&degrees| degrees < 1e-4), "{most:?}");
    assert!(most[2..].iter().all(|&degrees| degrees > 15.0), "{most:?}");
}

#[test]
fn a_mask_hides_from_the_camera_and_keeps_the_shadow() {
    let placed = Placed::few();
    let mask = |index: u32| placed.pieces[index as usize].mask;
    let all = picture(&[&FEW[..], &["show=hit"]].concat());
    assert!([BOARD, WHITE, BLACK].iter().all(|&kind| {
        indices(&all).flatten().filter(|&index| placed.pieces[index].mask == kind).count() > 500
    }));
    let shadows = |sets: &[&str]| bits(&picture(&[sets, &["show=shadow"]].concat()));
    let (all, all_shadows) = (bits(&all), shadows(&FEW));
    for (sees, hidden) in [("white", WHITE), ("black", BLACK)]
        .map(|(name, bit)| (format!("camera sees=all but {name}"), bit))
    {
        let sets = [&FEW[..], &[sees.as_str()]].concat();
        let hits = placed.hits(&sets);
        for (ray, hit) in hits.iter().step_by(5) {
            let is_seen = |hit: &Hit| mask(hit.instance) != hidden;
            let verdict = placed.exact.judge(ray, answer(hit), is_seen);
            assert!(verdict.is_allowed(), "{sees}: {verdict:?}");
        }
        // Where the same is seen as before, it lies in the same shadow.
        let hits: Vec<_> = hits.iter().map(|(_, hit)| hit.map(f32::to_bits)).collect();
        let same: Vec<_> = (0..hits.len()).filter(|&i| hits[i][..3] == all[i][..3]).collect();
        let shadows = shadows(&sets);
        assert!(same.len() > 5000 && same.iter().all(|&i| shadows[i] == all_shadows[i]));
    }
    // And without their shadows, more is lit, and nothing is darker.
    let lit =
        |set: &str| picture(&[&FEW[..], &[set, "camera sees=the board", "show=shadow"]].concat());
    let (everything, board) = (lit("shadows of=everything"), lit("shadows of=the board"));
    let pairs = || everything.pixels.iter().zip(&board.pixels);
    assert!(pairs().all(|(all, few)| all[0] <= few[0]));
    let freed = pairs().filter(|(all, few)| all[0] < few[0]).count();
    assert!(freed > 500, "{freed}");
}

#[test]
fn the_custom_index_does_not_depend_on_the_order() {
    let show = |view: &str, ordering: &[&str]| {
        let sets = FEW.iter().copied().chain([view]).flat_map(|set| ["--set", set]);
        render(NAME, SIZE, &ordering.iter().copied().chain(sets).collect::<Vec<_>>()).picture
    };
    let [ordered, unordered] = [&[][..], &["--unordered"]]
        .map(|ordering| ["show=hit", "show=instance id"].map(|view| show(view, ordering)));
    assert!(bits(&ordered[0]) == bits(&unordered[0]));
    let mut moved = 0;
    for ((hit, a), b) in ordered[0].pixels.iter().zip(&ordered[1].pixels).zip(&unordered[1].pixels)
    {
        // As the pieces come, gl_InstanceID is their index.
        assert_eq!(hit[0], b[3]);
        moved += usize::from(a[3] != b[3]);
    }
    assert!(moved > 3000, "{moved}");
}

#[test]
fn facing_is_the_mesh_s_own_unless_a_flag_flips_it() {
    let flags = ["none", "facing cull disable", "flip facing"];
    // Mirrored and sheared pieces, of which no flag is asked; and pieces that are only turned.
    let scenes =
        [(Placed::specimens(), &[SPECIMEN][..], &flags[..1]), (Placed::few(), &FEW, &flags[..])];
    for (placed, sets, flags) in scenes {
        let is_white = |hit: &Hit| placed.pieces[hit.instance as usize].mask == WHITE;
        let mut pictures = Vec::new();
        for (culling, keeps_front) in [("culling=back faces", true), ("culling=front faces", false)]
        {
            for &flags in flags {
                let set = format!("flags of white={flags}");
                let sets = [sets, &[culling, &set]].concat();
                let accept = |hit: &Hit| {
                    let flipped = flags == "flip facing" && is_white(hit);
                    let is_front = hit.counterclockwise != flipped;
                    is_front == keeps_front || (flags == "facing cull disable" && is_white(hit))
                };
                let hits = placed.hits(&sets);
                for (ray, hit) in hits.iter().step_by(9) {
                    let verdict = placed.exact.judge(ray, answer(hit), accept);
                    assert!(verdict.is_allowed(), "{sets:?}: {verdict:?}");
                }
                pictures.push(hits);
            }
        }
        // Closed pieces show their backs only where their fronts are culled.
        if let [back, back_off, back_flipped, front, front_off, front_flipped] = &pictures[..] {
            assert!(back == back_off && back != back_flipped);
            assert!(front != front_off && front_off == front_flipped);
        }
    }
}

#[test]
fn no_opaque_lets_the_any_hit_shader_cut() {
    let placed = Placed::few();
    let sets = [&FEW[..], &["flags of white=force no-opaque"]].concat();
    let (mut cut, mut doubtful) = (0, 0);
    let whole = placed.hits(&FEW);
    for ((ray, hit), (_, before)) in placed.hits(&sets).iter().zip(&whole) {
        // Ten slices a unit, each six tenths thick, in the mesh's own space.
        let slice = |hit: &Hit| {
            let transform = placed.transform(hit.instance as usize);
            let height = (transform.inverse * (ray.at(hit.t) - transform.translation)).y;
            (10.0 * height).rem_euclid(1.0)
        };
        let is_white = |hit: &Hit| placed.pieces[hit.instance as usize].mask == WHITE;
        let keep = |hit: &Hit| !is_white(hit) || slice(hit) <= 0.6;
        if !placed.exact.judge(ray, answer(hit), keep).is_allowed() {
            // A hit so near a cut that rounding decides.
            let near = placed.exact.all_hits(ray).into_iter().any(|hit| {
                let slice = slice(&hit);
                is_white(&hit) && [0.0, 0.6, 1.0].iter().any(|cut| (slice - cut).abs() < 1e-4)
            });
            assert!(near, "{ray:?} {hit:?}");
            doubtful += 1;
        }
        cut += usize::from(hit[..3] != before[..3]);
    }
    println!("{cut} pixels cut, {doubtful} at a cut");
    assert!(cut > 200 && doubtful < 20, "{cut} {doubtful}");
}

/// In how many pixels of a hundred two pictures of hits show another triangle.
fn percent_changed(a: &Picture, b: &Picture) -> f64 {
    let pairs = a.pixels.iter().zip(&b.pixels);
    let changed = pairs.filter(|(a, b)| a[..2] != b[..2]).count();
    100.0 * changed as f64 / a.pixels.len() as f64
}

#[test]
fn far_away_only_camera_relative_coordinates_keep_the_picture() {
    let sets = |far: &str, coordinates: &str, show: &str| {
        let sets = [far, coordinates].map(str::to_owned).into_iter().chain([show.to_owned()]);
        let sets: Vec<_> = sets.collect();
        picture(&sets.iter().map(String::as_str).collect::<Vec<_>>())
    };
    let [relative, world] = ["coordinates=camera-relative", "coordinates=world"];
    let near = |show| sets("far=0", relative, show);
    let (hits, shadows) = (near("show=hit"), near("show=shadow"));
    println!("| far | coordinates | another triangle | another shadow |");
    let mut rows = Vec::new();
    for far in ["10000", "100000", "1000000", "1234567.9"] {
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
    for (is_world, far, triangles, dark) in rows {
        let distance: f64 = far.trim_start_matches("far=").parse().unwrap();
        if !is_world {
            assert!(triangles < 0.05 && dark < 0.05, "{far}: {triangles} {dark}");
        } else if distance >= 1e6 {
            assert!(triangles > 20.0 && dark > 5.0, "{far}: {triangles} {dark}");
        }
    }
}

#[test]
fn both_coordinates_side_by_side_are_the_two_pictures() {
    // A soft light, or its random numbers would not tell the pixels apart.
    let sets = ["far=1000000", "light size=0.1", "light samples=2"];
    let show = |coordinates: &str| {
        picture(&[&sets[..], &[&format!("coordinates={coordinates}")]].concat())
    };
    let [both, world, relative] = ["both", "world", "camera-relative"].map(show);
    for (index, pixel) in both.pixels.iter().enumerate() {
        let half = if index % 120 < 60 { &world } else { &relative };
        assert_eq!(pixel, &half.pixels[index], "pixel {index}");
    }
}

/// The ray's origin in the space of each piece that was seen: error by rung, in parts of the bound of
/// `L^-1·(o - T)`.
fn origin_errors(placed: &Placed, sets: &[&str]) -> Vec<(usize, f64, f64)> {
    let origins = picture(&[sets, &["show=object origin"]].concat());
    let seen = origins.pixels.iter().filter(|pixel| pixel[3] >= 0.0);
    let errors = seen.map(|&[x, y, z, index]| {
        let transform = placed.transform(index as usize);
        let apart = placed.camera.eye.as_vec3().as_dvec3() - transform.translation;
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
    println!("| far | object ray | error, relative, most | parts of the bound |");
    for far in [0.0, 1e3, 1e6] {
        let placed = Placed::new(SPECIMENS, 0, formation::camera(SPECIMENS), far, false);
        let first = placed.pieces.len() - 6;
        for rung in ["device", "matrix", "inverse"] {
            let (far_set, rung_set) = (format!("far={far}"), format!("object ray={rung}"));
            let sets = [SPECIMEN, "coordinates=world", &far_set, &rung_set];
            let errors = origin_errors(&placed, &sets);
            let knights = errors.iter().filter(|(index, ..)| *index >= first);
            let worst = knights.clone().fold(0.0, |worst, (_, error, _)| f64::max(worst, *error));
            let part = knights.clone().fold(0.0, |worst, (.., part)| f64::max(worst, *part));
            println!("| {far} | {rung} | {worst:.1e} | {part:.1} |");
            assert!(knights.count() > 300);
            if rung == "inverse" {
                assert!(errors.iter().all(|(.., part)| *part <= 1.0), "{far}: {part}");
            } else if far == 1e6 {
                assert!(part > 1000.0, "{rung}: {part}");
            }
        }
    }
}

#[test]
fn copies_look_the_same_and_take_the_memory() {
    let sets = |geometry| [&FEW[..], &[geometry, "show=hit"]].concat();
    let instances = run(SIZE, &sets("geometry=instances"));
    let copies = run(SIZE, &sets("geometry=copies"));
    let changed = percent_changed(&instances.picture, &copies.picture);
    // A baked corner is rounded once more, so rays at an edge may take the other side.
    assert!(changed < 0.5, "{changed} %");
    let number = |run: &Run, name: &str| run.report["chapter"][name].as_u64().unwrap();
    assert_eq!(number(&instances, "triangles"), number(&copies, "triangles"));
    assert_eq!(number(&copies, "meshes"), number(&copies, "pieces"));
    // A triangle that is copied takes at least its three indices and a leaf; a piece 64 bytes.
    let more = |name| number(&copies, name) - number(&instances, name);
    let triangles = number(&copies, "triangles");
    assert!(more("mesh_bytes") + more("bottom_level_bytes") > 40 * triangles);
    let more = run(SIZE, &["squares=4000", "show=hit"]);
    let pieces = number(&more, "pieces") - number(&instances, "pieces");
    for name in ["mesh_bytes", "bottom_level_bytes"] {
        assert_eq!(number(&more, name), number(&instances, name), "{name}");
    }
    let per_piece = ["top_level_bytes", "record_bytes", "instance_bytes"]
        .map(|name| (number(&more, name) - number(&instances, name)) as f64 / pieces as f64);
    println!("bytes a piece, top level, record, instance: {per_piece:.1?}");
    assert!(per_piece.iter().sum::<f64>() < 500.0, "{per_piece:?}");
}

#[test]
fn a_hundred_thousand_instances_are_built_and_traced() {
    // From above, so that the whole disk is in the picture.
    let sets = ["squares=70000", "camera eye=0,330,60", "camera target=0,0,0", "field of view=50"];
    let run = run(SIZE, &[&sets[..], &["show=hit"]].concat());
    let pieces = run.report["chapter"]["pieces"].as_u64().unwrap();
    println!("{pieces} instances, {} ms", run.report["gpu_milliseconds"]["median"]);
    assert!(pieces > 100_000, "{pieces}");
    let seen: std::collections::BTreeSet<_> = indices(&run.picture).flatten().collect();
    assert!(seen.len() > 3000, "{} seen", seen.len());
    // Indices beyond 16 bits arrive whole, and the last squares are at the rim.
    assert!(seen.iter().any(|&index| index > 65_536) && *seen.last().unwrap() < pieces as usize);
    assert!(seen.last().unwrap() + 2000 > pieces as usize, "{:?}", seen.last());
}

#[test]
fn wrong_controls_are_refused() {
    for (set, possible) in
        [("squares=0", "1 to 1000000"), ("normals=right", "matrix, device inverse, host inverse")]
    {
        let (code, line) = run::refused(NAME, &["--headless", "--set", set]);
        assert!(code == 2 && line.contains(possible), "{code}: {line}");
    }
}
